#include "render/bricks.h"

#include "base/die.h"
#include "render/kern/voxels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What one brick holds, by its place in cells; returns whether there is anything in it. */
typedef int fill_fn(const struct medium *m, const int *cell, float *out);

/* Extinction in cubes. A cube that the box cuts has its particles in the part inside. */
static int fill_cubes(const struct medium *m, const int *cell, float *out)
{
	int waves = m->n_waves, classes = m->n_classes, some = 0;
	memset(out, 0, (size_t)(BRICK_CELLS * waves) * sizeof *out);
	for (int v = 0; v < BRICK_CELLS; v++) {
		const int i[3] = { cell[0] + v % BRICK, cell[1] + v / BRICK % BRICK, cell[2] + v / BRICK / BRICK };
		if (i[0] >= m->voxels[0] || i[1] >= m->voxels[1] || i[2] >= m->voxels[2])
			continue;
		double volume = 1;
		for (int a = 0; a < 3; a++)
			volume *= fmin(m->voxel, 2 * m->half[a] - i[a] * m->voxel);
		const uint32_t *count = m->voxel_count
		    + (((size_t)i[2] * (size_t)m->voxels[1] + (size_t)i[1]) * (size_t)m->voxels[0] + (size_t)i[0]) * (size_t)classes;
		for (int w = 0; w < waves; w++) {
			double c = 0;
			for (int k = 0; k < classes; k++)
				c += count[k] * m->c_ext[k * waves + w];
			out[v * waves + w] = (float)(c * 1e-12 / volume);
			some |= c > 0;
		}
	}
	return some;
}

static int clamp(int i, int n) { return i < 0 ? 0 : i > n - 1 ? n - 1 : i; }

/* Faces of a field: cell i lies between nodes i - 1 and i, the outermost nodes going on to the border. */
static int nodes_of(const struct medium *m, const float *field, const int *cell, float *out)
{
	int some = 0;
	for (int z = 0; z <= BRICK; z++)
		for (int y = 0; y < BRICK; y++)
			for (int x = 0; x <= BRICK; x++)
				for (int k = 0; k < 2; k++) {
					size_t i = (size_t)clamp(cell[0] + x - 1, m->voxels[0]), j = (size_t)clamp(cell[1] + y + k - 1, m->voxels[1]);
					size_t l = (size_t)clamp(cell[2] + z - 1, m->voxels[2]);
					float v = field[(l * (size_t)m->voxels[1] + j) * (size_t)m->voxels[0] + i];
					out[z * FACE + y * FACE_ROW + 2 * x + k] = v;
					some |= v > 0;
				}
	return some;
}

static int fill_density(const struct medium *m, const int *cell, float *out) { return nodes_of(m, m->density, cell, out); }

/* Extinction by wavelength where each class has its own density. */
static int fill_classes(const struct medium *m, const int *cell, float *out)
{
	const size_t voxels = (size_t)m->voxels[0] * (size_t)m->voxels[1] * (size_t)m->voxels[2];
	int some = 0;
	memset(out, 0, BRICK_CORNERS * (size_t)m->n_waves * sizeof *out);
	for (int k = 0; k < m->n_classes; k++) {
		float own[BRICK_CORNERS];
		if (!nodes_of(m, m->density + (size_t)k * voxels, cell, own))
			continue;
		some = 1;
		for (int w = 0; w < m->n_waves; w++) {
			double c = m->count[k] / m->matter * m->c_ext[k * m->n_waves + w] * 1e-12;
			for (int i = 0; i < BRICK_CORNERS; i++)
				out[w * BRICK_CORNERS + i] += (float)(c * own[i]);
		}
	}
	return some;
}

#define DISTANCE_MOST 4096

/* A king's distances to the nearest kept brick: two sweeps over the neighbours on either side (Rosenfeld and Pfaltz 1968). */
static void distances(const struct bricks *b)
{
	int32_t nx = b->size[0], ny = b->size[1], nz = b->size[2];
	for (int way = 1; way >= -1; way -= 2)
		for (size_t k = 0; k < b->n_brick; k++) {
			size_t i = way > 0 ? k : b->n_brick - 1 - k;
			int32_t x = (int32_t)(i % (size_t)nx), y = (int32_t)(i / (size_t)nx % (size_t)ny), z = (int32_t)(i / (size_t)nx / (size_t)ny);
			for (int n = 0; n < 13 && b->brick[i] < 0; n++) {
				int32_t u = x + way * (n % 3 - 1), v = y + way * (n / 3 % 3 - 1), w = z + way * (n / 9 - 1);
				if (u < 0 || u >= nx || v < 0 || v >= ny || w < 0 || w >= nz)
					continue;
				int32_t near = b->brick[((size_t)w * (size_t)ny + (size_t)v) * (size_t)nx + (size_t)u];
				near = near < 0 ? -near : 0;
				b->brick[i] = -b->brick[i] > near + 1 ? -(near + 1) : b->brick[i];
			}
		}
}

void bricks_make(struct bricks *b, const struct medium *m)
{
	int counted = m->kind == MEDIUM_PARTICLES, classed = medium_by_class(m);
	size_t one = counted ? (size_t)(BRICK_CELLS * m->n_waves) : BRICK_CORNERS * (classed ? (size_t)m->n_waves : 1), kept = 0;
	fill_fn *fill = counted ? fill_cubes : classed ? fill_classes : fill_density;
	float *scratch = xalloc(one, sizeof *scratch);
	memset(b, 0, sizeof *b);
	for (int a = 0; a < 3; a++)
		b->size[a] = (m->voxels[a] + !counted + BRICK - 1) / BRICK + 2;
	b->n_brick = (size_t)b->size[0] * (size_t)b->size[1] * (size_t)b->size[2];
	b->brick = xalloc(b->n_brick, sizeof *b->brick);
	for (int pass = 0; pass < 2; pass++) {    /* first which are kept, then what they hold */
		for (size_t i = 0; i < b->n_brick; i++) {
			const int at[3] = { (int)(i % (size_t)b->size[0]), (int)(i / (size_t)b->size[0] % (size_t)b->size[1]),
				(int)(i / (size_t)b->size[0] / (size_t)b->size[1]) };
			const int cell[3] = { BRICK * (at[0] - 1), BRICK * (at[1] - 1), BRICK * (at[2] - 1) };
			int inner = 1;
			for (int a = 0; a < 3; a++)
				inner &= at[a] > 0 && at[a] < b->size[a] - 1;
			if (pass && b->brick[i] >= 0)
				fill(m, cell, b->voxel + (size_t)b->brick[i] * one);
			else if (!pass)
				b->brick[i] = inner && fill(m, cell, scratch) ? (int32_t)kept++ : -DISTANCE_MOST;
		}
		if (kept * one > INT32_MAX)
			die("medium", "has too many voxels to render as a grid: %zu x %d are filled", kept, BRICK_CELLS);
		if (!pass) {
			b->n_voxel = (kept ? kept : 1) * one;    /* lanes that are out of it read the first */
			b->voxel = xalloc(b->n_voxel, sizeof *b->voxel);
		}
	}
	free(scratch);
	distances(b);
}

void bricks_free(struct bricks *b)
{
	free(b->brick);
	free(b->voxel);
}

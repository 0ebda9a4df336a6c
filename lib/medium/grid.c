#include "medium/grid.h"

#include "base/die.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CELLS_MAX 0x1p28

static int class_of(const float *q)
{
	int32_t class;
	memcpy(&class, &q[3], 4);
	return class;
}

/* Radius in m of the largest disc of each class, a little enlarged for the float arithmetic of the rays. */
static double *disc_radii(const struct medium *m)
{
	double *r = xalloc((size_t)m->n_classes, sizeof *r), side = fmax(m->half[0], fmax(m->half[1], m->half[2]));
	for (int k = 0; k < m->n_classes; k++) {
		for (int w = 0; w < m->n_waves; w++)
			r[k] = fmax(r[k], sqrt(m->c_ext[k * m->n_waves + w] / M_PI) * 1e-6);
		r[k] = r[k] * (1 + 1e-5) + side * 1e-6;
	}
	return r;
}

/* The side of cells for which (visit + tests) / side is least, where a cell of side a holds n (a + 2 r)^3 references. */
static double best_side(double n, double r)
{
	double best = 0, least = INFINITY;
	for (double a = r / 4 + cbrt(0.05 / n); a < 64 * (r + cbrt(1 / n)); a *= 1.05) {
		double cost = (3 + n * (a * a * a + 6 * a * a * r + 3 * M_PI * a * r * r + 4 * M_PI / 3 * r * r * r)) / a;
		if (cost < least) {
			least = cost;
			best = a;
		}
	}
	return best;
}

static void place(struct medium *m, const double *r)
{
	double low[3], high[3], volume = 1, mean = 0;
	for (int a = 0; a < 3; a++) {
		low[a] = INFINITY;
		high[a] = -INFINITY;
		for (size_t i = 0; i < m->n_particles; i++) {
			const float *q = m->particle + 4 * i;
			low[a] = fmin(low[a], q[a] - r[class_of(q)]);
			high[a] = fmax(high[a], q[a] + r[class_of(q)]);
		}
		volume *= high[a] - low[a];
	}
	for (size_t i = 0; i < m->n_particles; i++)
		mean += r[class_of(m->particle + 4 * i)] / (double)m->n_particles;
	double side = best_side((double)m->n_particles / volume, mean), total = 1;
	for (int a = 0; a < 3; a++)
		total *= fmax(1, ceil((high[a] - low[a]) / side));
	if (total > CELLS_MAX)
		side *= cbrt(total / CELLS_MAX);
	for (int a = 0; a < 3; a++) {
		m->cells[a] = (int32_t)fmin(fmax(1, ceil((high[a] - low[a]) / side)), CELLS_MAX);
		m->low[a] = (float)low[a];
		m->cell[a] = (float)((high[a] - m->low[a]) / m->cells[a] * (1 + 1e-6));
	}
}

static int index_of(const struct medium *m, int a, double x)
{
	return (int)fmin(fmax(floor((x - m->low[a]) / m->cell[a]), 0), m->cells[a] - 1);
}

static size_t home(const struct medium *m, const float *q)
{
	return ((size_t)index_of(m, 2, q[2]) * (size_t)m->cells[1] + (size_t)index_of(m, 1, q[1])) * (size_t)m->cells[0]
	    + (size_t)index_of(m, 0, q[0]);
}

/* Counting sort by cell. */
static void sort(struct medium *m, size_t n_cells)
{
	size_t *at = xalloc(n_cells + 1, sizeof *at);
	float *sorted = xalloc(m->n_particles, 4 * sizeof *sorted);
	for (size_t i = 0; i < m->n_particles; i++)
		at[home(m, m->particle + 4 * i) + 1]++;
	for (size_t c = 0; c < n_cells; c++)
		at[c + 1] += at[c];
	for (size_t i = 0; i < m->n_particles; i++)
		memcpy(sorted + 4 * at[home(m, m->particle + 4 * i)]++, m->particle + 4 * i, 4 * sizeof *sorted);
	free(m->particle);
	free(at);
	m->particle = sorted;
}

/* Distance from x to the cell [i, i + 1] along an axis. */
static double gap(const struct medium *m, int a, int i, double x)
{
	double low = (double)m->low[a] + (double)i * m->cell[a];
	return fmax(0, fmax(low - x, x - (low + m->cell[a])));
}

/* Count the references of each cell (fill 0), or write them (fill 1). */
static void refer(struct medium *m, const double *r, int fill)
{
	for (size_t i = 0; i < m->n_particles; i++) {
		const float *q = m->particle + 4 * i;
		double d = r[class_of(q)];
		int from[3], to[3];
		for (int a = 0; a < 3; a++) {
			from[a] = index_of(m, a, q[a] - d);
			to[a] = index_of(m, a, q[a] + d);
		}
		for (int z = from[2]; z <= to[2]; z++)
			for (int y = from[1]; y <= to[1]; y++)
				for (int x = from[0]; x <= to[0]; x++) {
					double gx = gap(m, 0, x, q[0]), gy = gap(m, 1, y, q[1]), gz = gap(m, 2, z, q[2]);
					if (gx * gx + gy * gy + gz * gz > d * d)
						continue;
					size_t c = ((size_t)z * (size_t)m->cells[1] + (size_t)y) * (size_t)m->cells[0] + (size_t)x;
					if (fill)
						m->reference[m->first[c]++] = (uint32_t)i;
					else
						m->first[c]++;
				}
	}
}

void grid_build(struct medium *m)
{
	double *r = disc_radii(m);
	place(m, r);
	size_t n_cells = (size_t)m->cells[0] * (size_t)m->cells[1] * (size_t)m->cells[2];
	sort(m, n_cells);
	m->n_first = n_cells + 1;
	m->first = xalloc(m->n_first, sizeof *m->first);
	refer(m, r, 0);
	uint64_t total = 0;
	for (size_t c = 0; c <= n_cells; c++) {
		uint64_t n = m->first[c];
		m->first[c] = (uint32_t)total;
		total += n;
	}
	if (total > UINT32_MAX)
		die("grid", "%llu references of particles in cells; at most 2^32", (unsigned long long)total);
	m->n_references = (size_t)total;
	m->reference = xalloc(m->n_references, sizeof *m->reference);
	refer(m, r, 1);    /* moves first[c] to the end of cell c, the beginning of the next */
	memmove(m->first + 1, m->first, n_cells * sizeof *m->first);
	m->first[0] = 0;
	free(r);
}

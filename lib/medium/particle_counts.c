#include "medium/particle_counts.h"

#include "base/die.h"

#include <math.h>
#include <string.h>

#define DEFAULT_MOST 256    /* cubes along the longest side, unless more are asked for */

size_t particle_counts_level(const int32_t *n, int l, int32_t *size)
{
	size_t before = 0;
	memcpy(size, n, 3 * sizeof *size);
	for (int k = 0; k < l; k++) {
		before += (size_t)size[0] * (size_t)size[1] * (size_t)size[2];
		for (int a = 0; a < 3; a++)
			size[a] = (size[a] + 1) / 2;
	}
	return before;
}

size_t particle_counts_size(const int32_t *n)
{
	int32_t size[3];
	int l = 0;
	size_t before;
	do
		before = particle_counts_level(n, l++, size);
	while (size[0] > 1 || size[1] > 1 || size[2] > 1);
	return before + 1;
}

static size_t cube_of(const struct medium *m, const float *q)
{
	size_t i[3];
	for (int a = 0; a < 3; a++)
		i[a] = (size_t)fmin(fmax(floor((q[a] + m->half[a]) / m->voxel), 0), m->voxels[a] - 1);
	return (i[2] * (size_t)m->voxels[1] + i[1]) * (size_t)m->voxels[0] + i[0];
}

/* The number of a cube in its level. */
static size_t cube_at(const int32_t *size, int32_t x, int32_t y, int32_t z)
{
	return ((size_t)z * (size_t)size[1] + (size_t)y) * (size_t)size[0] + (size_t)x;
}

/* Add the counts of level l into those of the next. */
static void condense(struct medium *m, int l)
{
	int32_t fine[3], coarse[3];
	size_t classes = (size_t)m->n_classes;
	size_t from = particle_counts_level(m->voxels, l, fine), to = particle_counts_level(m->voxels, l + 1, coarse);
	for (int32_t z = 0; z < fine[2]; z++)
		for (int32_t y = 0; y < fine[1]; y++)
			for (int32_t x = 0; x < fine[0]; x++) {
				size_t f = from + cube_at(fine, x, y, z), c = to + cube_at(coarse, x / 2, y / 2, z / 2);
				for (size_t k = 0; k < classes; k++)
					m->voxel_count[c * classes + k] += m->voxel_count[f * classes + k];
			}
}

void particle_counts_build(struct medium *m, int longest)
{
	double side = 2 * fmax(m->half[0], fmax(m->half[1], m->half[2])), box = 8 * m->half[0] * m->half[1] * m->half[2];
	if (!longest)
		longest = (int)fmin(fmax(round(side * cbrt((double)m->n_particles / 8 / box)), 1), DEFAULT_MOST);
	m->voxel = side / longest;
	for (int a = 0; a < 3; a++)
		m->voxels[a] = (int32_t)fmax(1, ceil(2 * m->half[a] / m->voxel * (1 - 1e-9)));
	if ((double)m->voxels[0] * m->voxels[1] * m->voxels[2] * m->n_classes > INT32_MAX)
		die("--voxels", "%d x %d x %d cubes of %d classes are too many", m->voxels[0], m->voxels[1], m->voxels[2], m->n_classes);
	m->n_voxel_count = particle_counts_size(m->voxels) * (size_t)m->n_classes;
	m->voxel_count = xalloc(m->n_voxel_count, sizeof *m->voxel_count);
	for (size_t i = 0; i < m->n_particles; i++) {
		int32_t class;
		memcpy(&class, &m->particle[4 * i + 3], 4);
		m->voxel_count[cube_of(m, m->particle + 4 * i) * (size_t)m->n_classes + (size_t)class]++;
	}
	int32_t size[3];
	for (int l = 0; particle_counts_level(m->voxels, l, size), size[0] > 1 || size[1] > 1 || size[2] > 1; l++)
		condense(m, l);
}

int particle_counts_agree(const struct medium *m)
{
	const size_t classes = (size_t)m->n_classes;
	int32_t fine[3], coarse[3];
	particle_counts_level(m->voxels, 0, fine);
	for (int l = 0; fine[0] > 1 || fine[1] > 1 || fine[2] > 1; l++) {
		size_t from = particle_counts_level(m->voxels, l, fine), to = particle_counts_level(m->voxels, l + 1, coarse);
		for (int32_t z = 0; z < coarse[2]; z++)
			for (int32_t y = 0; y < coarse[1]; y++)
				for (int32_t x = 0; x < coarse[0]; x++) {
					const uint32_t *c = m->voxel_count + (to + cube_at(coarse, x, y, z)) * classes;
					for (size_t k = 0; k < classes; k++) {
						uint64_t sum = 0;
						for (int i = 0; i < 8; i++) {
							const int32_t at[3] = { 2 * x + (i & 1), 2 * y + (i >> 1 & 1), 2 * z + (i >> 2) };
							if (at[0] < fine[0] && at[1] < fine[1] && at[2] < fine[2])
								sum += m->voxel_count[(from + cube_at(fine, at[0], at[1], at[2])) * classes + k];
						}
						if (sum != c[k])
							return 0;
					}
				}
		memcpy(fine, coarse, sizeof fine);
	}
	const uint32_t *top = m->voxel_count + m->n_voxel_count - classes;
	for (size_t k = 0; k < classes; k++)
		if (top[k] != m->count[k])
			return 0;
	return 1;
}

#include "medium/medium.h"

#include <math.h>
#include <stdlib.h>

double medium_volume(const struct medium *m)
{
	return m->round ? 4 * M_PI / 3 * m->half[0] * m->half[0] * m->half[0] : 8 * m->half[0] * m->half[1] * m->half[2];
}

double medium_depth(const struct medium *m)
{
	double c = 0;
	for (int k = 0; k < m->n_classes; k++)
		c += m->count[k] * m->c_ext[k * m->n_waves];
	return c * 1e-12 / medium_volume(m) * 2 * fmin(m->half[0], fmin(m->half[1], m->half[2]));
}

static size_t voxels(const struct medium *m) { return (size_t)m->voxels[0] * (size_t)m->voxels[1] * (size_t)m->voxels[2]; }

int medium_by_class(const struct medium *m) { return m->n_density > voxels(m); }

int medium_even(const struct medium *m)
{
	int even = m->kind == MEDIUM_DENSITY;
	for (size_t i = 1, n = voxels(m); i < m->n_density && even; i++)
		even = m->density[i] == m->density[i - i % n];
	return even;
}

void medium_free(struct medium *m)
{
	void *const own[] = { m->history, m->wavelength, m->radius, m->count, m->c_ext, m->c_sca, m->node, m->theta, m->p,
		m->particle, m->first, m->voxel_count, m->density, m->host };
	for (size_t i = 0; i < sizeof own / sizeof *own; i++)
		free(own[i]);
}

#include "medium/medium_check.h"

#include "base/die.h"
#include "medium/particle_counts.h"

#include <math.h>
#include <string.h>

static void damaged(const char *name, const char *what)
{
	die(name, "damaged medium: %s", what);
}

static void classes(const char *name, const struct medium *m)
{
	for (int w = 0; w < m->n_waves; w++)
		if (!(m->wavelength[w] > (w ? m->wavelength[w - 1] : 0)) || !isfinite(m->wavelength[w]))
			damaged(name, "wavelengths out of order");
	for (int k = 0; k < m->n_classes; k++)
		if (!(m->radius[k] > (k ? m->radius[k - 1] : 0)) || !isfinite(m->radius[k]) || !(m->count[k] >= 0) || !isfinite(m->count[k]))
			damaged(name, "classes out of order");
	for (int i = 0; i < m->n_classes * m->n_waves; i++)
		if (!(m->c_ext[i] > 0 && m->c_ext[i] < 1e30) || !(m->c_sca[i] >= 0 && m->c_sca[i] <= m->c_ext[i] * (1 + 1e-9)))
			damaged(name, "cross sections out of range");
	for (int k = 0; k <= m->n_classes; k++) {
		int32_t at = m->node[2 * k], n = m->node[2 * k + 1];
		if (at < 0 || n < 2 || (size_t)at + (size_t)n > m->n_nodes || m->theta[at] != 0)
			damaged(name, "phase table out of range");
		for (int32_t i = at + 1; i < at + n; i++)
			if (!(m->theta[i] > m->theta[i - 1] && m->theta[i] < 3.1416f))
				damaged(name, "angles out of order");
	}
	for (size_t i = 0; i < m->n_nodes * (size_t)m->n_waves; i++)
		if (!(m->p[i] >= 0 && m->p[i] < 1e30f))
			damaged(name, "phase function out of range");
}

static void particles(const char *name, const struct medium *m)
{
	if (m->kind != MEDIUM_PARTICLES) {
		if (m->n_first || m->n_voxel_count)
			damaged(name, "a grid without particles");
		return;
	}
	if ((double)m->cells[0] * m->cells[1] * m->cells[2] + 1 != (double)m->n_first || m->first[0]
	    || m->first[m->n_first - 1] != m->n_particles)
		damaged(name, "grid does not agree with its cells");
	for (int a = 0; a < 3; a++)
		if (!(m->cell[a] > 0))
			damaged(name, "bad grid line");
	for (size_t c = 1; c < m->n_first; c++)
		if (m->first[c] < m->first[c - 1])
			damaged(name, "grid out of order");
	for (size_t i = 0; i < m->n_particles; i++) {
		int32_t class;
		const float *q = m->particle + 4 * i;
		memcpy(&class, &q[3], 4);
		if (class < 0 || class >= m->n_classes || !(fabsf(q[0]) < 1e9f) || !(fabsf(q[1]) < 1e9f) || !(fabsf(q[2]) < 1e9f))
			damaged(name, "a particle out of range");
	}
}

static void voxels(const char *name, const struct medium *m)
{
	if (m->kind == MEDIUM_PARTICLES) {
		if (m->n_density || !(m->voxel > 0) || particle_counts_size(m->voxels) * (size_t)m->n_classes != m->n_voxel_count)
			damaged(name, "voxels do not agree with their number");
		for (int a = 0; a < 3; a++)
			if (!(m->voxel * (m->voxels[a] - 1) < 2 * m->half[a]))
				damaged(name, "voxels larger than the medium");
		return;
	}
	if ((double)m->voxels[0] * m->voxels[1] * m->voxels[2] != (double)m->n_density)
		damaged(name, "density does not agree with its voxels");
	for (size_t i = 0; i < m->n_density; i++)
		if (!(m->density[i] >= 0 && m->density[i] < 1e30f))
			damaged(name, "density out of range");
}

void medium_check(const char *name, const struct medium *m)
{
	classes(name, m);
	particles(name, m);
	voxels(name, m);
}

#include "medium/medium_check.h"

#include "format/limits.h"
#include "medium/particle_counts.h"
#include "medium/particle_grid.h"
#include "optics/phase/phase.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NORM 1e-3              /* what floats may do to the integral of a phase function between nodes of its own */

const char *medium_check_sizes(const struct medium *m)
{
	if (m->n_waves < 1 || m->n_waves > MEDIUM_WAVES || m->n_classes < 1 || m->n_classes > MEDIUM_CLASSES)
		return "it has too many wavelengths or classes, or none";
	/* the kernels index nodes, particles, cells and voxels by int */
	if ((double)m->n_nodes * m->n_waves > INT32_MAX)
		return "its phase functions have too many angles";
	if (m->n_particles > MEDIUM_PARTICLES_MOST || m->n_first > INT32_MAX || m->n_voxel_count > INT32_MAX || m->n_density > INT32_MAX)
		return "it has too many particles or voxels";
	return NULL;
}

static int within(double v, double low, double high) { return v >= low && v <= high; }

static const char *shape(const struct medium *m)
{
	for (int a = 0; a < 3; a++)
		if (!within(m->half[a], DBL_MIN, MEDIUM_REACH) || (m->round && m->half[a] != m->half[0]))
			return "its size is out of range (1e9 m)";
	return NULL;
}

static const char *classes(const struct medium *m)
{
	double largest = 0;
	for (int w = 0; w < m->n_waves; w++)
		if (!(m->wavelength[w] > (w ? m->wavelength[w - 1] : 0)) || !isfinite(m->wavelength[w]))
			return "its wavelengths are out of order";
	for (int k = 0; k < m->n_classes; k++) {
		if (!(m->radius[k] > (k ? m->radius[k - 1] : 0)) || !isfinite(m->radius[k]))
			return "its classes are out of order";
		if (!within(m->count[k], 0, MEDIUM_VALUE))
			return "a class has too many particles (1e30)";
	}
	for (int i = 0; i < m->n_classes * m->n_waves; i++) {
		if (!within(m->c_ext[i], DBL_MIN, MEDIUM_VALUE) || !within(m->c_sca[i], 0, m->c_ext[i] * (1 + 1e-9)))
			return "its cross sections are out of range (1e30 um^2)";
		largest = fmax(largest, m->c_ext[i]);
	}
	for (int w = 0; w < m->n_waves && m->host; w++)
		if (!within(m->host[w], 0, MEDIUM_VALUE))
			return "its host's absorption is out of range (1e30 m^-1)";
	if (m->kind == MEDIUM_PARTICLES && largest < MEDIUM_DISC_LEAST)
		return "its particles are too small (1e-25 um^2)";
	return NULL;
}

static const char *phase_function(const struct medium *m, const float *theta, const float *p, int32_t n)
{
	for (int32_t i = 1; i < n; i++)
		if (!(theta[i] > theta[i - 1]) || theta[i] - theta[i - 1] > MEDIUM_INTERVAL)
			return "its angles are out of order";
	if (theta[0] != 0 || theta[n - 1] != (float)M_PI)
		return "its angles do not reach from 0 to pi";
	for (int w = 0; w < m->n_waves; w++) {
		double sum = 0;
		for (int32_t i = 0; i + 1 < n; i++) {
			const float *at = p + (size_t)i * (size_t)m->n_waves + w;
			sum += phase_interval(theta[i], (double)theta[i + 1] - theta[i], at[0], at[m->n_waves]);
		}
		if (!(fabs(sum - 1) <= NORM))
			return "a phase function is not normalised";
	}
	return NULL;
}

static const char *phase_functions(const struct medium *m)
{
	for (size_t i = 0; i < m->n_nodes * (size_t)m->n_waves; i++)
		if (!within(m->p[i], 0, MEDIUM_VALUE))
			return "a phase function is out of range (1e30 sr^-1)";
	for (int k = 0; k <= m->n_classes; k++) {
		int32_t at = m->node[2 * k], n = m->node[2 * k + 1];
		if (at < 0 || n < 2 || (size_t)at + (size_t)n > m->n_nodes)
			return "its phase functions are not where they should be";
		if (k && at == m->node[2 * k - 2] && n == m->node[2 * k - 1])
			continue;          /* shared with the class before */
		const char *wrong = phase_function(m, m->theta + at, m->p + (size_t)at * (size_t)m->n_waves, n);
		if (wrong)
			return wrong;
	}
	return NULL;
}

static const char *particle_grid(const struct medium *m)
{
	if (m->kind != MEDIUM_PARTICLES)
		return m->n_particles || m->n_first || m->n_voxel_count ? "it has a grid without particles" : NULL;
	for (int a = 0; a < 3; a++)
		if (m->cells[a] < 1 || m->cells[a] > MEDIUM_CELLS_SIDE || !within(m->low[a], -2 * MEDIUM_REACH, 2 * MEDIUM_REACH)
		    || !within(m->cell[a], FLT_MIN, 4 * MEDIUM_REACH))
			return "the grid of its particles is out of range";
	if ((double)m->cells[0] * m->cells[1] * m->cells[2] + 1 != (double)m->n_first || m->first[0]
	    || m->first[m->n_first - 1] != m->n_particles)
		return "the grid of its particles does not agree with its cells";
	for (size_t c = 1; c < m->n_first; c++)
		if (m->first[c] < m->first[c - 1])
			return "the grid of its particles is out of order";
	return NULL;
}

static const char *particles(const struct medium *m)
{
	double *count = calloc((size_t)m->n_classes, sizeof *count);
	const char *wrong = count ? NULL : "there is no memory to check it";
	for (size_t i = 0; i < m->n_particles && !wrong; i++) {
		int32_t class;
		const float *q = m->particle + 4 * i;
		memcpy(&class, &q[3], 4);
		for (int a = 0; a < 3; a++)
			if (!within(q[a], -MEDIUM_REACH, MEDIUM_REACH))
				wrong = "a particle is out of range (1e9 m)";
		if (class < 0 || class >= m->n_classes)
			wrong = "a particle is of no class";
		else if (!wrong)
			count[class]++;
	}
	for (int k = 0; k < m->n_classes && !wrong; k++)
		if (m->kind == MEDIUM_PARTICLES && count[k] != m->count[k])
			wrong = "its classes do not count its particles";
	free(count);
	return !wrong && m->kind == MEDIUM_PARTICLES && !particle_grid_agrees(m) ? "a particle is not in its cell" : wrong;
}

static const char *voxels(const struct medium *m)
{
	for (int a = 0; a < 3; a++)
		if (m->voxels[a] < 1 || m->voxels[a] > MEDIUM_VOXELS_SIDE)
			return "its voxels are out of range";
	if (m->kind == MEDIUM_PARTICLES) {
		if (m->n_density || !within(m->voxel, DBL_MIN, 2 * MEDIUM_REACH)
		    || particle_counts_size(m->voxels) * (size_t)m->n_classes != m->n_voxel_count)
			return "its voxels do not agree with their number";
		for (int a = 0; a < 3; a++)    /* the last is cut by the box, but not to nothing */
			if (!(m->voxel * (m->voxels[a] - 1 + 1e-10) < 2 * m->half[a]) || !(m->voxel * m->voxels[a] > 2 * m->half[a] * (1 - 1e-8)))
				return "its voxels do not fit its size";
		return particle_counts_agree(m) ? NULL : "its voxels do not count its particles";
	}
	double all = (double)m->voxels[0] * m->voxels[1] * m->voxels[2];
	if (all != (double)m->n_density && all * m->n_classes != (double)m->n_density)
		return "its density does not agree with its voxels";
	for (size_t i = 0; i < m->n_density; i++)
		if (!within(m->density[i], 0, MEDIUM_VALUE))
			return "its density is out of range (1e30)";
	return NULL;
}

/* What the kernels make of counts, cross sections and density has to stay among floats. */
static const char *extinction(const struct medium *m)
{
	double densest = 0, volume = medium_volume(m);
	for (size_t i = 0; i < m->n_density; i++)
		densest = fmax(densest, m->density[i]);
	if (!within(m->matter, 0, MEDIUM_VALUE))
		return "its matter is out of range (1e30 m3)";
	for (int w = 0; w < m->n_waves; w++) {
		double sum = 0;
		for (int k = 0; k < m->n_classes; k++)
			sum += m->count[k] * m->c_ext[k * m->n_waves + w] * 1e-12;
		if (!within(sum / volume, 0, MEDIUM_VALUE) || (m->matter > 0 && !within(sum / m->matter * fmax(densest, 1), 0, MEDIUM_VALUE)))
			return "its extinction is out of range (1e30 m^-1)";
	}
	return NULL;
}

const char *medium_check(const struct medium *m)
{
	static const char *(*const checks[])(const struct medium *) = { medium_check_sizes, shape, classes, phase_functions, particle_grid,
		particles, voxels, extinction };
	const char *wrong = NULL;
	for (size_t i = 0; i < sizeof checks / sizeof *checks && !wrong; i++)
		wrong = checks[i](m);
	return wrong;
}

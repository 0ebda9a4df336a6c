#include "medium/bake.h"

#include "base/die.h"
#include "format/columns.h"
#include "format/limits.h"
#include "medium/classes.h"
#include "medium/density.h"
#include "toolkit/law.h"

#include <math.h>
#include <stdlib.h>

/* One class's density, averaged where longest is not 0: out[voxel]. Returns its integral in fractions of the box. */
static double fill(const struct npy_grid *g, int longest, const struct medium *m, float *out)
{
	/* along an axis of a voxel, for averages; a box keeps its own voxels, whose mean is exact */
	const int parts = longest || m->round ? 4 : 1;
	const size_t n[3] = { (size_t)m->voxels[0], (size_t)m->voxels[1], (size_t)m->voxels[2] };
	double sum = 0, all = 0;
	for (size_t i = 0; i < n[0] * n[1] * n[2]; i++) {
		size_t at[3] = { i % n[0], i / n[0] % n[1], i / n[0] / n[1] };
		double mean = 0;
		for (int k = 0; k < parts * parts * parts; k++) {
			const int part[3] = { k % parts, k / parts % parts, k / parts / parts };
			double u[3], r2 = 0;
			for (int a = 0; a < 3; a++) {
				u[a] = ((double)at[a] + (part[a] + 0.5) / parts) / (double)n[a];
				r2 += pow(2 * u[a] - 1, 2);
			}
			double here = density_at(g, u[0], u[1], u[2]);
			mean += here / (parts * parts * parts);
			all++;
			sum += m->round && r2 > 1 ? 0 : here;
		}
		out[i] = longest ? (float)mean : g->v[i];
	}
	return sum / all;
}

struct bake_matter bake_density(const char *path, int longest, struct medium *m)
{
	struct bake_matter matter = { .n = 1 };
	struct npy_grid g = { 1, 1, 1, &(float){ 1 } };
	if (path)
		g = npy_density(path, &matter.n);
	double side = 2 * fmax(m->half[0], fmax(m->half[1], m->half[2])) / longest;
	size_t n[3] = { g.nx, g.ny, g.nz }, of_class = g.nx * g.ny * g.nz;
	for (int a = 0; a < 3; a++) {
		if (longest)
			n[a] = (size_t)fmax(1, round(2 * m->half[a] / side));
		if (n[a] > MEDIUM_VOXELS_SIDE)
			die(path ? path : "--voxels", "more than %d voxels along a side", MEDIUM_VOXELS_SIDE);
		m->voxels[a] = (int32_t)n[a];
	}
	size_t voxels = n[0] * n[1] * n[2];
	if (voxels > INT32_MAX / matter.n)
		die(path ? path : "--voxels", "more than 2^31 voxels");
	m->n_density = voxels * matter.n;
	m->density = xalloc(m->n_density, sizeof *m->density);
	matter.integral = xalloc(matter.n, sizeof *matter.integral);
	for (size_t k = 0; k < matter.n; k++) {
		struct npy_grid own = { g.nx, g.ny, g.nz, g.v + k * of_class };
		matter.integral[k] = 8 * m->half[0] * m->half[1] * m->half[2] * fill(&own, longest, m, m->density + k * voxels);
	}
	if (!path)
		matter.integral[0] = medium_volume(m);
	if (path)
		free(g.v);
	return matter;
}

/* Each class's density to the same integral, the medium's volume. */
static void even_out(const struct bake_matter *matter, struct medium *m)
{
	const size_t voxels = m->n_density / matter->n;
	m->matter = medium_volume(m);
	for (size_t k = 0; k < matter->n; k++)
		for (size_t i = 0; i < voxels && matter->integral[k] > 0; i++)
			m->density[k * voxels + i] = (float)(m->density[k * voxels + i] * (m->matter / matter->integral[k]));
}

char *bake_psd(const char *path, double concentration, const struct bake_matter *matter, const char *density, struct medium *m, int *exact)
{
	if (matter->n > 1 && matter->n != (size_t)m->n_classes)
		die(density, "has densities of %zu classes, and --xsect %d radii", matter->n, m->n_classes);
	struct tab *t = tab_open(path);
	int radius = tab_need(t, &column_radius), weight = tab_need(t, &column_weight);
	struct law_check *law = law_check_begin(t);
	double row[TAB_COLS], sum = 0;
	*exact = 1;
	while (tab_next(t, row)) {
		law_check_row(law, row);
		unsigned long long number = (unsigned long long)tab_row(t);
		int class = classes_find(m, t, row[radius]);
		if (!(row[weight] >= 0) || !isfinite(row[weight]))
			die(tab_path(t), "row %llu: weight %g is not a finite number of at least 0", number, row[weight]);
		*exact &= classes_exact(m, class, row[radius]);
		m->count[class] += row[weight];
		sum += row[weight];
	}
	law_check_end(law);
	if (!(fabs(sum - 1) <= 1e-6))
		die(tab_path(t), "the weights sum to %g, not to 1", sum);
	for (int k = 0; k < m->n_classes; k++)
		m->count[k] *= concentration * matter->integral[matter->n > 1 ? k : 0] / sum;
	if (matter->n > 1)
		even_out(matter, m);
	else
		m->matter = matter->integral[0];
	char *history = xtext("%s", tab_history(t));
	tab_close(t);
	return history;
}

double bake_visibility(double metres, struct medium *m, double *wavelength)
{
	const size_t waves = (size_t)m->n_waves;
	size_t high = 0;
	while (high < waves && m->wavelength[high] < 0.55)
		high++;
	size_t low = high > 0 ? high - 1 : 0;
	high = high < waves ? high : waves - 1;
	double share = high > low ? (0.55 - m->wavelength[low]) / (m->wavelength[high] - m->wavelength[low]) : 0, sum = 0;
	for (size_t k = 0; k < (size_t)m->n_classes; k++)
		sum += m->count[k] * ((1 - share) * m->c_ext[k * waves + low] + share * m->c_ext[k * waves + high]) * 1e-12;
	if (!(sum > 0))
		die("--visibility", "cannot be had: there is no extinction anywhere");
	double host = m->host ? (1 - share) * m->host[low] + share * m->host[high] : 0, left = -log(0.02) / metres - host;
	if (!(left > 0))
		die("--visibility", "is farther than one sees in the host alone, %g m", -log(0.02) / host);
	double scale = left * m->matter / sum;
	for (int k = 0; k < m->n_classes; k++)
		m->count[k] *= scale;
	*wavelength = high > low ? 0.55 : m->wavelength[low];
	return scale;
}

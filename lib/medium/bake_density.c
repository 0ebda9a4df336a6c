#include "medium/bake.h"

#include "base/die.h"
#include "format/columns.h"
#include "format/limits.h"
#include "medium/classes.h"
#include "medium/density.h"
#include "toolkit/law.h"

#include <math.h>
#include <stdlib.h>

void bake_density(const char *path, int longest, struct medium *m)
{
	/* along an axis of a voxel, for averages; a box keeps its own voxels, whose mean is exact */
	const int parts = longest || m->round ? 4 : 1;
	struct npy_grid g = { 1, 1, 1, &(float){ 1 } };
	if (path)
		g = npy_density(path);
	double side = 2 * fmax(m->half[0], fmax(m->half[1], m->half[2])) / longest, sum = 0, all = 0;
	size_t n[3] = { g.nx, g.ny, g.nz };
	for (int a = 0; a < 3; a++) {
		if (longest)
			n[a] = (size_t)fmax(1, round(2 * m->half[a] / side));
		if (n[a] > MEDIUM_VOXELS_SIDE)
			die(path ? path : "--voxels", "more than %d voxels along a side", MEDIUM_VOXELS_SIDE);
		m->voxels[a] = (int32_t)n[a];
	}
	m->n_density = n[0] * n[1] * n[2];
	if (m->n_density > INT32_MAX)
		die(path ? path : "--voxels", "more than 2^31 voxels");
	m->density = xalloc(m->n_density, sizeof *m->density);
	for (size_t i = 0; i < m->n_density; i++) {
		size_t at[3] = { i % n[0], i / n[0] % n[1], i / n[0] / n[1] };
		double mean = 0;
		for (int k = 0; k < parts * parts * parts; k++) {
			const int part[3] = { k % parts, k / parts % parts, k / parts / parts };
			double u[3], r2 = 0;
			for (int a = 0; a < 3; a++) {
				u[a] = ((double)at[a] + (part[a] + 0.5) / parts) / (double)n[a];
				r2 += pow(2 * u[a] - 1, 2);
			}
			double here = density_at(&g, u[0], u[1], u[2]);
			mean += here / (parts * parts * parts);
			all++;
			sum += m->round && r2 > 1 ? 0 : here;
		}
		m->density[i] = longest ? (float)mean : g.v[i];
	}
	m->matter = 8 * m->half[0] * m->half[1] * m->half[2] * sum / all;
	if (!path)
		m->matter = medium_volume(m);
	if (path)
		free(g.v);
}

char *bake_psd(const char *path, double concentration, struct medium *m, int *exact)
{
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
		m->count[k] *= concentration * m->matter / sum;
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
	double scale = -log(0.02) / metres * m->matter / sum;
	for (int k = 0; k < m->n_classes; k++)
		m->count[k] *= scale;
	*wavelength = high > low ? 0.55 : m->wavelength[low];
	return scale;
}

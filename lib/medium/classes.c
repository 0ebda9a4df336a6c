#include "medium/classes.h"

#include "base/ascending.h"
#include "base/die.h"
#include "format/columns.h"
#include "format/limits.h"
#include "optics/phase/phase.h"
#include "toolkit/law.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define KEY 1e-9               /* keys match within this, relative */
#define INTERVAL (M_PI / 180)  /* longest interval between nodes: sin is a cubic over it to the kernels (render/kern/phase.h) */

static int same(double a, double b)
{
	return fabs(a - b) <= KEY * fmax(fabs(a), fabs(b));
}

/* Index of a key in an ascending list, -1 if it is not there. */
static int index_of(const double *list, int n, double key)
{
	for (int i = 0; i < n; i++)
		if (same(list[i], key))
			return i;
	return -1;
}

/* Insert a key into an ascending list that does not have it yet. */
static void insert(double **list, int *n, double key)
{
	if (index_of(*list, *n, key) >= 0)
		return;
	*list = xgrow(*list, (size_t)*n + 1, sizeof **list);
	int i = (*n)++;
	for (; i > 0 && (*list)[i - 1] > key; i--)
		(*list)[i] = (*list)[i - 1];
	(*list)[i] = key;
}

static void positive(const struct tab *t, const char *name, double v)
{
	if (!(v > 0) || !isfinite(v))
		die(tab_path(t), "row %llu: %s %g is not positive", (unsigned long long)tab_row(t), name, v);
}

char *classes_cross_sections(const char *path, struct medium *m)
{
	struct tab *t = tab_open(path);
	int wavelength = tab_need(t, &column_wavelength), radius = tab_need(t, &column_radius);
	int c_ext = tab_need(t, &column_c_ext), c_sca = tab_need(t, &column_c_sca);
	struct law_check *law = law_check_begin(t);
	double row[TAB_COLS], (*rows)[4] = NULL;
	size_t n = 0;
	while (tab_next(t, row)) {
		unsigned long long number = (unsigned long long)tab_row(t);
		law_check_row(law, row);
		positive(t, "wavelength", row[wavelength]);
		positive(t, "radius", row[radius]);
		if (!(row[c_ext] > 0) || !isfinite(row[c_ext]))
			die(tab_path(t), "row %llu: c_ext %g um^2 is not positive: the method behind it does not hold there", number, row[c_ext]);
		if (!(row[c_sca] >= 0) || !(row[c_sca] <= row[c_ext] * (1 + 1e-9)))
			die(tab_path(t), "row %llu: c_sca %g is not between 0 and c_ext %g um^2", number, row[c_sca], row[c_ext]);
		rows = xgrow(rows, n + 1, sizeof *rows);
		memcpy(rows[n++], (double[4]){ row[wavelength], row[radius], row[c_ext], row[c_sca] }, sizeof *rows);
		insert(&m->wavelength, &m->n_waves, row[wavelength]);
		insert(&m->radius, &m->n_classes, row[radius]);
		if (m->n_waves > MEDIUM_WAVES || m->n_classes > MEDIUM_CLASSES)
			die(tab_path(t), "more than %d wavelengths or %d radii", MEDIUM_WAVES, MEDIUM_CLASSES);
	}
	law_check_end(law);
	if (!n)
		die(tab_path(t), "has no rows");
	size_t all = (size_t)m->n_classes * (size_t)m->n_waves;
	m->c_ext = xalloc(all, sizeof(double));
	m->c_sca = xalloc(all, sizeof(double));
	m->count = xalloc((size_t)m->n_classes, sizeof(double));
	for (size_t i = 0; i < n; i++) {
		int at = index_of(m->radius, m->n_classes, rows[i][1]) * m->n_waves + index_of(m->wavelength, m->n_waves, rows[i][0]);
		if (m->c_ext[at] > 0)
			die(tab_path(t), "wavelength %g um, radius %g um stands twice", rows[i][0], rows[i][1]);
		m->c_ext[at] = rows[i][2];
		m->c_sca[at] = fmin(rows[i][3], rows[i][2]);
	}
	for (size_t i = 0; i < all; i++)
		if (!(m->c_ext[i] > 0))
			die(tab_path(t), "has no row for wavelength %g um, radius %g um", m->wavelength[i % (size_t)m->n_waves],
			    m->radius[i / (size_t)m->n_waves]);
	free(rows);
	char *history = xtext("%s", tab_history(t));
	tab_close(t);
	return history;
}

static int nearest(const struct medium *m, double radius)
{
	int best = 0;
	double gap[2] = { 1e-6, 1e-6 }, d;
	for (int k = 1; k < m->n_classes; k++)
		if (fabs(log(radius / m->radius[k])) < fabs(log(radius / m->radius[best])))
			best = k;
	if (m->n_classes > 1) {
		/* half the gap below and above; the outermost classes have the same outwards */
		gap[0] = best > 0 ? log(m->radius[best] / m->radius[best - 1]) / 2 : log(m->radius[1] / m->radius[0]) / 2;
		gap[1] = best + 1 < m->n_classes ? log(m->radius[best + 1] / m->radius[best]) / 2 : gap[0];
	}
	d = log(radius / m->radius[best]);
	return fabs(d) <= (d < 0 ? gap[0] : gap[1]) * (1 + 1e-9) ? best : -1;
}

int classes_find(const struct medium *m, const struct tab *t, double radius)
{
	int class = radius > 0 ? nearest(m, radius) : -1;
	if (class < 0)
		die(tab_path(t), "row %llu: radius %g um fits none of the %d classes of --xsect", (unsigned long long)tab_row(t), radius,
		    m->n_classes);
	return class;
}

int classes_exact(const struct medium *m, int class, double radius) { return same(m->radius[class], radius); }

/* -------------------------------------------------------------------- phase functions */

/* A phase function as tabulated: theta in rad. */
struct curve {
	int n;
	double *theta, *p;
};

static void curve_add(struct curve *c, double theta, double p)
{
	if (!(c->n & (c->n - 1))) {    /* room in powers of two */
		size_t room = c->n ? 2 * (size_t)c->n : 1;
		c->theta = xgrow(c->theta, room, sizeof(double));
		c->p = xgrow(c->p, room, sizeof(double));
	}
	c->theta[c->n] = theta;
	c->p[c->n++] = p;
}

/* The union of the nodes of n curves, as floats that differ, and with no interval longer than INTERVAL. */
static struct curve common_grid(int n, const struct curve *c)
{
	struct curve grid = { 0, NULL, NULL };
	size_t all = 0, used = 0;
	for (int i = 0; i < n; i++)
		all += (size_t)c[i].n;
	double *theta = xalloc(all, sizeof *theta);
	for (int i = 0; i < n; i++) {
		memcpy(theta + used, c[i].theta, (size_t)c[i].n * sizeof *theta);
		used += (size_t)c[i].n;
	}
	qsort(theta, all, sizeof *theta, ascending);
	for (size_t i = 0; i < all; i++) {
		double last = grid.n ? grid.theta[grid.n - 1] : 0;
		if (grid.n && (float)theta[i] == (float)last)
			continue;
		int parts = grid.n ? (int)ceil((theta[i] - last) / INTERVAL) : 1;
		for (int k = 1; k <= parts; k++)
			curve_add(&grid, k == parts ? theta[i] : last + (theta[i] - last) * k / parts, 0);
	}
	free(theta);
	return grid;
}

/* Append the nodes of a grid with the values of n_waves curves on it, normalised; remember where. */
static void append(struct medium *m, int class, const struct curve *grid, const struct curve *curves)
{
	size_t n = (size_t)grid->n, waves = (size_t)m->n_waves, at = m->n_nodes;
	double *p = xalloc(n, sizeof *p);
	if ((double)(at + n) * (double)waves > INT32_MAX)
		die("phase functions", "too many angles in all");
	m->n_nodes += n;
	m->theta = xgrow(m->theta, m->n_nodes, sizeof *m->theta);
	m->p = xgrow(m->p, m->n_nodes * waves, sizeof *m->p);
	for (size_t i = 0; i < n; i++)
		m->theta[at + i] = (float)grid->theta[i];
	for (size_t w = 0; w < waves; w++) {
		for (size_t i = 0; i < n; i++)
			p[i] = phase_at(curves[w].n, curves[w].theta, curves[w].p, grid->theta[i]);
		double norm = phase_integral(grid->n, grid->theta, p);
		for (size_t i = 0; i < n; i++)
			m->p[(at + i) * waves + w] = (float)(p[i] / norm);
	}
	m->node[2 * class] = (int32_t)at;
	m->node[2 * class + 1] = grid->n;
	free(p);
}

static void curve_check(const struct tab *t, struct curve *c, double wavelength, double radius)
{
	char what[96];
	if (radius > 0)
		snprintf(what, sizeof what, "wavelength %g um, radius %g um", wavelength, radius);
	else
		snprintf(what, sizeof what, "wavelength %g um", wavelength);
	if (!c->n)
		die(tab_path(t), "has no phase function for %s", what);
	if (c->n < 2 || c->theta[0] > 1e-9 || c->theta[c->n - 1] < M_PI * (1 - 1e-9))
		die(tab_path(t), "%s: theta must reach from 0 to 180 deg", what);
	c->theta[0] = 0;
	c->theta[c->n - 1] = M_PI;
	struct curve grid = common_grid(1, c);
	for (int i = 0; i < grid.n; i++)
		grid.p[i] = phase_at(c->n, c->theta, c->p, grid.theta[i]);
	double norm = phase_integral(grid.n, grid.theta, grid.p);
	if (!(fabs(norm - 1) <= 0.01))
		die(tab_path(t), "%s: the integral over the sphere is %.4f, more than 1 %% off 1: its angles are too few for its peaks "
		    "(leave out --angles, or take more), or p is not normalised", what, norm);
	for (int i = 0; i < c->n; i++)
		c->p[i] /= norm;
	free(grid.theta);
	free(grid.p);
}

/* Read the curves: [class][wave], or [1][wave] for a table without radius. */
static struct curve *read_curves(struct tab *t, const struct medium *m, int *shared)
{
	int wavelength = tab_need(t, &column_wavelength), radius = tab_find(t, &column_radius);
	int theta = tab_need(t, &column_theta), p = tab_need(t, &column_p);
	*shared = radius < 0;
	int classes = *shared ? 1 : m->n_classes;
	struct curve *curves = xalloc((size_t)classes * (size_t)m->n_waves, sizeof *curves), *now = NULL;
	double row[TAB_COLS], key[2] = { 0, 0 };
	while (tab_next(t, row)) {
		unsigned long long number = (unsigned long long)tab_row(t);
		double r = *shared ? 0 : row[radius], angle = row[theta] * M_PI / 180;
		if (!now || row[wavelength] != key[0] || r != key[1]) {
			int w = index_of(m->wavelength, m->n_waves, row[wavelength]), k = *shared ? 0 : index_of(m->radius, m->n_classes, r);
			key[0] = row[wavelength];
			key[1] = r;
			now = w < 0 || k < 0 ? NULL : &curves[k * m->n_waves + w];
			if (now && now->n)
				die(tab_path(t), "row %llu: wavelength %g um, radius %g um comes again", number, key[0], r);
		}
		if (!now)
			continue;              /* not in the table of cross sections: not needed */
		if (!(row[theta] >= 0 && row[theta] <= 180) || (now->n && !(angle > now->theta[now->n - 1])))
			die(tab_path(t), "row %llu: theta %g is not ascending in [0, 180] deg", number, row[theta]);
		if (!(row[p] >= 0) || !isfinite(row[p]))
			die(tab_path(t), "row %llu: p %g is not a finite number of at least 0", number, row[p]);
		if (now->n == PHASE_ANGLES_MAX)
			die(tab_path(t), "row %llu: more than 2^24 angles", number);
		curve_add(now, angle, row[p]);
	}
	for (int k = 0; k < classes; k++)
		for (int w = 0; w < m->n_waves; w++)
			curve_check(t, &curves[k * m->n_waves + w], m->wavelength[w], *shared ? 0 : m->radius[k]);
	return curves;
}

/* The whole medium's phase function: the classes' weighted by count x c_sca (eq 17), linear between the common nodes. */
static void append_mixture(struct medium *m, const struct curve *curves)
{
	int waves = m->n_waves, classes = m->n_classes;
	struct curve grid = common_grid(classes * waves, curves), *mixed = xalloc((size_t)waves, sizeof *mixed);
	for (int w = 0; w < waves; w++) {
		double total = 0;
		for (int k = 0; k < classes; k++)
			total += m->count[k] * m->c_sca[k * waves + w];
		for (int i = 0; i < grid.n; i++) {
			double sum = 0;
			for (int k = 0; k < classes; k++) {
				const struct curve *c = &curves[k * waves + w];
				double share = total > 0 ? m->count[k] * m->c_sca[k * waves + w] / total : 1.0 / classes;
				sum += share * phase_at(c->n, c->theta, c->p, grid.theta[i]);
			}
			curve_add(&mixed[w], grid.theta[i], sum);
		}
	}
	append(m, classes, &grid, mixed);
	for (int w = 0; w < waves; w++) {
		free(mixed[w].theta);
		free(mixed[w].p);
	}
	free(mixed);
	free(grid.theta);
	free(grid.p);
}

char *classes_phase_functions(const char *path, struct medium *m)
{
	struct tab *t = tab_open(path);
	int shared;
	struct curve *curves = read_curves(t, m, &shared);
	int own = shared ? 1 : m->n_classes;
	m->node = xalloc(2 * ((size_t)m->n_classes + 1), sizeof *m->node);
	for (int k = 0; k < own; k++) {
		struct curve grid = common_grid(m->n_waves, curves + k * m->n_waves);
		append(m, k, &grid, curves + k * m->n_waves);
		free(grid.theta);
		free(grid.p);
	}
	if (own > 1)
		append_mixture(m, curves);
	for (int k = own; k <= m->n_classes && own == 1; k++) {    /* all are one */
		m->node[2 * k] = m->node[0];
		m->node[2 * k + 1] = m->node[1];
	}
	for (int i = 0; i < own * m->n_waves; i++) {
		free(curves[i].theta);
		free(curves[i].p);
	}
	free(curves);
	char *history = xtext("%s", tab_history(t));
	tab_close(t);
	return history;
}

#include "toolkit/ensemble.h"

#include "base/die.h"
#include "format/columns.h"
#include "optics/mie/mie_host.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *ensemble_path(const struct ensemble *e) { return tab_path(spheres_table(e->in)); }

int ensemble_limited(const struct ensemble *e, const struct waves *w)
{
	return e->lo_col >= 0 && w->carried[e->lo_col] < w->carried[e->hi_col];
}

static void check(const struct ensemble *e, const struct waves *w)
{
	const struct size *s = &w->size;
	double weight = w->carried[e->weight_col];
	if (!(weight >= 0) || isinf(weight))
		die(ensemble_path(e), "weight %g of radius %g um is not a fraction", weight, s->radius);
	if (e->lo_col < 0)
		return;
	double lo = w->carried[e->lo_col], hi = w->carried[e->hi_col];
	if (!(lo > 0 && lo <= s->radius && s->radius <= hi && hi < INFINITY) || (lo < hi && (lo == s->radius || hi == s->radius)))
		die(ensemble_path(e), "radius %g um does not lie between radius_lo %g um and radius_hi %g um", s->radius, lo, hi);
	double least = s->x * (lo / s->radius), most = s->x * (hi / s->radius);
	if (!(least >= SIZE_X_MIN && most <= SIZE_X_MAX && (hi == lo || cabs(s->m) * most <= size_y_max(s->m))))
		die(ensemble_path(e), "the class of radius %g um has size parameters out of range: from %g to %g, and %g over the index %g",
		    s->radius, SIZE_X_MIN, SIZE_X_MAX, size_y_max(s->m), cabs(s->m));
	if (!(2 * s->x_im * (hi / s->radius) <= MIE_HOST_BETA_MAX))
		die(ensemble_path(e), "in the class of radius %g um 4 pi r Im(host) / wavelength goes up to %g, above %d", s->radius,
		    2 * s->x_im * (hi / s->radius), MIE_HOST_BETA_MAX);
}

size_t ensemble_mean_of(struct ensemble *e, const struct size *size)
{
	size_t at = 0;
	while (at < e->nmean && fabs(e->mean[at].size.wavelength / size->wavelength - 1) > 1e-9)
		at++;
	if (at == e->nmean) {
		e->mean = xgrow(e->mean, ++e->nmean, sizeof *e->mean);
		e->mean[at] = (struct ensemble_mean){ .size = *size };
	}
	return at;
}

static void find_columns(struct ensemble *e)
{
	const struct tab_col own[2] = { column_wavelength, column_radius };
	struct tab_col carried[TAB_COLS];
	struct tab *t = spheres_table(e->in);
	if (!t)
		die("--average", "needs a table with a column weight");
	tab_need(t, &column_weight);
	if (spheres_by_x(e->in))
		die("--average", "needs radii and wavelengths");
	e->lo_col = e->hi_col = -1;
	int n = spheres_carried(e->in, 2, own, carried);
	int limits = !spheres_coeffs(e->in) && tab_find(t, &column_radius_lo) >= 0 && tab_find(t, &column_radius_hi) >= 0;
	for (int i = 0; i < n; i++) {
		if (!strcmp(carried[i].name, column_weight.name))
			e->weight_col = i;
		if (limits && !strcmp(carried[i].name, column_radius_lo.name))
			e->lo_col = i;
		if (limits && !strcmp(carried[i].name, column_radius_hi.name))
			e->hi_col = i;
	}
}

void ensemble_read(struct ensemble *e)
{
	struct psd_class *c = NULL;
	struct waves next;
	size_t room = 0;
	find_columns(e);
	int n = 0;
	double scale = INFINITY;
	while (spheres_next(e->in, &next)) {
		const struct size *s = &next.size;
		check(e, &next);
		ensemble_mean_of(e, s);
		if (e->nw == room)
			e->w = xgrow(e->w, room = 2 * room + 64, sizeof *e->w);
		e->w[e->nw++] = next;
		if (!ensemble_limited(e, &next))
			continue;
		scale = fmin(scale, s->radius / s->x);
		if (!s->first)
			continue;
		if (!(n & (n - 1)))
			c = xgrow(c, n ? 2 * (size_t)n : 1, sizeof *c);
		c[n++] = (struct psd_class){ s->radius, next.carried[e->weight_col], next.carried[e->lo_col], next.carried[e->hi_col] };
	}
	if (n && !(e->sub = size_quadrature_new(n, c, scale)))
		die(NULL, "out of memory");
	free(c);
}

void ensemble_free(struct ensemble *e)
{
	for (size_t i = 0; i < e->nw; i++)
		waves_free(&e->w[i]);
	free(e->w);
	free(e->mean);
	size_quadrature_free(e->sub);
}

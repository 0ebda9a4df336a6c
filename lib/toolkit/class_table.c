#include "toolkit/class_table.h"

#include "base/die.h"
#include "format/columns.h"
#include "optics/mie/mie_host.h"
#include "toolkit/law.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct columns {
	int weight, lo, hi;        /* among what is carried; -1: none */
};

const char *class_table_path(const struct class_table *t) { return tab_path(spheres_table(t->in)); }

int class_table_in(const struct spheres *in)
{
	struct tab *t = spheres_table(in);
	return t && !spheres_coeffs(in) && !spheres_by_x(in) && tab_find(t, &column_weight) >= 0 && tab_find(t, &column_radius_lo) >= 0
	    && tab_find(t, &column_radius_hi) >= 0;
}

void class_table_need(const struct spheres *in)
{
	if (!spheres_table(in))
		die("--average", "needs a table with a column weight");
	tab_need(spheres_table(in), &column_weight);
	if (spheres_by_x(in))
		die("--average", "needs radii and wavelengths");
}

static struct columns find_columns(int n, const struct tab_col *carried)
{
	struct columns c = { -1, -1, -1 };
	for (int i = 0; i < n; i++) {
		if (!strcmp(carried[i].name, column_weight.name))
			c.weight = i;
		if (!strcmp(carried[i].name, column_radius_lo.name))
			c.lo = i;
		if (!strcmp(carried[i].name, column_radius_hi.name))
			c.hi = i;
	}
	return c;
}

/* The class of a row, lo = hi where it is none. */
static struct psd_class class_of(const struct class_table *t, const struct columns *c, const struct waves *w)
{
	const struct size *s = &w->size;
	struct psd_class k = { s->radius, c->weight < 0 ? 1 : w->carried[c->weight], s->radius, s->radius };
	const char *path = class_table_path(t);
	if (!(k.weight >= 0) || isinf(k.weight))
		die(path, "weight %g of radius %g um is not a fraction", k.weight, s->radius);
	if (c->lo < 0)
		return k;
	k.lo = w->carried[c->lo];
	k.hi = w->carried[c->hi];
	if (!(k.lo > 0 && k.lo <= s->radius && s->radius <= k.hi && k.hi < INFINITY) || (k.lo < k.hi && (k.lo == s->radius || k.hi == s->radius)))
		die(path, "radius %g um does not lie between radius_lo %g um and radius_hi %g um", s->radius, k.lo, k.hi);
	double least = s->x * (k.lo / s->radius), most = s->x * (k.hi / s->radius);
	if (!(least >= SIZE_X_MIN && most <= SIZE_X_MAX && (k.hi == k.lo || cabs(s->m) * most <= size_y_max(s->m))))
		die(path, "the class of radius %g um has size parameters out of range: from %g to %g, and %g over the index %g",
		    s->radius, SIZE_X_MIN, SIZE_X_MAX, size_y_max(s->m), cabs(s->m));
	if (!(2 * s->x_im * (k.hi / s->radius) <= MIE_HOST_BETA_MAX))
		die(path, "in the class of radius %g um 4 pi r Im(host) / wavelength goes up to %g, above %d", s->radius,
		    2 * s->x_im * (k.hi / s->radius), MIE_HOST_BETA_MAX);
	return k;
}

static size_t wave_of(struct class_table *t, const struct size *size)
{
	size_t at = 0;
	while (at < t->waves && fabs(t->wave[at].wavelength / size->wavelength - 1) > 1e-9)
		at++;
	if (at == t->waves) {
		t->wave = xgrow(t->wave, ++t->waves, sizeof *t->wave);
		t->wave[at] = *size;
	}
	return at;
}

/* Index of a class of these limits, in a sorted list. */
static int find(const struct class_table *t, double lo, double hi)
{
	int from = 0, to = t->classes;
	while (from < to) {
		int middle = from + (to - from) / 2;
		const struct psd_class *c = &t->class[middle];
		if (c->lo < lo || (c->lo == lo && c->hi < hi))
			from = middle + 1;
		else
			to = middle;
	}
	return from;
}

struct class_table *class_table_read(struct spheres *in, int ncarried, const struct tab_col *carried, int at_radius)
{
	struct class_table *t = xalloc(1, sizeof *t);
	struct columns c = find_columns(ncarried, carried);
	struct waves next;
	size_t room = 0;
	int classes = 0, kinds = class_table_in(in);
	if (!kinds)
		c.lo = c.hi = -1;
	t->in = in;
	t->ncarried = ncarried;
	memcpy(t->carried, carried, (size_t)ncarried * sizeof *carried);
	while (spheres_next(in, &next)) {
		struct psd_class k = class_of(t, &c, &next);
		if (t->n == room)
			t->row = xgrow(t->row, room = 2 * room + 64, sizeof *t->row);
		t->row[t->n++] = (struct class_row){ next, k.weight, -1, wave_of(t, &next.size) };
		if (!kinds || !next.size.first)
			continue;
		if (!(classes & (classes - 1)))
			t->class = xgrow(t->class, classes ? 2 * (size_t)classes : 1, sizeof *t->class);
		t->class[classes++] = k;
	}
	t->has_law = kinds && law_fits(spheres_table(in), &t->law, &classes, t->class);
	for (int i = 0; i < classes; i++)
		if (!at_radius && t->class[i].lo < t->class[i].hi && t->class[i].weight > 0)
			t->class[t->classes++] = t->class[i];
	if (!t->classes)
		return t;
	t->density = t->has_law ? size_density_of_law(&t->law) : size_density_of_classes(t->classes, t->class);
	if (!t->density)
		die(NULL, "out of memory");
	for (size_t i = 0; i < t->n; i++) {
		const double *v = t->row[i].w.carried;
		if (v[c.lo] < v[c.hi] && t->row[i].weight > 0)
			t->row[i].class = find(t, v[c.lo], v[c.hi]);
	}
	return t;
}

void class_table_free(struct class_table *t)
{
	for (size_t i = 0; i < t->n; i++)
		waves_free(&t->row[i].w);
	free(t->row);
	free(t->wave);
	free(t->class);
	size_density_free(t->density);
	free(t);
}

struct size class_table_size(const struct class_table *t, size_t wave, double radius)
{
	struct size size = t->wave[wave];
	size.x *= radius / size.radius;
	size.radius = radius;
	size.x_im = size_x_im(&size);
	return size;
}

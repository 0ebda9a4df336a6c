#include "toolkit/spheres.h"

#include "base/die.h"
#include "format/columns.h"
#include "toolkit/coeffs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BATCH_X 1e6      /* sum of size parameters in a batch */

struct spheres {
	struct tab *table;                   /* NULL: the options give the sizes */
	struct sizes *sizes;                 /* one of the two */
	struct coeffs *coeffs;
	int ncarried, carried_col[TAB_COLS];
	int weight_col, lo_col, hi_col;      /* -1: none */
	int classes;                         /* coefficients of a class with limits were read */
	double x_max, area, area_x2;         /* of spheres_extent */
};

static struct spheres *open_input(const struct sizes_options *o, const char *operand)
{
	struct spheres *s = xalloc(1, sizeof *s);
	s->table = sizes_input(o, operand);
	s->weight_col = s->table ? tab_find(s->table, &column_weight) : -1;
	s->lo_col = s->table ? tab_find(s->table, &column_radius_lo) : -1;
	s->hi_col = s->table ? tab_find(s->table, &column_radius_hi) : -1;
	return s;
}

struct spheres *spheres_open_sizes(const struct sizes_options *o, const char *operand)
{
	sizes_require(o);
	struct spheres *s = open_input(o, operand);
	s->sizes = sizes_over(o, s->table);
	return s;
}

struct spheres *spheres_open(const struct sizes_options *o, const char *operand)
{
	struct spheres *s = open_input(o, operand);
	if (!s->table || !coeffs_in(s->table)) {
		s->sizes = sizes_over(o, s->table);
		return s;
	}
	if (o->particle || o->wavelength.n || strcmp(o->host, "1.0"))
		die(o->particle ? "--particle" : o->wavelength.n ? "--wavelength" : "--host", "is settled by the coefficients in %s",
		    tab_path(s->table));
	s->coeffs = coeffs_over(s->table);
	sizes_threads(o);
	return s;
}

struct tab *spheres_table(const struct spheres *s) { return s->table; }
const char *spheres_coeffs(const struct spheres *s) { return s->coeffs ? tab_path(s->table) : NULL; }
const char *spheres_history(const struct spheres *s) { return s->table ? tab_history(s->table) : ""; }
const char *spheres_law(const struct spheres *s) { return s->table ? tab_law(s->table) : NULL; }
int spheres_by_x(const struct spheres *s) { return s->sizes ? sizes_by_x(s->sizes) : coeffs_by_x(s->coeffs); }

int spheres_key_columns(const struct spheres *s, struct tab_col *cols)
{
	if (spheres_by_x(s)) {
		cols[0] = column_size_parameter;
		return 1;
	}
	cols[0] = column_wavelength;
	cols[1] = column_radius;
	return 2;
}

int spheres_key(const struct spheres *s, const struct size *size, double *row)
{
	if (spheres_by_x(s)) {
		row[0] = size->x;
		return 1;
	}
	row[0] = size->wavelength;
	row[1] = size->radius;
	return 2;
}

static int among(const char *name, int n, const struct tab_col *cols)
{
	for (int i = 0; i < n; i++)
		if (!strcmp(cols[i].name, name))
			return 1;
	return 0;
}

int spheres_carried(struct spheres *s, int nown, const struct tab_col *own, struct tab_col *cols)
{
	int ncoeffs = s->coeffs ? COEFFS_COLS : 0;
	s->ncarried = 0;
	for (int i = 0; s->table && i < tab_ncols(s->table); i++) {
		const struct tab_col *c = &tab_cols(s->table)[i];
		if (among(c->name, nown, own) || among(c->name, ncoeffs, column_coeffs))
			continue;
		if (nown + ncoeffs + s->ncarried == TAB_COLS)
			die(tab_path(s->table), "has too many columns to carry through");
		cols[s->ncarried] = *c;
		s->carried_col[s->ncarried++] = i;
	}
	return s->ncarried;
}

void spheres_carry(const struct spheres *s, const struct waves *w, double *row)
{
	for (int i = 0; i < s->ncarried; i++)
		row[i] = w->carried[i];
}

static void add_extent(struct spheres *s, const struct size *size, const double *row)
{
	double x = size_extent(size), area = size->radius > 0 ? size->radius * size->radius : x * x;
	if (s->weight_col >= 0)
		area *= row[s->weight_col];
	s->x_max = x > s->x_max ? x : s->x_max;
	s->area += area;
	s->area_x2 += area * x * x;
}

double spheres_extent(const struct spheres *s, int mean)
{
	return mean && s->area > 0 ? sqrt(s->area_x2 / s->area) : s->x_max;
}

int spheres_next(struct spheres *s, struct waves *out)
{
	*out = (struct waves){ 0 };
	if (s->sizes ? !sizes_next(s->sizes, &out->size) : !coeffs_next(s->coeffs, out))
		return 0;
	const double *row = !s->table ? NULL : s->sizes ? sizes_row(s->sizes) : coeffs_row(s->coeffs);
	add_extent(s, &out->size, row);
	s->classes |= s->coeffs && s->lo_col >= 0 && s->hi_col >= 0 && row[s->lo_col] < row[s->hi_col];
	if (!s->ncarried)
		return 1;
	out->carried = xalloc((size_t)s->ncarried, sizeof *out->carried);
	for (int i = 0; i < s->ncarried; i++)
		out->carried[i] = row[s->carried_col[i]];
	return 1;
}

int spheres_batch(struct spheres *s, struct waves out[SPHERES_BATCH])
{
	double x = 0;
	int n = 0;
	while (n < SPHERES_BATCH && x < BATCH_X && spheres_next(s, &out[n]))
		x += out[n++].size.x;
	return n;
}

void spheres_warn_classes(const struct spheres *s)
{
	if (s->classes)
		warn(tab_path(s->table), "coefficients of classes are those of their radii alone, and so is what is made of them: "
		     "no mean over a class; give the sizes for that, or --at-radius if it is meant");
}

void spheres_close(struct spheres *s)
{
	if (s->sizes)
		sizes_close(s->sizes);
	else
		coeffs_close(s->coeffs);
	if (s->table)
		tab_close(s->table);
	free(s);
}

#include "toolkit/coeffs.h"

#include "base/die.h"
#include "optics/mie/mie_host.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct tab_col coeffs_cols[COEFFS_COLS] = {
	{ "host_re", TAB_F64, "1" }, { "host_im", TAB_F64, "1" }, { "n", TAB_I32, "1" },
	{ "a_re", TAB_F64, "1" }, { "a_im", TAB_F64, "1" }, { "b_re", TAB_F64, "1" }, { "b_im", TAB_F64, "1" },
};

enum { HOST_RE, HOST_IM, N, A_RE, A_IM, B_RE, B_IM };

struct coeffs {
	struct sizes *sizes;                 /* NULL: coefficients are read */
	struct tab *table;
	int by_x, key_col[2], col[COEFFS_COLS];
	int ncarried, carried_col[TAB_COLS];
	double row[TAB_COLS];                /* the row with n = 1 that comes next */
	int pending;
	double last_radius;
};

int waves_solve(struct waves *w)
{
	if (w->a)
		return 0;
	int clear = w->size.x_im == 0;
	double complex x = size_x(&w->size);
	w->n = clear ? mie_terms(w->size.x, w->size.m) : mie_host_terms(x, w->size.m);
	w->lossless = clear && cimag(w->size.m) == 0;
	w->a = malloc(((size_t)w->n + 1) * sizeof *w->a);
	w->b = malloc(((size_t)w->n + 1) * sizeof *w->b);
	if (!w->a || !w->b)
		return -1;
	return clear ? mie_coefficients(w->size.x, w->size.m, w->n, w->a, w->b) : mie_host_coefficients(x, w->size.m, w->n, w->a, w->b);
}

struct efficiencies waves_efficiencies(const struct waves *w, double *error)
{
	if (w->size.x_im > 0)
		return mie_host_efficiencies(size_x(&w->size), w->n, w->a, w->b, error);
	return mie_efficiencies(w->size.x, w->lossless, w->n, w->a, w->b, error);
}

double waves_norm(const struct waves *w, double q_sca)
{
	return w->size.x_im > 0 ? mie_host_norm(size_x(&w->size), q_sca) : M_PI * w->size.x * w->size.x * q_sca;
}

void waves_drop(struct waves *w)
{
	free(w->a);
	free(w->b);
	w->a = w->b = NULL;
}

void waves_free(struct waves *w)
{
	waves_drop(w);
	free((double *)w->size.carried);
	w->size.carried = NULL;
}

void coeffs_values(const struct waves *w, int l, double *row)
{
	row[HOST_RE] = creal(w->size.host);
	row[HOST_IM] = cimag(w->size.host);
	row[N] = l;
	row[A_RE] = creal(w->a[l]);
	row[A_IM] = cimag(w->a[l]);
	row[B_RE] = creal(w->b[l]);
	row[B_IM] = cimag(w->b[l]);
}

static struct coeffs *over_sizes(struct sizes *s, struct tab *table)
{
	struct coeffs *c = xalloc(1, sizeof *c);
	c->sizes = s;
	c->table = table;
	c->by_x = sizes_by_x(s);
	return c;
}

struct coeffs *coeffs_open_sizes(const struct sizes_options *o, const char *operand)
{
	sizes_require(o);
	struct tab *table = sizes_input(o, operand);
	return over_sizes(sizes_over(o, table), table);
}

struct coeffs *coeffs_open(const struct sizes_options *o, const char *operand)
{
	struct tab *table = sizes_input(o, operand);
	if (!table || tab_find(table, "a_re", "1") < 0)
		return over_sizes(sizes_over(o, table), table);
	if (o->particle || o->wavelength.n || strcmp(o->host, "1.0"))
		die(o->particle ? "--particle" : o->wavelength.n ? "--wavelength" : "--host", "is settled by the coefficients in %s", tab_path(table));
	struct coeffs *c = xalloc(1, sizeof *c);
	c->table = table;
	c->by_x = tab_find(table, "radius", "um") < 0 && tab_find(table, "x", "1") >= 0;
	c->key_col[0] = c->by_x ? tab_need(table, "x", "1") : tab_need(table, "wavelength", "um");
	c->key_col[1] = c->by_x ? c->key_col[0] : tab_need(table, "radius", "um");
	for (int i = 0; i < COEFFS_COLS; i++)
		c->col[i] = tab_need(table, coeffs_cols[i].name, coeffs_cols[i].unit);
	c->pending = tab_next(table, c->row);
	if (!c->pending)
		die(tab_path(table), "has no rows");
	sizes_threads(o);
	return c;
}

const char *coeffs_read(const struct coeffs *c) { return c->sizes ? NULL : tab_path(c->table); }
struct tab *coeffs_table(const struct coeffs *c) { return c->table; }
int coeffs_by_x(const struct coeffs *c) { return c->by_x; }
const char *coeffs_history(const struct coeffs *c) { return c->table ? tab_history(c->table) : ""; }
int coeffs_columns(const struct coeffs *c, struct tab_col *cols) { return sizes_key_columns(c->by_x, cols); }
int coeffs_key(const struct coeffs *c, const struct size *size, double *row) { return sizes_key_values(c->by_x, size, row); }

int coeffs_carried(struct coeffs *c, int nown, const struct tab_col *own, struct tab_col *cols)
{
	struct tab_col all[TAB_COLS];
	if (nown + (c->sizes ? 0 : COEFFS_COLS) > TAB_COLS)
		die(tab_path(c->table), "has too many columns to carry through");
	memcpy(all, own, (size_t)nown * sizeof *own);
	if (c->sizes)
		return c->ncarried = sizes_carried(c->sizes, nown, own, cols);
	/* The coefficients themselves stop here. */
	memcpy(all + nown, coeffs_cols, sizeof coeffs_cols);
	return c->ncarried = sizes_carried_of(c->table, nown + COEFFS_COLS, all, cols, c->carried_col);
}

void coeffs_carry(const struct coeffs *c, const struct waves *w, double *row)
{
	for (int i = 0; i < c->ncarried; i++)
		row[i] = w->size.carried[i];
}

static void bad_row(const struct coeffs *c, const char *what)
{
	die(tab_path(c->table), "row %llu: %s", (unsigned long long)tab_row(c->table), what);
}

static struct size size_of_row(struct coeffs *c)
{
	const double *row = c->row;
	struct size s = { .m = CMPLX(NAN, NAN), .host = CMPLX(row[c->col[HOST_RE]], row[c->col[HOST_IM]]) };
	if (row[c->col[N]] != 1)
		bad_row(c, "a size does not begin with n = 1");
	if (!(creal(s.host) > 0) || isinf(creal(s.host)))
		bad_row(c, "host_re is not greater than 0");
	if (!(cimag(s.host) >= 0) || isinf(cimag(s.host)))
		bad_row(c, "host_im is negative or no number");
	if (c->by_x) {
		s.x = row[c->key_col[0]];
	} else {
		s.wavelength = row[c->key_col[0]];
		s.radius = row[c->key_col[1]];
		if (!(s.wavelength > 0) || isinf(s.wavelength))
			bad_row(c, "wavelength is not a positive length");
		if (!(s.radius > 0) || isinf(s.radius))
			bad_row(c, "radius is not a positive length");
		s.x = sizes_x(s.radius, s.wavelength, creal(s.host));
	}
	s.x_im = size_x_im(&s);
	if (!(s.x >= SIZES_X_MIN && s.x <= SIZES_X_MAX))
		die(tab_path(c->table), "row %llu: size parameter %g is out of range: from %g to %g",
		    (unsigned long long)tab_row(c->table), s.x, SIZES_X_MIN, SIZES_X_MAX);
	if (!(2 * s.x_im <= MIE_HOST_BETA_MAX))
		die(tab_path(c->table), "row %llu: 4 pi r host_im / wavelength is %g, out of range: at most %d",
		    (unsigned long long)tab_row(c->table), 2 * s.x_im, MIE_HOST_BETA_MAX);
	s.first = c->by_x || s.radius != c->last_radius;
	c->last_radius = s.radius;
	return s;
}

static double complex finite_pair(const struct coeffs *c, int re, int im)
{
	double complex z = CMPLX(c->row[c->col[re]], c->row[c->col[im]]);
	if (!isfinite(creal(z)) || !isfinite(cimag(z)))
		bad_row(c, "a coefficient is not finite");
	return z;
}

static int next_read(struct coeffs *c, struct waves *w, double *carried)
{
	if (!c->pending)
		return 0;
	w->size = size_of_row(c);
	for (int i = 0; i < c->ncarried; i++)
		carried[i] = c->row[c->carried_col[i]];
	double key[2] = { c->row[c->key_col[0]], c->row[c->key_col[1]] };
	int room = 0;
	do {
		int n = w->n + 1;
		if (c->row[c->col[N]] != n)
			bad_row(c, "n does not ascend by 1");
		if (c->row[c->key_col[0]] != key[0] || c->row[c->key_col[1]] != key[1])
			bad_row(c, "the size or wavelength changes where n does not return to 1");
		if (n >= room) {
			room = 2 * n + 32;
			w->a = xgrow(w->a, (size_t)room, sizeof *w->a);
			w->b = xgrow(w->b, (size_t)room, sizeof *w->b);
		}
		w->a[n] = finite_pair(c, A_RE, A_IM);
		w->b[n] = finite_pair(c, B_RE, B_IM);
		w->n = n;
		c->pending = tab_next(c->table, c->row);
	} while (c->pending && c->row[c->col[N]] != 1);
	w->a[0] = w->b[0] = 0;
	w->lossless = w->size.x_im == 0 && mie_lossless(w->n, w->a, w->b);
	return 1;
}

int coeffs_next(struct coeffs *c, struct waves *out)
{
	double *carried = c->ncarried ? xalloc((size_t)c->ncarried, sizeof *carried) : NULL;
	*out = (struct waves){ 0 };
	if (!c->sizes ? !next_read(c, out, carried) : !sizes_next(c->sizes, &out->size)) {
		free(carried);
		return 0;
	}
	if (c->sizes && c->ncarried)
		memcpy(carried, out->size.carried, (size_t)c->ncarried * sizeof *carried);
	out->size.carried = carried;
	return 1;
}

int coeffs_batch(struct coeffs *c, struct waves out[COEFFS_BATCH])
{
	double x = 0;
	int n = 0;
	while (n < COEFFS_BATCH && x < 1e6 && coeffs_next(c, &out[n]))
		x += out[n++].size.x;
	return n;
}

void coeffs_close(struct coeffs *c)
{
	if (c->sizes)
		sizes_close(c->sizes);
	else
		tab_close(c->table);
	free(c);
}

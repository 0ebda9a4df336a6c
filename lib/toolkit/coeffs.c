#include "toolkit/coeffs.h"

#include "base/die.h"
#include "optics/mie/mie_host.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HOST_RE, HOST_IM, N, A_RE, A_IM, B_RE, B_IM };    /* column_coeffs */

struct coeffs {
	struct tab *table;
	int by_x, key_col[2], col[COEFFS_COLS];
	double row[TAB_COLS];                /* the row with n = 1 that comes next */
	double first[TAB_COLS];              /* that of the waves at hand */
	int pending;
	double last_radius;
};

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

int coeffs_in(const struct tab *table) { return tab_find(table, &column_coeffs[A_RE]) >= 0; }

struct coeffs *coeffs_over(struct tab *table)
{
	struct coeffs *c = xalloc(1, sizeof *c);
	c->table = table;
	c->by_x = tab_find(table, &column_radius) < 0 && tab_find(table, &column_size_parameter) >= 0;
	c->key_col[0] = c->by_x ? tab_need(table, &column_size_parameter) : tab_need(table, &column_wavelength);
	c->key_col[1] = c->by_x ? c->key_col[0] : tab_need(table, &column_radius);
	for (int i = 0; i < COEFFS_COLS; i++)
		c->col[i] = tab_need(table, &column_coeffs[i]);
	c->pending = tab_next(table, c->row);
	if (!c->pending)
		die(tab_path(table), "has no rows");
	return c;
}

int coeffs_by_x(const struct coeffs *c) { return c->by_x; }

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
		s.x = size_parameter(s.radius, s.wavelength, creal(s.host));
	}
	s.x_im = size_x_im(&s);
	if (!(s.x >= SIZE_X_MIN && s.x <= SIZE_X_MAX))
		die(tab_path(c->table), "row %llu: size parameter %g is out of range: from %g to %g",
		    (unsigned long long)tab_row(c->table), s.x, SIZE_X_MIN, SIZE_X_MAX);
	if (!(2 * s.x_im <= MIE_HOST_BETA_MAX))
		die(tab_path(c->table), "row %llu: 4 pi r host_im / wavelength is %g, out of range: at most %d",
		    (unsigned long long)tab_row(c->table), 2 * s.x_im, MIE_HOST_BETA_MAX);
	s.first = c->by_x || s.radius != c->last_radius;
	c->last_radius = s.radius;
	return s;
}

/* Squares and their sums are doubles from LEAST to MOST; no sphere's are beyond 1, or e^beta in a host that absorbs. */
#define LEAST 1e-150
#define MOST 1e30

static double complex coefficient(const struct coeffs *c, const struct size *s, int re, int im)
{
	double complex z = CMPLX(c->row[c->col[re]], c->row[c->col[im]]);
	double most = fmax(MOST, exp(2 * s->x_im));
	if (!isfinite(creal(z)) || !isfinite(cimag(z)))
		bad_row(c, "a coefficient is not finite");
	if (fabs(creal(z)) > most || fabs(cimag(z)) > most)
		bad_row(c, "a coefficient is out of range (1e30): no sphere has such");
	return z;
}

static void must_scatter(const struct coeffs *c, const struct waves *w)
{
	double most = 0;
	char name[SIZE_NAME];
	for (int n = 1; n <= w->n; n++)
		most = fmax(most, fmax(cabs(w->a[n]), cabs(w->b[n])));
	if (!(most > LEAST))
		die(tab_path(c->table), "%s: no coefficient is above %g: the sphere does not scatter", size_name(&w->size, name), LEAST);
}

int coeffs_next(struct coeffs *c, struct waves *w)
{
	*w = (struct waves){ 0 };
	if (!c->pending)
		return 0;
	w->size = size_of_row(c);
	memcpy(c->first, c->row, sizeof c->first);
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
		w->a[n] = coefficient(c, &w->size, A_RE, A_IM);
		w->b[n] = coefficient(c, &w->size, B_RE, B_IM);
		w->n = n;
		c->pending = tab_next(c->table, c->row);
	} while (c->pending && c->row[c->col[N]] != 1);
	w->a[0] = w->b[0] = 0;
	must_scatter(c, w);
	w->lossless = w->size.x_im == 0 && mie_lossless(w->n, w->a, w->b);
	return 1;
}

const double *coeffs_row(const struct coeffs *c) { return c->first; }

void coeffs_close(struct coeffs *c) { free(c); }

#include "toolkit/sizes.h"

#include "base/ascending.h"
#include "base/cpu.h"
#include "base/die.h"
#include "format/columns.h"
#include "optics/index/ior.h"
#include "optics/mie/mie_host.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Relative refractive indices in reach; with |m| x no larger than this, orders fit an int. */
#define M_MIN 1e-3
#define M_MAX 2e3

struct sizes {
	struct tab *table;                  /* NULL: the options give the sizes */
	int radius_col;
	double row[TAB_COLS];
	struct reals radius, x;             /* as in the options */
	size_t at;                          /* next of them */
	size_t nwave, wave;                 /* wavelengths (1 by size parameter), and the next one */
	const double *wavelength;
	double complex *host;               /* per wavelength */
	double complex *m;
	double size_radius;                 /* (or x) of the size at hand */
};

static struct ior index_of(const char *option, const char *text)
{
	struct ior ior;
	const char *bad = ior_parse(text, &ior);
	if (bad)
		die(option, "'%s' %s", text, bad);
	return ior;
}

static double complex index_at(const char *option, const char *text, const struct ior *ior, double wavelength)
{
	double complex value;
	const char *bad = ior_at(ior, wavelength, &value);
	if (bad)
		die(option, "'%s' at %g um %s", text, wavelength, bad);
	return value;
}

/* p / h, with the digits of a small imaginary part; by a real h its parts are divided. */
static double complex quotient(double complex p, double complex h)
{
	if (cimag(h) == 0)
		return CMPLX(creal(p) / creal(h), cimag(p) / creal(h));
	double scale = cabs(h), re = creal(h) / scale, im = cimag(h) / scale, pr = creal(p) / scale, pi = cimag(p) / scale;
	return CMPLX(pr * re + pi * im, pi * re - pr * im);
}

/* Relative index at every wavelength; done before the first row, so that a bad index leaves no half a table behind. */
static void indices(struct sizes *s, const struct sizes_options *o)
{
	struct ior particle = index_of("--particle", o->particle), host = index_of("--host", o->host);
	if (sizes_by_x(s) && particle.material)
		die("--particle", "'%s' needs a wavelength; with --size-parameter give a number", o->particle);
	if (sizes_by_x(s) && host.material)
		die("--host", "'%s' needs a wavelength; with --size-parameter give a number", o->host);
	s->nwave = sizes_by_x(s) ? 1 : o->wavelength.n;
	s->wavelength = o->wavelength.v;
	s->host = xalloc(s->nwave, sizeof *s->host);
	s->m = xalloc(s->nwave, sizeof *s->m);
	for (size_t i = 0; i < s->nwave; i++) {
		double w = sizes_by_x(s) ? 0 : s->wavelength[i];
		double complex p = index_at("--particle", o->particle, &particle, w), h = index_at("--host", o->host, &host, w);
		if (cimag(h) != 0 && o->clear_host)
			die("--host", "'%s' absorbs; only Lorenz-Mie theory is for such a host", o->host);
		s->host[i] = h;
		s->m[i] = quotient(p, h);
		if (s->m[i] == 1 || p == h)
			die("--particle", "'%s' has the host's own refractive index: it does not scatter", o->particle);
		if (!(cabs(s->m[i]) >= M_MIN && cabs(s->m[i]) <= M_MAX))
			die("--particle", "'%s' is %g times the host's refractive index, out of range: from %g to %g",
			    o->particle, cabs(s->m[i]), M_MIN, M_MAX);
	}
}

/* Tables are looked up by wavelength, and match within 1e-9: a second of the same could not be told from the first. */
static void wavelengths_differ(const struct reals *w)
{
	if (w->n < 2)
		return;
	struct reals sorted = { xalloc(w->n, sizeof(double)), w->n };
	memcpy(sorted.v, w->v, w->n * sizeof(double));
	qsort(sorted.v, sorted.n, sizeof(double), ascending);
	for (size_t i = 1; i < sorted.n; i++)
		if (sorted.v[i] - sorted.v[i - 1] <= 1e-9 * sorted.v[i])
			die("--wavelength", "%g um stands twice", sorted.v[i]);
	free(sorted.v);
}

void sizes_require(const struct sizes_options *o)
{
	if (o->radius.n && o->x.n)
		die("--size-parameter", "excludes --radius");
	if (!o->particle)
		die("--particle", "is missing: the refractive index or material of the particles");
	if (o->x.n && o->wavelength.n)
		die("--size-parameter", "excludes --wavelength");
	if (!o->x.n && !o->wavelength.n)
		die("--wavelength", "is missing (write it like 550nm), or give --size-parameter");
	wavelengths_differ(&o->wavelength);
}

void sizes_threads(const struct sizes_options *o)
{
	cpu_level();
	omp_set_num_threads((int)o->threads);
}

struct tab *sizes_input(const struct sizes_options *o, const char *operand)
{
	if (operand && (o->radius.n || o->x.n))
		die(operand, "a table of sizes excludes %s", o->x.n ? "--size-parameter" : "--radius");
	return o->radius.n || o->x.n ? NULL : tab_open(operand);
}

struct sizes *sizes_over(const struct sizes_options *o, struct tab *table)
{
	struct sizes *s = xalloc(1, sizeof *s);
	s->table = table;
	s->radius = o->radius;
	s->x = o->x;
	sizes_require(o);
	for (size_t i = 0; i < o->x.n; i++)
		if (!(o->x.v[i] >= SIZE_X_MIN && o->x.v[i] <= SIZE_X_MAX))
			die("--size-parameter", "%g is out of range: from %g to %g", o->x.v[i], SIZE_X_MIN, SIZE_X_MAX);
	indices(s, o);
	if (table)
		s->radius_col = tab_need(table, &column_radius);
	sizes_threads(o);
	return s;
}

int sizes_by_x(const struct sizes *s) { return s->x.n > 0; }

/* What the size at hand is at wavelength i. */
static void size_at(const struct sizes *s, size_t i, struct size *out)
{
	out->m = s->m[i];
	out->host = s->host[i];
	out->first = i == 0;
	out->wavelength = sizes_by_x(s) ? 0 : s->wavelength[i];
	out->radius = sizes_by_x(s) ? 0 : s->size_radius;
	out->x = sizes_by_x(s) ? s->size_radius : size_parameter(s->size_radius, out->wavelength, creal(out->host));
	out->x_im = size_x_im(out);
}

static void check_x(const struct sizes *s, const struct size *size)
{
	double x = size->x, radius = size->radius, wavelength = size->wavelength;
	double complex m = size->m;
	if (size->x_im > 0) {
		char name[SIZE_NAME];
		if (2 * size->x_im > MIE_HOST_BETA_MAX)
			die("--host", "4 pi r Im(host) / wavelength is %g at %s, out of range: at most %d",
			    2 * size->x_im, size_name(size, name), MIE_HOST_BETA_MAX);
		m *= size->host / creal(size->host);    /* m x is now that of the complex x */
	}
	if ((creal(m) + cimag(m)) * x > 1e9 && cabs(m) * x > size_y_max(m))    /* the former without a root */
		die("--particle", "size parameter %g times relative index %g exceeds %g", x, cabs(m), size_y_max(m));
	if (x >= SIZE_X_MIN && x <= SIZE_X_MAX)
		return;
	if (s->table)
		die(tab_path(s->table), "row %llu: size parameter %g (radius %g um, wavelength %g um) is out of range: from %g to %g",
		    (unsigned long long)tab_row(s->table), x, radius, wavelength, SIZE_X_MIN, SIZE_X_MAX);
	die("--radius", "size parameter %g (radius %g um, wavelength %g um) is out of range: from %g to %g",
	    x, radius, wavelength, SIZE_X_MIN, SIZE_X_MAX);
}

/* The next radius, or x; 0 at the end. */
static int next_size(struct sizes *s)
{
	if (!s->table) {
		const struct reals *r = sizes_by_x(s) ? &s->x : &s->radius;
		if (s->at == r->n)
			return 0;
		s->size_radius = r->v[s->at++];
	} else {
		if (!tab_next(s->table, s->row)) {
			if (!tab_row(s->table))
				die(tab_path(s->table), "has no rows");
			return 0;
		}
		s->size_radius = s->row[s->radius_col];
		if (!(s->size_radius > 0) || isinf(s->size_radius))
			die(tab_path(s->table), "row %llu: radius %g um is not a positive length",
			    (unsigned long long)tab_row(s->table), s->size_radius);
	}
	for (size_t i = 0; i < s->nwave; i++) {
		struct size size;
		size_at(s, i, &size);
		check_x(s, &size);
	}
	return 1;
}

int sizes_next(struct sizes *s, struct size *out)
{
	if (!s->wave && !next_size(s))
		return 0;
	size_at(s, s->wave, out);
	s->wave = (s->wave + 1) % s->nwave;
	return 1;
}

const double *sizes_row(const struct sizes *s) { return s->row; }

void sizes_close(struct sizes *s)
{
	free(s->host);
	free(s->m);
	free(s);
}

/* sizes - what the optics tools share: their options, and the sizes they are asked about.
 *
 * Sizes come from a table with a radius column (its other columns are carried through), from --radius, or from
 * --size-parameter, where x stands for wavelength and radius both. They are handed out size by size, within a size by
 * wavelength in the order given. Everything dies at the first error. */
#ifndef TOOLKIT_SIZES_H
#define TOOLKIT_SIZES_H

#include "base/opt.h"
#include "format/tab.h"

#include "base/cmplx.h"

/* The options as given; zero-initialised, but for host (SIZES_INIT). */
struct sizes_options {
	const char *particle, *host;       /* a number or a material's name */
	struct reals wavelength;           /* um, in vacuum */
	struct reals radius;               /* um */
	struct reals x;                    /* size parameters */
	long long threads;
	int clear_host;                    /* by the tool: a host that absorbs is refused */
};

#define SIZES_INIT { .host = "1.0", .threads = 1 }

/* Rows for the option table. */
#define SIZES_OPTIONS(o) \
	{ "--particle", OPT_TEXT, &(o).particle, 0, 0, "M", "refractive index (1.33, 1.5+0.1i) or material of the particle", 0 }, \
	{ "--host", OPT_TEXT, &(o).host, 0, 0, "M", "the same of the medium around it", 0 }, \
	{ "--wavelength", OPT_UM_STEPS, &(o).wavelength, 1e-4, 1e4, "L[,L..]", "vacuum wavelengths, or an inclusive range FROM:TO:STEP", 0 }, \
	{ "--radius", OPT_UMS, &(o).radius, 1e-9, 1e9, "R[,R..]", "radii, or FROM:TO:COUNT log-spaced, instead of a table", 0 }, \
	{ "--size-parameter", OPT_REALS, &(o).x, 0, 0, "X[,X..]", "size parameters instead of wavelengths and radii, or FROM:TO:COUNT", 0 }, \
	{ "--threads", OPT_INT, &(o).threads, 1, 1024, "N", "threads", 1 }

/* One (size, wavelength). */
struct size {
	double x, x_im;              /* size parameter 2 pi r eta_m / lambda; x_im > 0 where the host absorbs */
	double complex m;            /* relative refractive index, particle over host */
	double wavelength, radius;   /* um; both 0 when asked by size parameter */
	double complex host;         /* refractive index of the host */
	const double *carried;       /* values of the carried columns; good until the next size is asked for */
	int first;                   /* first wavelength of this size */
};

struct sizes;

#define SIZES_X_MIN 1e-8
#define SIZES_X_MAX 1e7

/* sizes_y_max - the largest |m| x of relative index m; more would take minutes a size. */
double sizes_y_max(double complex m);

/* sizes_x - size parameter of a radius at a vacuum wavelength (both um) in a host of the given index. */
double sizes_x(double radius, double wavelength, double host);

/* size_x_im - its imaginary part, of a size whose wavelength and radius, or x, and host are known. */
double size_x_im(const struct size *s);

/* size_name - "radius .. um, wavelength .. um" or "x = ..", for messages; returns out. */
#define SIZE_NAME 96
const char *size_name(const struct size *s, char out[SIZE_NAME]);

/* size_x, size_extent - the size parameter, and its modulus: partial waves count up to about there. */
static inline double complex size_x(const struct size *s) { return CMPLX(s->x, s->x_im); }
static inline double size_extent(const struct size *s) { return s->x_im > 0 ? cabs(size_x(s)) : s->x; }

/* sizes_require - die where --particle, or what gives the wavelength, is missing, or options exclude each other. */
void sizes_require(const struct sizes_options *o);

/* sizes_threads - settle what computes: the number of OpenMP threads, and that MOTES_CPU, if set, is what this processor can. */
void sizes_threads(const struct sizes_options *o);

/* sizes_input - the table named by operand (NULL: standard input); NULL where the options give the sizes themselves, and
 * then an operand is refused. */
struct tab *sizes_input(const struct sizes_options *o, const char *operand);

/* sizes_over - check the options and take the sizes from a table that sizes_input opened (NULL: from the options);
 * sizes_threads is done here too. */
struct sizes *sizes_over(const struct sizes_options *o, struct tab *table);

/* sizes_carried - the carried columns of the table into cols, less those named in own[nown] (which the tool writes itself);
 * returns how many. Decides what size.carried holds. */
int sizes_carried(struct sizes *s, int nown, const struct tab_col *own, struct tab_col *cols);

/* sizes_carried_of - the same of any table, their indices into index[]. */
int sizes_carried_of(const struct tab *t, int nown, const struct tab_col *own, struct tab_col *cols, int *index);

/* sizes_key_columns - the key columns (x, or wavelength, radius) into cols; sizes_key_values - their values into row. Return how many. */
int sizes_key_columns(int by_x, struct tab_col *cols);
int sizes_key_values(int by_x, const struct size *size, double *row);

/* sizes_by_x - whether sizes are given by --size-parameter. */
int sizes_by_x(const struct sizes *s);

/* sizes_next - the next (size, wavelength); 0 at the end. */
int sizes_next(struct sizes *s, struct size *out);

void sizes_close(struct sizes *s);

#endif

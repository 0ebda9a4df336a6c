/* sizes - what spheres an optics tool is asked about: its options, and sizes one after the other.
 *
 * Sizes come from a table with a radius column, from --radius, or from --size-parameter, where x stands for wavelength and radius
 * both. They are handed out size by size, within a size by wavelength in the order given. Everything dies at the first error. */
#ifndef TOOLKIT_SIZES_H
#define TOOLKIT_SIZES_H

#include "base/opt.h"
#include "format/tab.h"
#include "toolkit/size.h"

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
	{ "--wavelength", OPT_WAVELENGTHS, &(o).wavelength, 1e-4, 1e4, "L[,L..]", \
	  "vacuum wavelengths, or frequencies, or an inclusive range FROM:TO:STEP", 0 }, \
	{ "--radius", OPT_UMS, &(o).radius, 1e-9, 1e9, "R[,R..]", "radii, or FROM:TO:COUNT log-spaced, instead of a table", 0 }, \
	{ "--size-parameter", OPT_REALS, &(o).x, 0, 0, "X[,X..]", \
	  "size parameters instead of wavelengths and radii, or FROM:TO:COUNT", 0 }, \
	{ "--threads", OPT_INT, &(o).threads, 1, 1024, "N", "threads", 1 }

/* sizes_require - die where --particle, or what gives the wavelength, is missing, or options exclude each other. */
void sizes_require(const struct sizes_options *o);

/* sizes_threads - settle what computes: the number of OpenMP threads, and that MOTES_CPU, if set, is what this processor can. */
void sizes_threads(const struct sizes_options *o);

/* sizes_input - the table named by operand (NULL: standard input); NULL where the options give the sizes themselves, and
 * then an operand is refused. */
struct tab *sizes_input(const struct sizes_options *o, const char *operand);

struct sizes;

/* sizes_over - check the options and take the sizes from a table that sizes_input opened (NULL: from the options), which
 * remains the caller's; sizes_threads is done here too. */
struct sizes *sizes_over(const struct sizes_options *o, struct tab *table);

/* sizes_by_x - whether sizes are given by --size-parameter. */
int sizes_by_x(const struct sizes *s);

/* sizes_next - the next (size, wavelength); 0 at the end. sizes_row - the table's row of that size. */
int sizes_next(struct sizes *s, struct size *out);
const double *sizes_row(const struct sizes *s);

void sizes_close(struct sizes *s);

#endif

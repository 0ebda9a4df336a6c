/* coeffs - partial waves of one (size, wavelength) after the other: read from a table of coefficients, or to be computed for
 * sizes. What can do with either (xsect, mie-phase) need not know which. Everything dies at the first error.
 *
 * A table of coefficients has columns wavelength, radius (or x), host_re, host_im, n, a_re, a_im, b_re, b_im, and others that
 * are carried; a new size or wavelength begins where n returns to 1. It does not say m: a particle that does not absorb is
 * recognised by |a|^2 = Re a (mie_lossless), but in a host that absorbs, where this makes no difference. */
#ifndef TOOLKIT_COEFFS_H
#define TOOLKIT_COEFFS_H

#include "optics/mie/mie.h"
#include "toolkit/sizes.h"

struct waves {
	struct size size;            /* m is NaN where the waves were read; carried belongs to these waves */
	int lossless;                /* the particle does not absorb; n, a, b, lossless are good after waves_solve */
	int n;
	double complex *a, *b;       /* [n+1]; NULL: not solved yet */
};

/* waves_solve - have the coefficients; nothing to do where they were read. 0, or -1 when memory ran out. Threads may solve
 * different waves at once. */
int waves_solve(struct waves *w);

/* waves_efficiencies - of solved waves; *error, unless NULL, as of mie_efficiencies or, in a host that absorbs, mie_host_efficiencies.
 * waves_norm - the integral of (|S1|^2 + |S2|^2)/2 over the sphere, given Q_sca. */
struct efficiencies waves_efficiencies(const struct waves *w, double *error);
double waves_norm(const struct waves *w, double q_sca);

/* waves_drop - give back the coefficients; waves_free - these and the rest. */
void waves_drop(struct waves *w);
void waves_free(struct waves *w);

struct coeffs;

/* coeffs_open - the input of a tool that takes sizes or coefficients; for the latter, options of the former are refused. */
struct coeffs *coeffs_open(const struct sizes_options *o, const char *operand);

/* coeffs_open_sizes - the same for a tool that takes sizes only. */
struct coeffs *coeffs_open_sizes(const struct sizes_options *o, const char *operand);

/* coeffs_read - the table's name where coefficients are read, NULL where sizes are. */
const char *coeffs_read(const struct coeffs *c);

/* coeffs_table - the table in use, NULL where the options give the sizes. */
struct tab *coeffs_table(const struct coeffs *c);

/* Key columns and their values, carried columns (as sizes_carried) and their values, cmd lines of the table ("" without one). */
int coeffs_columns(const struct coeffs *c, struct tab_col *cols);
int coeffs_carried(struct coeffs *c, int nown, const struct tab_col *own, struct tab_col *cols);
void coeffs_carry(const struct coeffs *c, const struct waves *w, double *row);
const char *coeffs_history(const struct coeffs *c);
int coeffs_by_x(const struct coeffs *c);
int coeffs_key(const struct coeffs *c, const struct size *size, double *row);

/* coeffs_next - the next waves; 0 at the end. To be freed by waves_free. */
int coeffs_next(struct coeffs *c, struct waves *out);

/* coeffs_batch - up to COEFFS_BATCH next waves, fewer where x is large, so that their coefficients together stay bounded in memory;
 * returns how many, 0 at the end. */
#define COEFFS_BATCH 2048
int coeffs_batch(struct coeffs *c, struct waves out[COEFFS_BATCH]);

void coeffs_close(struct coeffs *c);

/* The writer's columns after the key columns, and their values for wave l. */
#define COEFFS_COLS 7
extern const struct tab_col coeffs_cols[COEFFS_COLS];
void coeffs_values(const struct waves *w, int l, double *row);

#endif

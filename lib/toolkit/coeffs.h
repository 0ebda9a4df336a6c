/* coeffs - tables of the coefficients of partial waves, both directions.
 *
 * A table has columns wavelength, radius (or x), host_re, host_im, n, a_re, a_im, b_re, b_im, and others; a new size or
 * wavelength begins where n returns to 1. It does not say m: a particle that does not absorb is recognised by |a|^2 = Re a
 * (mie_lossless), but in a host that absorbs, where this makes no difference. Everything dies at the first error. */
#ifndef TOOLKIT_COEFFS_H
#define TOOLKIT_COEFFS_H

#include "format/columns.h"
#include "toolkit/waves.h"

/* coeffs_in - whether a table holds coefficients. */
int coeffs_in(const struct tab *table);

struct coeffs;

/* coeffs_over - read the waves of a table, which remains the caller's. */
struct coeffs *coeffs_over(struct tab *table);

/* coeffs_by_x - whether they go by x, not by wavelength and radius. */
int coeffs_by_x(const struct coeffs *c);

/* coeffs_next - the next waves, without what they carry; 0 at the end. coeffs_row - their first row in the table. */
int coeffs_next(struct coeffs *c, struct waves *out);
const double *coeffs_row(const struct coeffs *c);

void coeffs_close(struct coeffs *c);

/* coeffs_values - values of the columns column_coeffs for wave l. */
#define COEFFS_COLS ((int)(sizeof column_coeffs / sizeof *column_coeffs))
void coeffs_values(const struct waves *w, int l, double *row);

#endif

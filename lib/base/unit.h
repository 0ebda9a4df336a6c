/* unit - numbers with units, as they stand on a command line or in a scene. */
#ifndef BASE_UNIT_H
#define BASE_UNIT_H

#include <stddef.h>

struct reals {
	double *v;
	size_t n;
};

/* Each parser returns NULL, or what is wrong with the text; the result is finite. */

/* unit_real - a number in C notation. */
const char *unit_real(const char *text, double *out);

/* unit_int - a whole number, 1e8 too, within +-2^53. */
const char *unit_int(const char *text, long long *out);

/* unit_length - a length with its unit (nm um mm cm m km; the signs for micro, U+00B5, and mu, U+03BC, stand for u, too).
 * out in 10^exponent metres: -6 gives um. 550nm in um is 550/1000, correctly rounded. */
const char *unit_length(const char *text, int exponent, double *out);

/* unit_lengths - L,L,..; or log-spaced FROM:TO:COUNT (by_step 0); or inclusive FROM:TO:STEP (by_step 1). */
const char *unit_lengths(const char *text, int exponent, int by_step, struct reals *out);

/* unit_wavelengths - the same of wavelengths in vacuum, by step; a frequency (kHz MHz GHz THz) stands for c / frequency, and a
 * range of frequencies is evenly spaced in frequency. */
const char *unit_wavelengths(const char *text, int exponent, struct reals *out);

/* unit_reals - as unit_lengths, plain numbers. */
const char *unit_reals(const char *text, int by_step, struct reals *out);

/* unit_concentration - N/m3 or N/cm3, out in m^-3. */
const char *unit_concentration(const char *text, double *out);

/* unit_bytes - N, NKiB, NMiB, NGiB. */
const char *unit_bytes(const char *text, double *out);

#endif

/* legendre_series - four series of Legendre polynomials at many angles at once, in O(n log n + angles).
 *
 * The series become sums of cosines (kern/legendre.h), exactly as far as doubles go; a discrete Fourier transform has these on equal
 * steps half as long as the shortest wave needs (kern/fourier.h), with each cosine divided by the transform of a short window; and
 * the window's 16 weights give any angle from its neighbours (kern/window.h; the nonuniform transform of Dutt and Rokhlin 1993 with
 * the window of Kaiser and Bessel). */
#ifndef OPTICS_LEGENDRE_SERIES_H
#define OPTICS_LEGENDRE_SERIES_H

#define LEGENDRE_SERIES_SUMS 4    /* evaluated together: the real and imaginary parts of two amplitudes */

struct legendre_series;

/* legendre_series_new - have sum_k c[k][.] P_k(cos theta), k = 0 .. n, n >= 0, ready to be asked for; c[n+1] is overwritten.
 * Returns NULL when memory ran out. */
struct legendre_series *legendre_series_new(int n, double (*c)[LEGENDRE_SERIES_SUMS]);

/* legendre_series_of_cosines - the same of sum_k c[k][.] cos(k theta), c[n+1]. */
struct legendre_series *legendre_series_of_cosines(int n, const double (*c)[LEGENDRE_SERIES_SUMS]);

/* legendre_series_cosines - the c[steps] of a sum of cosines, k < steps, whose values at (j + 1/2) pi / steps are value[steps]. steps =
 * legendre_series_steps of something: 16 or 48 times a power of 2, at least that much. 0, or -1 when memory ran out. */
int legendre_series_steps(int least);
int legendre_series_cosines(int steps, const double *value, double *c);

/* legendre_series_at - values[count] at angles theta[count] (degrees, [0, 180]). The error is some 1e-15 of what the series reaches
 * where all terms add up, at every angle. An angle's value does not depend on the others, nor does it on the processor. */
void legendre_series_at(const struct legendre_series *s, int count, const double *theta, double (*values)[LEGENDRE_SERIES_SUMS]);

void legendre_series_free(struct legendre_series *s);

#endif

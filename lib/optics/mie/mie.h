/* mie - Lorenz-Mie theory of a homogeneous sphere in a host without absorption.
 *
 * Conventions: time factor exp(-i omega t), Im m >= 0 absorbs; a_n, b_n, S1, S2 after Bohren and Huffman (1983). */
#ifndef OPTICS_MIE_H
#define OPTICS_MIE_H

#include "base/cmplx.h"

#define MIE_X_MAX 1e7

/* Dimensionless efficiencies Q = C / (pi r^2). */
struct efficiencies {
	double ext, sca, abs;
	double g;             /* asymmetry parameter <cos theta> */
	double back;          /* radar backscatter efficiency 4 |S1(180 deg)|^2 / x^2 */
};

/* mie_terms - number of partial waves that x and m need for full double precision; resonances included, whose order can exceed
 * x and is bounded by |m| x. x in (0, MIE_X_MAX]. */
int mie_terms(double x, double complex m);

/* mie_coefficients - a[1..n], b[1..n]; index 0 is set to 0.
 * Given:    x   size parameter, (0, MIE_X_MAX]
 *           m   relative refractive index, Re m > 0, Im m >= 0, |m| x <= 1e9, or 2e10 where Im m > 1e-3 |m|
 *           n   number of terms, at least 1
 * Returned: a[n+1], b[n+1]; 0 on success, -1 when memory ran out */
int mie_coefficients(double x, double complex m, int n, double complex *a, double complex *b);

/* mie_many - efficiencies and their error of n spheres x[n], m[n] (ranges as above), many side by side, the same to the last bit as of each
 * alone. Blocks of spheres are shared out among OpenMP threads.
 * Returned: q[n], error[n]; 0, or -1 when memory ran out */
int mie_many(int n, const double *x, const double complex *m, struct efficiencies *q, double *error);

/* mie_lossless - whether a[n+1], b[n+1] are those of a particle that does not absorb: |a|^2 = Re a and |b|^2 = Re b to rounding.
 * So a stream of coefficients need not carry m. */
int mie_lossless(int n, const double complex *a, const double complex *b);

/* mie_efficiencies - sums over given coefficients a[n+1], b[n+1]; lossless: scattering equals extinction, absorption is 0.
 * *error, unless NULL: estimate of what rounding does to them, the larger of the relative errors of ext and sca and the absolute error
 * of g. It grows with x, where m is near 1, and on a narrow resonance, where half a unit in the last place of x and m does more than all
 * else; from coefficients alone, which do not tell m, that is rougher than of mie_many. */
struct efficiencies mie_efficiencies(double x, int lossless, int n, const double complex *a, const double complex *b, double *error);

/* mie_amplitudes - S1, S2 at angles theta[ntheta] (degrees, [0, 180]) by direct summation; 0, or -1 when memory ran out.
 * An angle's result does not depend on the others. Blocks of angles are shared out among OpenMP threads. */
int mie_amplitudes(int n, const double complex *a, const double complex *b, int ntheta, const double *theta,
                   double complex *s1, double complex *s2);

/* mie_terms_enough - how many of n terms are enough for p within tolerance in L1 (half the integral of |dp| over the sphere): by
 * Schwarz's inequality no more than the root of the share that the others have in scattering, to first order. n where tolerance
 * is 0. */
int mie_terms_enough(int n, const double complex *a, const double complex *b, double tolerance);

#endif

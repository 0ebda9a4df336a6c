/* mie - Lorenz-Mie theory of a homogeneous sphere in a host without absorption.
 *
 * Conventions: time factor exp(-i omega t), Im m >= 0 absorbs; a_n, b_n, S1, S2 after Bohren and Huffman (1983). */
#ifndef OPTICS_MIE_H
#define OPTICS_MIE_H

#include <complex.h>

#define MIE_X_MAX 1e7

/* Dimensionless efficiencies Q = C / (pi r^2). */
struct efficiencies {
	double ext, sca, abs;
	double g;             /* asymmetry parameter <cos theta> */
	double back;          /* radar backscatter efficiency 4 |S1(180 deg)|^2 / x^2 */
};

/* mie_terms - number of partial waves needed for x and m, resonances included (their order can exceed x: |m| x counts too). */
int mie_terms(double x, double complex m);

/* mie_coefficients - a[1..n], b[1..n]; index 0 is set to 0.
 * Given:    x   size parameter, > 0
 *           m   relative refractive index
 *           n   number of terms, at least 1
 * Returned: a[n+1], b[n+1]; 0 on success, -1 when memory ran out */
int mie_coefficients(double x, double complex m, int n, double complex *a, double complex *b);

/* mie_efficiencies - sums over given coefficients a[n+1], b[n+1]; real_m: scattering equals extinction, absorption is 0. */
struct efficiencies mie_efficiencies(double x, int real_m, int n, const double complex *a, const double complex *b);

/* mie_amplitudes - S1, S2 at angles theta[ntheta] (degrees, [0, 180]) by direct summation; 0, or -1 when memory ran out. */
int mie_amplitudes(int n, const double complex *a, const double complex *b, int ntheta, const double *theta,
                   double complex *s1, double complex *s2);

#endif

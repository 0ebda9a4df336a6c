/* mie_host - Lorenz-Mie theory of a homogeneous sphere in a host that absorbs: complex x = 2 pi r eta_m / lambda.
 *
 * Conventions of mie.h. m = eta_p / eta_m is a quotient: its imaginary part is negative where the host absorbs more than the particle.
 * beta = 4 pi r Im(eta_m) / lambda = 2 Im x; a wave's intensity falls by e^(-beta) over a radius. Amplitudes and cross sections are those
 * of the far field, traced back through the host: extinction may be negative or grow as e^beta, and scattering may exceed it. */
#ifndef OPTICS_MIE_HOST_H
#define OPTICS_MIE_HOST_H

#include "optics/mie/mie.h"

#define MIE_HOST_BETA_MAX 300    /* |a_n| reaches e^beta, and its square must be a double */

/* mie_host_gamma - gamma(beta) e^(-beta) = 2 (beta - 1 + e^(-beta)) / beta^2, from 1 at beta = 0 down to 2/beta; beta >= 0.
 * gamma is the mean intensity of the incident wave on the sphere's front, over its cross section; that at the centre is 1.
 * Source: Guo et al. 2022, gamma of eq 29, which must be 2 (1 + (beta - 1) e^beta) / beta^2 to have the limit 1 */
double mie_host_gamma(double beta);

/* mie_host_terms - number of partial waves, as mie_terms.
 * Given:    x   Re x in (0, MIE_X_MAX], 2 Im x in (0, MIE_HOST_BETA_MAX]
 *           m   Re m > 0, Im(m x) >= 0 but for rounding */
int mie_host_terms(double complex x, double complex m);

/* mie_host_coefficients - a[1..n], b[1..n]; index 0 is set to 0. Small parts stay: errors of Re a are of the order of rounding times
 * Re a or |a| Im x / |x|, so that Im x -> 0 leads to mie_coefficients at any x.
 * Given:    x, m as above, |m x| as of mie_coefficients; n   number of terms, at least 1
 * Returned: a[n+1], b[n+1]; 0, or -1 when memory ran out
 * Source:   Guo et al. 2022, eq 26, 27 with complex x */
int mie_host_coefficients(double complex x, double complex m, int n, double complex *a, double complex *b);

/* mie_host_efficiencies - of coefficients a[n+1], b[n+1]:
 *     ext  = 4 Re[S(0) / x^2]                                                   eq 28
 *     sca  = 2 e^(-beta) / (gamma |x|^2) sum (2l+1) (|a_l|^2 + |b_l|^2)         eq 29
 *     abs  = ext - sca, of either sign
 *     g    = integral of p cos theta over the sphere, p of eq 30
 *     back = 4 pi sca p(180 deg) = 4 e^(-beta) |S1(180 deg)|^2 / (gamma |x|^2)
 * *error, unless NULL: as of mie_efficiencies, and what cancels in ext is in it. */
struct efficiencies mie_host_efficiencies(double complex x, int n, const double complex *a, const double complex *b, double *error);

/* mie_host_norm - integral of (|S1|^2 + |S2|^2)/2 over the sphere, 2 pi sum (2l+1) (|a_l|^2 + |b_l|^2), given sca = Q_sca; so that
 * p = (|S1|^2 + |S2|^2) / (2 norm)                                                eq 30 */
double mie_host_norm(double complex x, double sca);

#endif

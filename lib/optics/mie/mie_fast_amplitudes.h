/* mie_fast_amplitudes - the amplitudes of Lorenz-Mie theory at many angles in O(n log n + angles), beside the sums of mie.h,
 * which take O(n angles). */
#ifndef OPTICS_MIE_FAST_AMPLITUDES_H
#define OPTICS_MIE_FAST_AMPLITUDES_H

#include "optics/mie/mie.h"
#include "optics/numerics/legendre_series.h"

/* mie_fast_amplitudes_new - a series whose values are Re S1, Im S1, Re S2, Im S2, from a[n+1], b[n+1]; NULL when memory ran out.
 *
 * With tau_l = l(l+1) P_l - mu pi_l, pi_l = P_l' and the sums of Legendre polynomials for these, the coefficient of P_k in S1 is
 * (2k+1) (b_k k/(k+1) + x_k), that in S2 (2k+1) (a_k k/(k+1) + y_k), where, w_l = (2l+1)/(l(l+1)),
 *     x_k = w_(k+1) a_(k+1) - y_(k+1),    y_k = w_(k+1) b_(k+1) - x_(k+1),    x_n = y_n = 0 */
struct legendre_series *mie_fast_amplitudes_new(int n, const double complex *a, const double complex *b);

/* mie_fast_amplitudes_at - S1, S2 at angles theta[ntheta] (degrees, [0, 180]), shared out among OpenMP threads where they
 * are many. */
void mie_fast_amplitudes_at(const struct legendre_series *s, int ntheta, const double *theta,
                            double complex *s1, double complex *s2);

#endif

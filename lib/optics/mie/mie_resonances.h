/* mie_resonances - what rounding of x and m does to efficiencies on narrow resonances: more than all other rounding.
 *
 * Symbols as in mie_coefficients.h, primes by x. By the differential equation of psi and chi, and their Wronskian,
 *
 *     |a_l'| = |1 - 1/m^2| |D_l(y)^2 + l(l+1)/x^2| / |A - iC|^2,    |b_l'| = |m^2 - 1| / |A - iC|^2.
 *
 * A resonance stands where x < l < |m| x. There C = 0, whence A = -1/chi_l and D_l(y)/m = chi_l'/chi_l; and t = Im 1/a_l
 * passes 0 by
 *
 *     t' = |1 - 1/m^2| |m^2 (chi_l'/chi_l)^2 + l(l+1)/x^2| chi_l^2,    for b_l  t' = |m^2 - 1| chi_l^2,
 *
 * while Re 1/a_l = u, 1 but for absorption, stays: Re a_l = u/(u^2 + t^2). */
#ifndef OPTICS_MIE_RESONANCES_H
#define OPTICS_MIE_RESONANCES_H

#include "base/cmplx.h"

#include <float.h>

#define MIE_OFF (1.25 * DBL_EPSILON)    /* relative error of x that does what rounding of x, of m and of the recurrences does */

#define MIE_RESONANCES_FROM 3           /* in DBL_EPSILON (10 + x), what an order moves that counts: 3/2 of other rounding */

/* Order l of a sphere; coefficients times 2l+1, re and im, and those of the order before times 2l-1. */
struct mie_wave {
	int l;
	double a[2], b[2], old_a[2], old_b[2], chi_old, chi;
};

/* mie_resonance - how far the sum of (2l+1) Re(a + b), or the one for g, may be off by order l. */
double mie_resonance(double x, double complex m, const struct mie_wave *w);

/* mie_resonances_rough - that of all orders, roughly, from coefficients a[n+1], b[n+1] alone, which do not tell m. */
double mie_resonances_rough(double x, int n, const double complex *a, const double complex *b);

#endif

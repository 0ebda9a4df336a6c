/* debye - the partial waves of a large sphere one reflection after the other (Debye series), by asymptotic forms.
 *
 * A wave's scattering coefficient is a_l = (1 - S_2)/2, b_l = (1 - S_1)/2, S = R + sum_(p>=1) T I^(p-1): reflected outside, or
 * transmitted into p chords. Index 0 is b_l (amplitude S1, perpendicular), index 1 is a_l. lambda = l + 1/2. */
#ifndef OPTICS_DEBYE_H
#define OPTICS_DEBYE_H

#include "base/cmplx.h"

struct debye {
	double complex r[2], t[2], i[2];
};

/* debye_separable - whether the orders p can be told apart at lambda: it lies inside the turning point |m| x of the wave within the
 * sphere by more than the width of that point. */
int debye_separable(double x, double complex m, double lambda);

/* debye_term - R, T, I at lambda. Where the orders cannot be told apart, r is the whole sum S and t, i are 0.
 * Given:   x > 0, Re m > 0, Im m >= 0, lambda in (0, x + 8 (x/2)^(1/3)]
 * Accuracy: relative to the exact Riccati-Bessel functions about lambda^(-4/3)/60; energy is conserved exactly for real m.
 * Source:  Nussenzveig 1992, Diffraction Effects in Semiclassical Scattering, ch. 9; uniform forms: Langer's, Abramowitz and Stegun
 *          9.3.35 to 9.3.39 to leading order, and Debye's, 9.3.15, to second order away from the turning points. */
void debye_term(double x, double complex m, double lambda, struct debye *out);

#endif

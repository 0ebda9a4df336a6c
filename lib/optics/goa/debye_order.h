/* debye_order - the amplitude of one order of the Debye series along the impact parameter, and what stationary phase makes of it beyond
 * the leading term. u = lambda/x = sin of the angle of incidence. */
#ifndef OPTICS_DEBYE_ORDER_H
#define OPTICS_DEBYE_ORDER_H

#include "base/cmplx.h"

/* debye_order_amplitude - F_j(u), j = 1, 2 (perpendicular, parallel): R for p = 0, (1 - R^2) (-R)^(p-1) beyond, of a sphere whose
 * curvature in wavelengths is epsilon = 1/x; with epsilon = 0 Fresnel's. The branch with Re cos i >= 0, Im cos t >= 0 where u is
 * real. Source: Debye, Abramowitz and Stegun 9.3.15, the logarithmic derivatives +-i c - lambda^2/(2 z^3 c^2) of Hankel functions
 * at z. */
void debye_order_amplitude(int p, double complex m, double complex u, double epsilon, double complex f[2]);

/* debye_order_chord - phase path over x of one chord at u for complex m, 2 [sqrt(m^2 - u^2) - u (arccos(u/m) - arccos(u/n))]: along the
 * ray of the real index n, and exact to first order beyond it; 2 sqrt(n^2 - u^2) for real m. Where u is real its imaginary part is not
 * negative. Source: the physics of Guo et al. 2022, appendix C, improved. */
double complex debye_order_chord(double complex m, double complex u);

/* debye_order_path - phase over x of p chords less the way saved outside, as rays.h has it, at u; for complex m along the ray of
 * the real index. */
double complex debye_order_path(int p, double complex m, double complex u);

/* What multiplies the leading term of a ray: F (1 - W) + (i/x) [G (1 - W) + H W' - F E W''], W(u) the share of its partial waves
 * that are summed otherwise. */
struct debye_order_terms {
	double complex f[2], g[2], h[2];
	double e;
	double complex path;     /* debye_order_path, and what absorption that differs along the front of the ray does to it */
};

/* debye_order_terms - for the ray of order p at u that leaves at theta (rad) as sigma = +-1 (rays.h), in second order of stationary
 * phase, of Debye's forms, and of the angular functions. axis: rad from the axis of the central ray; theta and axis are ignored,
 * and those of u taken, for an axial ray with u below DEBYE_ORDER_AXIAL, where all terms have settled.
 * Source: Bleistein and Handelsman 1975, sec. 6.1; phase of d^l_1,+-1: (l + 1/2) theta - pi/4 - c/(l + 1/2) up to signs,
 * c = tan(theta/2) + cot(theta)/8 and -cot(theta/2) + cot(theta)/8 (WKB). */
#define DEBYE_ORDER_AXIAL 4e-3
void debye_order_terms(int p, double complex m, double u, double theta, int sigma, int axial, struct debye_order_terms *out);

#endif

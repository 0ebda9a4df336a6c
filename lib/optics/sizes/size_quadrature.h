/* size_quadrature - sizes within ranges of radii, ever more of them, for integrals over a distribution. */
#ifndef OPTICS_SIZE_QUADRATURE_H
#define OPTICS_SIZE_QUADRATURE_H

#include "optics/sizes/size_density.h"

/* A range of sizes, of one class of a density. At an end that is cut the density goes on; at one that is not it has come to nothing.
 *
 * Integrals are sums by the trapezoidal rule in t, 0 to 1. Where no end is cut t is linear in v, dv = dr sqrt(1 + (scale/r)^2): as in r
 * above scale, where what a sphere scatters oscillates with r, as in ln r below; of what is smooth the sum converges faster than any
 * power of the step. Towards an end that is cut dv/dt goes to 0 as the square, sin^2 over the range, so that the error goes with the
 * sixth power of the step (Sidi, in Numerical Integration IV, 1993). */
struct size_range {
	int class;
	double lo, hi;                 /* um */
	int cut_lo, cut_hi;
	double scale;                  /* um */
};

/* size_range_count - sizes that level >= 0 brings, each level halving the steps; level 0 has SIZE_STEPS. */
#define SIZE_STEPS 16
long size_range_count(const struct size_range *r, int level);

/* size_range_at - the k-th of a level, 0 <= k < size_range_count: radius (um), and, for each way of the density, its weight. With
 * I_0 = sum w f(r) over level 0, I_k = I_(k-1)/2 + sum w f(r) over level k. */
void size_range_at(const struct size_range *r, const struct size_density *d, int level, long k, double *radius,
                   double weight[SIZE_WAYS]);

/* size_range_length - of v, um. */
double size_range_length(const struct size_range *r);

/* size_reach - the radii between which a law that is not cut counts: of what particles scatter or absorb no more than share lies below
 * *lo, and as much above *hi. A cross section is held to be no steeper than r^6 up to scale, where x = 1, then r^4 up to scale/|m - 1|,
 * then r^2; and towards small radii no less steep than r^3 below scale, and r^2 above. Ends that are cut are the law's. */
void size_reach(const struct psd *law, double scale, double contrast, double share, double *lo, double *hi);

#endif

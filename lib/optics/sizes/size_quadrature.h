/* size_quadrature - sizes within the classes of a distribution, ever more of them, for integrals over what the classes stand for. */
#ifndef OPTICS_SIZE_QUADRATURE_H
#define OPTICS_SIZE_QUADRATURE_H

#include "optics/sizes/psd.h"

/* The number of particles below a radius is known at the limits of the classes. Between them it is a cubic of ln r, with slopes
 * from the quartic through the five nearest limits, held in [0, 3] times the mean of either class, which makes it monotone
 * (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980, 238): classes keep their weights and the density is continuous where they
 * join. A class that joins no other is a power law with the mean volume of its radius.
 *
 * Integrals over it are sums by the trapezoidal rule in v, dv = dr sqrt(1 + (scale/r)^2): as in r above scale, where what a
 * sphere scatters oscillates with r, as in ln r below. */
struct size_quadrature;

/* size_quadrature_new - for n >= 1 classes with lo < radius < hi, in any order; scale (um) > 0. NULL when memory ran out. */
struct size_quadrature *size_quadrature_new(int n, const struct psd_class *c, double scale);
void size_quadrature_free(struct size_quadrature *s);

/* size_quadrature_count - sizes that level >= 0 brings, each level halving the steps; level 0 has at least 64 steps, and 2 a class. */
long size_quadrature_count(const struct size_quadrature *s, int level);

/* size_quadrature_at - the k-th of a level, 0 <= k < size_quadrature_count: radius (um) and weight. With I_0 = sum w f(r) over level 0, I_k =
 * I_(k-1)/2 + sum w f(r) over level k; I with f = 1 tends to the sum of the classes' weights. */
void size_quadrature_at(const struct size_quadrature *s, int level, long k, double *radius, double *weight);

#endif

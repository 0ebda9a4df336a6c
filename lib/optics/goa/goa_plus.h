/* goa_plus - scattering by a large sphere beyond geometrical optics: rays of order p <= 8 to second order, uniform forms where
 * they meet (rainbows, glories), and the partial waves near the edge, the critical angle of a bubble and the foci of central rays
 * (n near p) with uniform asymptotic coefficients. Conventions as in mie.h. Where x is small all partial waves are near the edge
 * and nothing is left to rays. */
#ifndef OPTICS_GOA_PLUS_H
#define OPTICS_GOA_PLUS_H

#include "optics/mie/mie.h"

/* What depends on m and the angles is found once, 3 kB an angle. */
struct goa_plus;

/* goa_plus_new - Re m > 0, Im m >= 0; NULL when memory ran out. */
struct goa_plus *goa_plus_new(double complex m);
void goa_plus_free(struct goa_plus *g);

/* goa_plus_aim - find the rays at angles theta[n] (degrees, [0, 180]; copied); nothing to do where they are the same as before.
 * Returns 0, or -1 when memory ran out. */
int goa_plus_aim(struct goa_plus *g, int n, const double *theta);

/* goa_plus_at - S1, S2 of size x > 0 at the angles of goa_plus_aim. *q: extinction by the optical theorem, absorption by what the
 * partial waves lose, scattering the rest; g is not computed (0). The integral of (|S1|^2 + |S2|^2)/2 over the sphere is pi x^2
 * q->sca to within the error in L1. Several threads may ask at once. Returns 0, or -1 when memory ran out. */
int goa_plus_at(const struct goa_plus *g, double x, double complex *s1, double complex *s2, struct efficiencies *q);

/* goa_plus_error - estimate of the phase function's error in L1, half the integral of |p - p(Mie)| over the sphere; 1 where the
 * approximation does not hold. */
double goa_plus_error(double x, double complex m);

#endif

/* goa - geometrical optics approximation of scattering by a large sphere: diffraction and rays of order p <= order,
 * added coherently (Guo et al. 2022, section 3 and appendix C). Conventions as in mie.h. */
#ifndef OPTICS_GOA_H
#define OPTICS_GOA_H

#include "optics/mie.h"

#define GOA_ORDER_MAX 100

/* goa_amplitudes - S1, S2 at angles theta[n] (degrees, [0, 180]); finite everywhere (caustics are capped).
 * Given: x > 0, m relative refractive index (Im m >= 0), order highest ray order p in [0, GOA_ORDER_MAX].
 * Returns 0, or -1 when memory ran out. */
int goa_amplitudes(double x, double complex m, int order, int n, const double *theta, double complex *s1, double complex *s2);

/* goa_norm - integral over the sphere of (|S1|^2 + |S2|^2)/2, on an internal grid that resolves the diffraction lobe and both
 * ends; p(theta) = (|S1|^2 + |S2|^2) / (2 goa_norm) then integrates to 1 over the sphere. Negative when memory ran out. */
double goa_norm(double x, double complex m, int order);

/* goa_efficiencies - extinction by eq 14 (p = 1; eq 12 for higher odd orders <= order), absorption from the attenuation of the
 * rays, sca = ext - abs (sca = ext for real m), g from the normalised phase function, back from S1(180 deg).
 * *error: estimate of the larger of the relative errors of ext and sca and the absolute error of g; >= 1 where GOA does not hold. */
struct efficiencies goa_efficiencies(double x, double complex m, int order, double *error);

#endif

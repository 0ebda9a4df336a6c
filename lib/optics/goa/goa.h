/* goa - geometrical optics approximation of scattering by a large sphere: diffraction and rays of order p <= order,
 * added coherently (Guo et al. 2022, section 3 and appendix C). Conventions as in mie.h.
 *
 * The ray picture is infinite on caustics. There the divergence factor D is capped where the picture fails, continuously in theta:
 *   rainbow      within one width of the Airy function, |Theta - Theta_R| < dT = (Theta'' / (2 x^2 cos^2 i_R))^(1/3), |Theta'| is
 *                raised by sqrt(dT / |Theta - Theta_R|), that is, it stays what it is at that distance
 *   glory        sin theta of a ray that reaches an axis with sin i != 0 is at least 1/(x sin i), the width of its Bessel function
 *   axial focus  |Theta'| of every ray, and sin theta / sin i of the axial ones, is at least 0.4607 sqrt(Theta'''/x) (n near p:
 *                stationary phase with the fourth-order term alone) and at least 2/x (m near 1: no ray exceeds x^2/2) */
#ifndef OPTICS_GOA_H
#define OPTICS_GOA_H

#include "optics/mie/mie.h"

#define GOA_ORDER_MAX 100

/* goa_amplitudes - S1, S2 at angles theta[n] (degrees, [0, 180]); finite everywhere (caustics are capped).
 * Given: x > 0, m relative refractive index (Im m >= 0), order highest ray order p in [0, GOA_ORDER_MAX].
 * Returns 0, or -1 when memory ran out. */
int goa_amplitudes(double x, double complex m, int order, int n, const double *theta, double complex *s1, double complex *s2);

/* goa_norm - integral over the sphere of (|S1|^2 + |S2|^2)/2, on an internal grid (goa_norm.h) that resolves the diffraction lobe
 * and both ends; p(theta) = (|S1|^2 + |S2|^2) / (2 goa_norm) then integrates to 1 over the sphere.
 * Negative when memory ran out. */
double goa_norm(double x, double complex m, int order);

/* goa_efficiencies - extinction by eq 14 (p = 1; eq 12 for higher odd orders <= order), absorption from the attenuation of the
 * rays, sca = ext - abs (sca = ext for real m), g from the normalised phase function, back from S1(180 deg).
 * *error: estimate of the larger of the relative errors of ext and sca and the absolute error of g; >= 1 where GOA does not hold,
 * or when memory ran out (everything is 0 then). */
struct efficiencies goa_efficiencies(double x, double complex m, int order, double *error);

/* The rays depend on m and the angles alone. Whoever asks for many sizes finds them once. What is found is kept from call to
 * call: a struct goa serves one thread at a time. */
struct goa;

/* goa_new - NULL when memory ran out. */
struct goa *goa_new(double complex m, int order);
void goa_free(struct goa *g);

/* goa_aim - find the rays at angles theta[n] (degrees, [0, 180]; copied); nothing to do where they are the same as before.
 * Returns 0, or -1 when memory ran out. */
int goa_aim(struct goa *g, int n, const double *theta);

/* goa_at - S1, S2 of size x at the angles of goa_aim. */
void goa_at(const struct goa *g, double x, double complex *s1, double complex *s2);

/* goa_incoherent - |S1|^2, |S2|^2 of size x at the angles of goa_aim, the powers of diffraction and of all rays added without
 * interference, and the norm: p = (|S1|^2 + |S2|^2) / (2 norm). What a distribution of sizes comes to that is wide enough; it
 * depends on size by the diffraction lobe, the caps and absorption alone. Returns 0, or -1 when memory ran out. */
int goa_incoherent(struct goa *g, double x, double *i1, double *i2, double *norm);

/* goa_blurred - |S1|^2, |S2|^2 of size x at the angles of goa_aim as the mean over neighbouring sizes has them: rays, and
 * diffraction, whose phases part by fastest rad or more as x grows by 1 do not interfere, and from half of that on less and less;
 * the norm is that of goa_measure. Returns 0, or -1 when memory ran out. */
int goa_blurred(struct goa *g, double x, double fastest, double *i1, double *i2);

/* goa_reach - have beforehand what goa_measure and goa_incoherent find of a size: several threads may then ask these for it at
 * once. Returns 0, or -1 when memory ran out. */
int goa_reach(struct goa *g, double x);

/* goa_measure - goa_efficiencies and goa_norm at once. Returns 0, or -1 when memory ran out (all is 0 then, *error infinite). */
int goa_measure(struct goa *g, double x, struct efficiencies *q, double *norm, double *error);

#endif

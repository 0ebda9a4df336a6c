/* goa_rays - the rays of GOA as its loops take them: what depends on the index and the angles, not on size. */
#ifndef OPTICS_GOA_RAYS_H
#define OPTICS_GOA_RAYS_H

#include "optics/goa/angle_blocks.h"
#include "optics/goa/rays.h"

#include "base/cmplx.h"

#include <math.h>
#include <stddef.h>

#define GOA_ABSORBED 40    /* e^-40 of a ray is nothing */

/* A ray and what does not depend on size: its amplitude is -x sqrt(D) f exp(i x path). */
struct goa_beam {
	double complex f1, f2;       /* F_j */
	double complex path;         /* of p chords, less the way saved outside: p m 2 cos t - 2 cos i where m is real */
	struct ray ray;
};

/* One ray at each of GOA_WIDTH neighbouring angles; f is 0 where an angle has none. Phase: x path + quarters, in pi/2. */
struct goa_packet {
	double path[GOA_WIDTH], quarters[GOA_WIDTH], fade[GOA_WIDTH];
	double spread[GOA_WIDTH];        /* sqrt(D) */
	double until[GOA_WIDTH];         /* the size below which a cap may act */
	double f[4][GOA_WIDTH];          /* -F_1 re, im, -F_2 re, im */
	int fades;                       /* any of these is absorbed */
	float clearest;                  /* least fade */
	struct ray ray[GOA_WIDTH];
};

/* What diffraction wants to know of the angles: sin theta, sqrt(2/(pi sin theta))/sin theta; 0 where nothing is diffracted. */
struct goa_angles {
	double sine[GOA_WIDTH], root[GOA_WIDTH];
};

struct goa_rays {
	struct angle_blocks blocks;
	struct goa_packet *packet;
	struct goa_angles *angles;
};

/* What the caps of goa.h allow at size x, for one order. */
struct goa_cap {
	double rainbow;       /* dT */
	double slope;         /* least |Theta'| */
	double bend;          /* of the caustic */
};

/* goa_rays_spread - sqrt(D), D = sin i cos i / (sin theta |Theta'|), as capped. */
static inline double goa_rays_spread(double x, const struct ray *r, const struct goa_cap *cap)
{
	if (r->p == 0)
		return 0.5;
	double slope = r->slope, ratio = r->ratio, dt = cap->rainbow, least = cap->slope;
	if (r->gap < dt)
		slope = r->gap > 1e-10 * dt ? slope * sqrt(dt / r->gap) : sqrt(2 * cap->bend * dt);
	slope = fmax(slope, least);
	double most = r->axial ? 1 / least : fmax(1 / least, x * r->sin_i * r->sin_i);
	return sqrt(fmin(ratio, most) * r->cos_i / slope);
}

/* goa_rays_fresnel - amplitudes R_1 (perpendicular), R_2 (parallel); c_t = sqrt(1 - sin^2 i/m^2), Im c_t >= 0. */
void goa_rays_fresnel(double complex m, double sin_i, double cos_i, double complex *r1, double complex *r2);

/* goa_rays_trace - all rays of order p <= order at theta (degrees), but those too faint to matter; returns how many. */
int goa_rays_trace(double complex m, int order, const struct caustic *caustic, double theta, struct goa_beam *out);

/* goa_rays_find - for theta[n], degrees in [0, 180]. Returns 0, or -1 when memory ran out (there is nothing to free then). */
int goa_rays_find(double complex m, int order, const struct caustic *caustic, int n, const double *theta, struct goa_rays *out);
void goa_rays_free(struct goa_rays *r);

#endif

/* goa_norm - what GOA's intensity integrates to over the sphere, so that p can be divided by it. */
#ifndef OPTICS_GOA_NORM_H
#define OPTICS_GOA_NORM_H

#include "optics/goa/goa_lanes.h"

/* Panels of GOA_WIDTH Gauss nodes for sizes in (X/2, X]. Near the axes, or everywhere where X is small, interference is resolved;
 * between there only the powers of the rays are added and the one cross term that is slow: p = 0 against diffraction. Other
 * interference averages out: it has neither ends nor points of rest there. */
struct goa_norm_grid {
	struct goa_rays rays;
	double *weight;               /* with 2 pi sin theta */
	double *share;                /* of interference that is resolved */
	double *cosine;               /* of theta */
	double complex *reflected;    /* (R_1 + R_2)/2 and phase, times what of diffraction's phase is constant */
	double *path;                 /* of that cross term, in pi/2 */
};

/* goa_norm_grid_new - for sizes up to X. Returns 0, or -1 when memory ran out (there is nothing to free then). */
int goa_norm_grid_new(double complex m, int order, const struct caustic *caustic, double most, struct goa_norm_grid *out);
void goa_norm_grid_free(struct goa_norm_grid *g);

/* goa_norm_grid_sum - the integral of (|S1|^2 + |S2|^2)/2, with interference or without. *along: the same times cos theta. */
double goa_norm_grid_sum(const struct goa_lanes *lanes, const struct goa_norm_grid *g, int interfere, double x,
                         const struct goa_cap *cap, double *along);

#endif

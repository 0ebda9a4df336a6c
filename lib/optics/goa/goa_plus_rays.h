/* goa_plus_rays - the rays of goa_plus: what depends on the index and the angles, not on size.
 *
 * Away from caustics a ray comes with its second-order terms (debye_order.h); near them two rays make one of the pairs of
 * goa_plus_caustics.h. Which serves depends on size: a ray from `from' on, pairs below. */
#ifndef OPTICS_GOA_PLUS_RAYS_H
#define OPTICS_GOA_PLUS_RAYS_H

#include "optics/goa/angle_blocks.h"
#include "optics/goa/goa_plus_caustics.h"
#include "optics/goa/goa_plus_edge.h"

#include <stddef.h>

/* Rays of one order at GOA_WIDTH neighbouring angles; where an angle has none, f, g, h are 0. Phase: x path + quarters, in pi/2.
 * Amplitude: -x spread, at most x^2/2, times what debye_order.h says, g being held where it outgrows f: 1/x is x/(x^2 + hold).
 * f .. h: S1 re, S1 im, S2 re, S2 im. */
struct goa_plus_packet {
	double path[GOA_WIDTH], quarters[GOA_WIDTH], fade[GOA_WIDTH], from[GOA_WIDTH];
	double u[GOA_WIDTH], e[GOA_WIDTH], spread[GOA_WIDTH], hold[GOA_WIDTH];
	double f[4][GOA_WIDTH], g[4][GOA_WIDTH], h[4][GOA_WIDTH];
	double least, most;        /* u */
	double clearest;           /* least fade */
	int p, fades;              /* fades: any of these is absorbed */
};

struct goa_plus_rays {
	struct angle_blocks blocks;
	struct goa_plus_packet *packet;
	struct goa_plus_edge_packet *edge;  /* of the same angles */
	struct goa_plus_caustics caustics;
};

/* goa_plus_rays_find - for angles theta[n], degrees in [0, 180]. Returns 0, or -1 when memory ran out
 * (there is nothing to free then). */
int goa_plus_rays_find(double complex m, int n, const double *theta, struct goa_plus_rays *out);
void goa_plus_rays_free(struct goa_plus_rays *r);

#endif

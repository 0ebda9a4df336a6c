/* goa_plus_rays - the rays of goa_plus: what depends on the index and the angles, not on size.
 *
 * Away from caustics a ray comes with its second-order terms; near a rainbow two rays make one Airy pair, near a glory (an axis
 * reached off-centre) one Bessel pair. Which serves depends on size: rays from `from' on, pairs below `below'. */
#ifndef OPTICS_GOA_PLUS_RAYS_H
#define OPTICS_GOA_PLUS_RAYS_H

#include "optics/goa/goa_plus_edge.h"

#include <stddef.h>

#define GOA_PLUS_ABSORBED 25    /* e^-25 of a ray is nothing */

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

/* The uniform (Airy) form of a rainbow: A and B the rays inside and outside of the rainbow's, complex on its dark side. */
struct goa_plus_rainbow {
	int angle, p;
	double below, sine, u;                 /* sine of the angle, u of the rainbow's ray */
	double path, zeta;                     /* in x and x^(2/3) */
	double ua, ub;                         /* of A and B; on the dark side, of the rainbow's ray */
	double complex a[2], b[2], over_rho;   /* amplitudes without 1/sqrt(sine), in x^(7/6); i/rho in x^(-1/3) */
	double complex fade_a, fade_b;         /* i times the path that absorption adds */
};

/* The uniform (Bessel) form of a glory. */
struct goa_plus_glory {
	int angle, p, back;
	double below, path, z, u;
	/* of (S1+S2)/2 and (S1-S2)/2, in x^(3/2): rays turned one way and the other, added and subtracted */
	double complex even[2], odd[2];
	double fade;
};

struct goa_plus_rays {
	int n;                     /* angles */
	double *theta;
	size_t *first;             /* first packet of each GOA_WIDTH angles, one more than there are such */
	struct goa_plus_packet *packet;
	struct goa_plus_edge_packet *edge;  /* of the same angles */
	int rainbows, glories;
	struct goa_plus_rainbow *rainbow;
	struct goa_plus_glory *glory;
};

/* goa_plus_rays_find - for angles theta[n], degrees in [0, 180]. Returns 0, or -1 when memory ran out
 * (there is nothing to free then). */
int goa_plus_rays_find(double complex m, int n, const double *theta, struct goa_plus_rays *out);
void goa_plus_rays_free(struct goa_plus_rays *r);

/* goa_plus_caustics_add - S1, S2 (+=) of the pairs, for the size and windows of an edge. */
void goa_plus_caustics_add(const struct goa_plus_rays *r, const struct goa_plus_edge *e, double complex *s1, double complex *s2);

#endif

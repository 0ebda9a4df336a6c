/* goa_plus_edge - the partial waves near the edge of a large sphere (and near the critical angle of a bubble), where rays fail, as a sum.
 *
 * A window W_p(u), u = lambda/x = sin of the angle of incidence, says which share of order p is summed as waves; rays carry the
 * rest, 1 - W_p. W rises over many widths s = (x/2)^(1/3) of the edge, so that neither side sees an end. */
#ifndef OPTICS_GOA_PLUS_EDGE_H
#define OPTICS_GOA_PLUS_EDGE_H

#include "base/cmplx.h"
#include "optics/goa/rays.h"
#include "optics/numerics/smoothstep.h"
#include "optics/numerics/nufft.h"

#include <stddef.h>

#define GOA_PLUS_EDGE_ORDERS 8      /* orders 0 .. 8 have windows of their own; those above are in no ray and share one */

/* W rises or falls in each of its pieces, smoothly, and is 0 or 1 beyond: with t = (u - zero) over, clamped to [0, 1], it is a
 * polynomial that goes from 0 to 1 with three derivatives. Piece k holds from u = from[k] on. */
#define WINDOW_PIECES 3
struct window {
	int n;
	double from[WINDOW_PIECES], zero[WINDOW_PIECES], over[WINDOW_PIECES];
};

struct goa_plus_edge_strip {
	size_t room;               /* waves that there is memory for */
	int first, n;              /* waves l = first .. first + n - 1 */
	double about;              /* l + 1/2 where most of the light is */
	/* coefficients of S1 + S2 (the disc's wave removed; not removed) and S1 - S2, re, im */
	double *sum, *sum_behind, *difference;
	/* of the same over sqrt(l + 1/2); size 0: no angle is far from both axes for such long waves */
	struct nufft nufft;
};

struct goa_plus_edge {
	double x;
	double complex m;
	int disc;                  /* the disc diffracts waves 1 .. disc */
	double lost;               /* of all waves in the strips, sum (2l + 1)(1 - |S|^2)/2 */
	int whole;                 /* W = 1 everywhere: there is nothing for rays to do */
	struct window window[GOA_PLUS_EDGE_ORDERS + 2];
	int same[GOA_PLUS_EDGE_ORDERS + 2]; /* as that of the order before */
	int n;
	struct goa_plus_edge_strip strip[2];
	struct window only[2];     /* the part of W_0 that each strip has, where there are two */
};

/* window_at - W at u. */
static inline double window_at(const struct window *w, double u)
{
	double first, second;
	int k = w->n - 1;
	while (k > 0 && u < w->from[k])
		k--;
	return smoothstep(w->zero[k], w->over[k], u, &first, &second);
}

/* window_constant - W, if it is 0 throughout [least, most] or 1 throughout, else -1. */
double window_constant(const struct window *w, double least, double most);

#define GOA_PLUS_EDGE_FAR 16        /* (l + 1/2) sin theta from which on angular functions are cosines */

/* For x |n - 1| below this rays are not distinct from what passes by: all is waves, up to x = GOA_PLUS_EDGE_SOFT_MAX, where it
 * would take too long. */
#define GOA_PLUS_EDGE_SOFT 60
#define GOA_PLUS_EDGE_SOFT_MAX 2e4

struct goa_lanes;

/* goa_plus_edge_set - windows and waves for a size. e is zero-initialised, or from a size before, whose memory is used again.
 * Returns 0, or -1 when memory ran out. */
int goa_plus_edge_set(const struct goa_lanes *lanes, struct goa_plus_edge *e, double x, double complex m);
void goa_plus_edge_free(struct goa_plus_edge *e);


/* What waves need to know about GOA_WIDTH neighbouring angles. */
struct goa_plus_edge_packet {
	double theta[GOA_WIDTH], folded[GOA_WIDTH];     /* rad; from the nearer axis */
	double behind[GOA_WIDTH];                        /* 1 beyond 90 degrees, else 0 */
	double root[GOA_WIDTH];                          /* sqrt(2/(pi sin theta)) */
	double plus[GOA_WIDTH], minus[GOA_WIDTH];       /* c of debye_order.h, of S1 + S2 and S1 - S2 */
	double bend[GOA_WIDTH], slope[GOA_WIDTH], slant[GOA_WIDTH]; /* of the disc: 1/theta - cot theta, 1/sin, 1/(1 + cos) */
	double sine;                                      /* the least */
};

/* goa_plus_edge_aim - packets for theta[n], degrees in [0, 180]; the last is filled up with its last angle. out has room for
 * (n + GOA_WIDTH - 1)/GOA_WIDTH. */
void goa_plus_edge_aim(int n, const double *theta, struct goa_plus_edge_packet *out);

/* goa_plus_edge_start - pi_l and pi_l - pi_(l-1) at an angle in [0, pi/2] by uniform Bessel forms, from where recurrences go on
 * upward. */
void goa_plus_edge_start(int l, double theta, double *p, double *v);

/* goa_plus_edge_disc - sum of (2l+1)/(l(l+1))
 * (pi_l + tau_l), l = 1 .. n, the amplitude S1 + S2 of a disc, at theta (rad), by Hilb's
 * forms. */
double goa_plus_edge_disc(int n, double theta);

#endif

/* goa_plus_edge - the partial waves near the edge of a large sphere (and near the critical angle of a bubble), where rays fail, as a sum.
 *
 * A window W_p(u), u = lambda/x = sin of the angle of incidence, says which share of order p is summed as waves; rays carry the
 * rest, 1 - W_p. W rises over many widths s = (x/2)^(1/3) of the edge, so that neither side sees an end. */
#ifndef OPTICS_GOA_PLUS_EDGE_H
#define OPTICS_GOA_PLUS_EDGE_H

#include "base/cmplx.h"
#include "optics/numerics/lane_math.h"
#include "optics/numerics/nufft.h"

#include <stddef.h>

#define EDGE_ORDERS 8      /* orders 0 .. 8 have windows of their own; those above are in no ray and share one */

/* W rises or falls in each of its pieces, smoothly, and is 0 or 1 beyond: with t = (u - zero) over, clamped to [0, 1], it is a
 * polynomial that goes from 0 to 1 with three derivatives. Piece k holds from u = from[k] on. */
#define WINDOW_PIECES 3
struct window {
	int n;
	double from[WINDOW_PIECES], zero[WINDOW_PIECES], over[WINDOW_PIECES];
};

struct edge_strip {
	size_t room;               /* waves that there is memory for */
	int first, n;              /* waves l = first .. first + n - 1 */
	double about;              /* l + 1/2 where most of the light is */
	/* coefficients of S1 + S2 (the disc's wave removed; not removed) and S1 - S2, re, im */
	double *sum, *sum_behind, *difference;
	/* of the same over sqrt(l + 1/2); size 0: no angle is far from both axes for such long waves */
	struct nufft nufft;
};

struct edge {
	double x;
	double complex m;
	int disc;                  /* the disc diffracts waves 1 .. disc */
	double lost;               /* of all waves in the strips, sum (2l + 1)(1 - |S|^2)/2 */
	int whole;                 /* W = 1 everywhere: there is nothing for rays to do */
	struct window window[EDGE_ORDERS + 2];
	int same[EDGE_ORDERS + 2]; /* as that of the order before */
	int n;
	struct edge_strip strip[2];
	struct window only[2];     /* the part of W_0 that each strip has, where there are two */
};

/* window_piece - W and its first two derivatives by u, in a piece. */
static inline double window_piece(double zero, double over, double u, double *first, double *second)
{
	double t = (u - zero) * over;
	t = lane_select(t, 0, 0, t);
	t = lane_select(t, 1, t, 1);
	double r = 1 - t, tr = t * r;
	*first = 140 * tr * tr * tr * over;
	*second = 420 * tr * tr * (r - t) * (over * over);
	return t * t * (t * t) * (35 - t * (84 - t * (70 - 20 * t)));
}

/* window_at - W at u. */
static inline double window_at(const struct window *w, double u)
{
	double first, second;
	int k = w->n - 1;
	while (k > 0 && u < w->from[k])
		k--;
	return window_piece(w->zero[k], w->over[k], u, &first, &second);
}

/* window_constant - W, if it is 0 throughout [least, most] or 1 throughout, else -1. */
double window_constant(const struct window *w, double least, double most);

#define EDGE_TURN 5        /* widths (z/2)^(1/3) about a turning point z where Airy functions are needed */
#define EDGE_TOP 6         /* the same from the edge to where waves end */
#define EDGE_FAR 16        /* (l + 1/2) sin theta from which on angular functions are cosines */

/* For x |n - 1| below EDGE_SOFT rays are not distinct from what passes by: all is waves, up to x = EDGE_SOFT_MAX, where it would
 * take too long. */
#define EDGE_SOFT 60
#define EDGE_SOFT_MAX 2e4

/* edge_separable - whether the orders p can be told apart at lambda: it lies inside the turning point |m| x of the wave within
 * the sphere by more than the width of that point, or absorption leaves nothing of those inside. */
int edge_separable(double x, double complex m, double lambda);

struct goa_lanes;

/* edge_set - windows and waves for a size. e is zero-initialised, or from a size before, whose memory is used again.
 * Returns 0, or -1 when memory ran out. */
int edge_set(const struct goa_lanes *lanes, struct edge *e, double x, double complex m);
void edge_free(struct edge *e);

#define EDGE_WIDTH 8

/* What waves need to know about EDGE_WIDTH neighbouring angles. */
struct edge_packet {
	double theta[EDGE_WIDTH], folded[EDGE_WIDTH];     /* rad; from the nearer axis */
	double behind[EDGE_WIDTH];                        /* 1 beyond 90 degrees, else 0 */
	double root[EDGE_WIDTH];                          /* sqrt(2/(pi sin theta)) */
	double plus[EDGE_WIDTH], minus[EDGE_WIDTH];       /* c of debye_order.h, of S1 + S2 and S1 - S2 */
	double bend[EDGE_WIDTH], slope[EDGE_WIDTH], slant[EDGE_WIDTH]; /* of the disc: 1/theta - cot theta, 1/sin, 1/(1 + cos) */
	double sine;                                      /* the least */
};

/* edge_aim - packets for theta[n], degrees in [0, 180]; the last is filled up with its last angle. out has room for
 * (n + EDGE_WIDTH - 1)/EDGE_WIDTH. */
void edge_aim(int n, const double *theta, struct edge_packet *out);

/* edge_start - pi_l and pi_l - pi_(l-1) at an angle in [0, pi/2] by uniform Bessel forms, from where recurrences go on upward. */
void edge_start(int l, double theta, double *p, double *v);

/* edge_disc - sum of (2l+1)/(l(l+1))
 * (pi_l + tau_l), l = 1 .. n, the amplitude S1 + S2 of a disc, at theta (rad), by Hilb's
 * forms. */
double edge_disc(int n, double theta);

#endif

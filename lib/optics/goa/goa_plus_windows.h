/* goa_plus_windows - which share of the light GOA+ sums as partial waves, and which it leaves to rays, by order and impact parameter.
 *
 * A window W_p(u), u = lambda/x = sin of the angle of incidence, is the share of order p that is summed as waves; rays carry the rest,
 * 1 - W_p. W is 1 where rays fail: near the edge, u = 1, near the critical angle of a bubble, u = n, and at the foci of central rays, n
 * near p. It rises over many widths s = (x/2)^(1/3) of the edge, so that neither side sees an end, and keeps clear of rainbows. */
#ifndef OPTICS_GOA_PLUS_WINDOWS_H
#define OPTICS_GOA_PLUS_WINDOWS_H

#include "base/cmplx.h"
#include "optics/numerics/smoothstep.h"

#define GOA_PLUS_ORDERS 8      /* orders 0 .. 8 have windows of their own; those above are in no ray and share one */

/* W rises or falls in each of its pieces, smoothly, and is 0 or 1 beyond: a smoothstep of zero and over.
 * Piece k holds from u = from[k] on. */
#define GOA_PLUS_WINDOW_PIECES 3
struct goa_plus_window {
	int n;
	double from[GOA_PLUS_WINDOW_PIECES], zero[GOA_PLUS_WINDOW_PIECES], over[GOA_PLUS_WINDOW_PIECES];
};

/* goa_plus_window_at - W at u. */
static inline double goa_plus_window_at(const struct goa_plus_window *w, double u)
{
	double first, second;
	int k = w->n - 1;
	while (k > 0 && u < w->from[k])
		k--;
	return smoothstep(w->zero[k], w->over[k], u, &first, &second);
}

/* goa_plus_window_constant - W, if it is 0 throughout [least, most] or 1 throughout, else -1. */
double goa_plus_window_constant(const struct goa_plus_window *w, double least, double most);

/* For x |n - 1| below this rays are not distinct from what passes by: all is waves, up to x = GOA_PLUS_SOFT_MAX, where it
 * would take too long. */
#define GOA_PLUS_SOFT 60
#define GOA_PLUS_SOFT_MAX 2e4

/* For one size. */
struct goa_plus_windows {
	int whole;                                /* W = 1 everywhere: there is nothing for rays to do */
	int strips;                               /* of waves: 1, or 2 with the critical angle of a bubble apart */
	struct goa_plus_window order[GOA_PLUS_ORDERS + 2];
	int same[GOA_PLUS_ORDERS + 2];            /* as that of the order before */
	struct goa_plus_window only[2];           /* the part of W_0 that each strip has, where there are two */
};

/* goa_plus_windows_set - for size x, index m. */
void goa_plus_windows_set(struct goa_plus_windows *w, double x, double complex m);

#endif

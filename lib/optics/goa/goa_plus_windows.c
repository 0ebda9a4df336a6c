#include "optics/goa/goa_plus_windows.h"

#include "optics/goa/debye_bounds.h"
#include "optics/goa/rays.h"

#include <math.h>
#include <string.h>

/* Widths of the edge. */
#define WIDE 38        /* W begins to rise so many inside it */
#define NARROW 3       /* and reaches 1 here */
#define TURN 6         /* the same at the turning point inside a bubble */
#define CLEAR 12       /* widths of W's rise that leave a rainbow outside */
#define RISE 20        /* widths that W takes at least to rise between a rainbow and the edge */
#define DEEP 28        /* and inside it */
#define FOCUS 4        /* an index so near p, in units of 1/sqrt x, focuses the central rays of order p: they are waves too */

static struct goa_plus_window everywhere(void)
{
	return (struct goa_plus_window){ .n = 1, .zero = { -2 }, .over = { 1 } };
}

/* A piece more, from 0 at zero to 1 at one. */
static void piece(struct goa_plus_window *w, double from, double zero, double one)
{
	w->from[w->n] = from;
	w->zero[w->n] = zero;
	w->over[w->n++] = 1 / (one - zero);
}

double goa_plus_window_constant(const struct goa_plus_window *w, double least, double most)
{
	double value = -1;
	for (int k = 0; k < w->n; k++) {
		double lo = fmax(least, w->from[k]), hi = k + 1 < w->n ? fmin(most, w->from[k + 1]) : most;
		if (lo > hi)
			continue;
		double a = (lo - w->zero[k]) * w->over[k], b = (hi - w->zero[k]) * w->over[k];
		double here = a <= 0 && b <= 0 ? 0 : a >= 1 && b >= 1 ? 1 : -1;
		if (here < 0 || (value >= 0 && here != value))
			return -1;
		value = here;
	}
	return value;
}

/* Order p alone: clear of its rainbow, between that and the edge where there is room, else inside it; and its axial focus. */
static void own_window(struct goa_plus_window *w, double x, double n, int p, double wide, double near)
{
	double s = cbrt(x / 2) / x, focus = FOCUS / sqrt(x), from = 0;
	struct caustic c = rays_caustic(n, p);
	w->n = 0;
	if (p >= 2 && fabs(n / p - 1) < focus) {
		double end = fmin(2 * sqrt(focus), 1);
		piece(w, 0, end, end / 2);
		from = end;
		near = end < wide ? near : 1e30;
	} else if (!isnan(c.tau)) {
		double room = (1 - sin(c.incidence)) / s;
		if (room > NARROW + RISE + CLEAR) {
			wide = fmax(wide, 1 - (room - CLEAR) * s);
		} else {
			near = fmin(near, 1 - (room + CLEAR) * s);
			wide = fmin(wide, 1 - (room + CLEAR + DEEP) * s);
			if (wide < 0.05)
				near = 1e30;
		}
	}
	if (near < 1e30)
		piece(w, from, wide, near);
	else
		*w = everywhere();
}

void goa_plus_windows_set(struct goa_plus_windows *w, double x, double complex m)
{
	double n = creal(m), s = cbrt(x / 2) / x, sy = cbrt(n * x / 2) / x;
	double wide = 1 - WIDE * s, near = 1 - NARROW * s, turn = n - WIDE * sy, begin = fmin(wide, turn);
	w->strips = 1;
	w->whole = 0;
	if (debye_separable(x, m, x * (1 + DEBYE_TOP * s))) {
		begin = wide;
		for (int p = 0; p <= GOA_PLUS_ORDERS + 1; p++)
			own_window(&w->order[p], x, n, p <= GOA_PLUS_ORDERS ? p : 0, wide,
				   p <= GOA_PLUS_ORDERS ? near : 1 - (WIDE - 15) * s);
	} else if (n + WIDE * sy < wide) {
		struct goa_plus_window *inside = &w->only[0];
		begin = turn;
		inside->n = 0;
		piece(inside, 0, turn, n - TURN * sy);
		piece(inside, n, n + WIDE * sy, n + TURN * sy);
		for (int p = 0; p <= GOA_PLUS_ORDERS + 1; p++)
			w->order[p] = *inside;
		w->only[1].n = 0;
		piece(&w->only[1], 0, wide, near);
		piece(&w->order[0], wide, wide, near);
		w->strips = 2;
	} else {
		for (int p = 0; p <= GOA_PLUS_ORDERS + 1; p++) {
			w->order[p].n = 0;
			piece(&w->order[p], 0, begin, fmin(near, n - TURN * sy));
		}
	}
	if (begin < 0.05 || (x * fabs(n - 1) < GOA_PLUS_SOFT && x < GOA_PLUS_SOFT_MAX)) {
		w->whole = 1;
		w->strips = 1;
		for (int p = 0; p <= GOA_PLUS_ORDERS + 1; p++)
			w->order[p] = everywhere();
	}
	for (int p = 1; p <= GOA_PLUS_ORDERS + 1; p++)
		w->same[p] = !memcmp(&w->order[p], &w->order[p - 1], sizeof w->order[p]);
}

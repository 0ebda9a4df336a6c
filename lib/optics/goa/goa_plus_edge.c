#include "optics/goa/goa_plus_edge.h"

#include "optics/goa/goa_lanes.h"
#include "optics/goa/rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDE 38        /* and begins so many inside it */
#define NARROW 3       /* where W reaches 1 */
#define TURN 6         /* the same at the turning point inside a bubble */
#define CLEAR 12       /* widths of W's rise that leave a rainbow outside */

#define RISE 20        /* widths that W takes at least to rise between a rainbow and the edge */
#define DEEP 28        /* and inside it */
#define FOCUS 4        /* an index so near p, in units of 1/sqrt x, focuses the central rays of order p: they are waves too */

int edge_separable(double x, double complex m, double lambda)
{
	double complex y = m * x;
	if (lambda < creal(y) - EDGE_TURN * cbrt(creal(y) / 2))
		return 1;
	if (cimag(y) < EDGE_TURN * cbrt(creal(y) / 2))
		return 0;
	/* the phase of a Hankel function inside; it turns negative where waves are evanescent */
	return cimag(csqrt((y - lambda) * (y + lambda)) - lambda * cacos(lambda / y)) > 3;
}

static struct window window_one(void)
{
	return (struct window){ 1, { 0 }, { -2 }, { 1 } };
}

/* A piece more, from 0 at zero to 1 at one. */
static void piece(struct window *w, double from, double zero, double one)
{
	w->from[w->n] = from;
	w->zero[w->n] = zero;
	w->over[w->n++] = 1 / (one - zero);
}

double window_constant(const struct window *w, double least, double most)
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
static void own_window(struct window *w, double x, double n, int p, double wide, double near)
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
		*w = window_one();
}

static void set_windows(struct edge *e)
{
	double x = e->x, n = creal(e->m), s = cbrt(x / 2) / x, sy = cbrt(n * x / 2) / x;
	double wide = 1 - WIDE * s, near = 1 - NARROW * s, turn = n - WIDE * sy, begin = fmin(wide, turn);
	e->n = 1;
	if (edge_separable(x, e->m, x * (1 + EDGE_TOP * s))) {
		begin = wide;
		for (int p = 0; p <= EDGE_ORDERS + 1; p++)
			own_window(&e->window[p], x, n, p <= EDGE_ORDERS ? p : 0, wide,
				   p <= EDGE_ORDERS ? near : 1 - (WIDE - 15) * s);
	} else if (n + WIDE * sy < wide) {
		struct window *w = &e->only[0];
		begin = turn;
		w->n = 0;
		piece(w, 0, turn, n - TURN * sy);
		piece(w, n, n + WIDE * sy, n + TURN * sy);
		for (int p = 0; p <= EDGE_ORDERS + 1; p++)
			e->window[p] = *w;
		e->only[1].n = 0;
		piece(&e->only[1], 0, wide, near);
		piece(&e->window[0], wide, wide, near);
		e->n = 2;
	} else {
		for (int p = 0; p <= EDGE_ORDERS + 1; p++) {
			e->window[p].n = 0;
			piece(&e->window[p], 0, begin, fmin(near, n - TURN * sy));
		}
	}
	if (begin < 0.05 || (x * fabs(n - 1) < EDGE_SOFT && x < EDGE_SOFT_MAX)) {
		e->whole = 1;
		e->n = 1;
		e->disc = 0;           /* Hilb's forms are not for so few waves, and are not needed */
		for (int p = 0; p <= EDGE_ORDERS + 1; p++)
			e->window[p] = window_one();
	}
	for (int p = 1; p <= EDGE_ORDERS + 1; p++)
		e->same[p] = !memcmp(&e->window[p], &e->window[p - 1], sizeof e->window[p]);
}

/* Room for waves l of u from .. to; their coefficients, and the transform. */
static int strip_set(const struct goa_lanes *lanes, struct edge *e, struct edge_strip *strip, double from, double to,
		     double about, const struct window *only)
{
	int first = (int)fmax(floor(from * e->x - 0.5), 1), last = (int)fmax(ceil(to * e->x), 2);
	size_t n = (size_t)(last - first) + 1;
	strip->first = first;
	strip->n = (int)n;
	strip->about = about * e->x;
	if (n > strip->room) {
		free(strip->sum);
		strip->room = n + n / 8;
		strip->sum = malloc(12 * strip->room * sizeof *strip->sum);
		if (!strip->sum) {
			strip->room = 0;
			return -1;
		}
	}
	strip->sum_behind = strip->sum + 2 * n;
	strip->difference = strip->sum + 4 * n;
	e->lost += lanes->coefficients(e, only, strip);
	strip->nufft.size = 0;
	if (first < EDGE_FAR)
		return 0;
	double *scaled = strip->sum + 6 * n;
	for (size_t k = 0; k < 3 * n; k++) {
		double scale = 1 / sqrt(first + (double)(k % n) + 0.5);
		scaled[2 * k] = strip->sum[2 * k] * scale;
		scaled[2 * k + 1] = strip->sum[2 * k + 1] * scale;
	}
	return nufft_set(&strip->nufft, (int)n, (const double *[4]){ scaled, scaled + 2 * n, scaled + 4 * n, NULL });
}

int edge_set(const struct goa_lanes *lanes, struct edge *e, double x, double complex m)
{
	double top = 1 + EDGE_TOP * cbrt(x / 2) / x, begin = 1, focus = 0;
	e->x = x;
	e->m = m;
	e->disc = (int)x;
	e->whole = 0;
	e->lost = 0;
	set_windows(e);
	for (int p = 0; p <= EDGE_ORDERS + 1; p++) {
		const struct window *w = &e->window[p];
		if (w->over[0] > 0)
			begin = fmin(begin, w->zero[0]);
		else
			focus = w->zero[0];
	}
	if (e->n == 2)
		return strip_set(lanes, e, &e->strip[0], begin, e->only[0].zero[1], creal(m), &e->only[0]) ||
		         strip_set(lanes, e, &e->strip[1], e->only[1].zero[0], top, 1, &e->only[1]);
	if (focus > 0 && focus < begin) {
		e->n = 2;
		return strip_set(lanes, e, &e->strip[0], 0, focus, focus / 2, NULL) ||
		       strip_set(lanes, e, &e->strip[1], begin, top, 1, NULL);
	}
	return strip_set(lanes, e, &e->strip[0], focus > 0 ? 0 : begin, top, creal(m) < 1 ? (begin + 1) / 2 : 1, NULL);
}

void edge_free(struct edge *e)
{
	for (int k = 0; k < 2; k++) {
		free(e->strip[k].sum);
		nufft_free(&e->strip[k].nufft);
	}
}

void edge_aim(int n, const double *theta, struct edge_packet *out)
{
	for (int b = 0; b * EDGE_WIDTH < n; b++) {
		struct edge_packet *k = &out[b];
		k->sine = 1;
		for (int i = 0; i < EDGE_WIDTH; i++) {
			double t = theta[b * EDGE_WIDTH + i < n ? b * EDGE_WIDTH + i : n - 1];
			double f = fmin(t, 180 - t) * (M_PI / 180);
			double sine = sin(f), cosine = t > 90 ? -cos(f) : cos(f), r = t * (M_PI / 180);
			k->theta[i] = r;
			k->folded[i] = f;
			k->behind[i] = t > 90;
			k->sine = fmin(k->sine, sine);
			sine = fmax(sine, 1e-12);      /* nearer nobody looks at the rest */
			k->root[i] = sqrt(2 / (M_PI * sine));
			k->plus[i] = (1 - cosine) / sine + cosine / (8 * sine);
			k->minus[i] = -(1 + cosine) / sine + cosine / (8 * sine);
			k->bend[i] = r > 1e-3 ? 1 / r - cosine / sine : r / 3;
			k->slope[i] = 1 / sine;
			k->slant[i] = 1 / (1 + cos(f));
		}
	}
}

void edge_start(int l, double theta, double *p, double *v)
{
	double nu = l + 0.5, both = l * (l + 1.0);
	if (l == 1 || theta == 0) {
		*p = both / 2;
		*v = l;
		return;
	}
	double st = sin(theta), half = sin(theta / 2), cot = cos(theta) / st, q = sqrt(theta / st);
	double z1 = nu * theta + 0.375 * (cot - 1 / theta) / nu;
	double z0 = nu * theta - (tan(theta / 2) + 0.125 * (cot - 1 / theta)) / nu;
	*p = sqrt(both) * q * j1(z1) / st;
	*v = (both * q * j0(z0) + l * 2 * half * half * *p) / (l + 1);
}

double edge_disc(int n, double theta)
{
	/* P'_n + P'_(n+1) - (P_n + P_(n+1))/(1 + cos theta) */
	double sum = 0, st = sin(theta), bend = theta > 1e-3 ? 1 / theta - cos(theta) / st : theta / 3;
	double q = theta > 0 ? sqrt(theta / st) : 1;
	for (int l = n; l <= n + 1; l++) {
		double nu = l + 0.5, z = nu * theta + bend / (8 * nu), v = j0(z);
		double slope = theta > 1e-9 ? (nu * j1(z) - bend * v / 2) / st : (nu * nu - 1.0 / 3) / 2;
		sum += q * (slope - v / (1 + cos(theta)));
	}
	return sum;
}

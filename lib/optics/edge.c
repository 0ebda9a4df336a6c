#include "optics/edge.h"

#include "optics/debye.h"
#include "optics/rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define OUT 6          /* the strip ends so many widths beyond the edge */
#define WIDE 40        /* and begins so many inside it */
#define NARROW 3       /* where W reaches 1 */
#define TURN 6         /* the same at the turning point inside a bubble */
#define CLEAR 12       /* widths of W's rise that leave a rainbow outside */

#define FOCUS 4        /* an index so near p, in units of 1/sqrt x, focuses the central rays of order p: they are waves too */
#define SOFT 60        /* for x |n - 1| below this rays are not distinct from what passes by: all is waves, up to x = SOFT_MAX */
#define SOFT_MAX 2e4

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

/* Order p alone: clear of its rainbow, between that and the edge where there is room, else inside it; and the focus of its axis. */
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
		if (room > NARROW + 2 * CLEAR)
			wide = fmax(wide, 1 - (room - CLEAR) * s);
		else
			near = fmin(near, 1 - fmin(room + CLEAR, WIDE - 10) * s);
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
	if (debye_separable(x, e->m, x * (1 + OUT * s))) {
		begin = wide;
		for (int p = 0; p <= EDGE_ORDERS + 1; p++)
			own_window(&e->window[p], x, n, p <= EDGE_ORDERS ? p : 0, wide, p <= EDGE_ORDERS ? near : 1 - (WIDE - 15) * s);
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
	if (begin < 0.05 || (x * fabs(n - 1) < SOFT && x < SOFT_MAX)) {
		e->whole = 1;
		e->n = 1;
		e->disc = 0;           /* Hilb's forms are not for so few waves, and are not needed */
		for (int p = 0; p <= EDGE_ORDERS + 1; p++)
			e->window[p] = window_one();
	}
}

#define FAR 24

static int waves_new(struct edge *e, struct edge_strip *strip, double from, double to, double about, const struct window *only)
{
	int first = (int)fmax(floor(from * e->x - 0.5), 1), last = (int)fmax(ceil(to * e->x), 2);
	strip->first = first;
	strip->n = last - first + 1;
	strip->about = about * e->x;
	strip->sum = malloc(6 * (size_t)strip->n * sizeof *strip->sum);
	if (!strip->sum)
		return -1;
	strip->sum_behind = strip->sum + 2 * strip->n;
	strip->difference = strip->sum + 4 * strip->n;
	for (int k = 0; k < strip->n; k++) {
		double lambda = first + k + 0.5, u = lambda / e->x, w[EDGE_ORDERS + 2];
		struct debye d;
		double complex s[2];
		int beyond = lambda - 0.5 > e->disc;
		debye_term(e->x, e->m, lambda, &d);
		for (int p = 0; p <= EDGE_ORDERS + 1; p++)
			w[p] = window_at(only ? only : &e->window[p], u);
		for (int j = 0; j < 2; j++) {
			/* p = 1 .. 8, then all above; the sum stands as 1/(1 - I) where W is the same for all */
			double complex part = d.t[j], rays = 0;
			for (int p = 1; p <= EDGE_ORDERS; p++, part *= d.i[j])
				rays += w[p] * part;
			rays += w[EDGE_ORDERS + 1] * part / (1 - d.i[j]);
			s[j] = -(w[0] * (d.r[j] - beyond) + rays) / 2;
			if (e->whole) {
				double complex all = d.r[j] + d.t[j] / (1 - d.i[j]);
				e->lost += lambda * (1 - creal(all * conj(all)));
			}
		}
		double complex sum = (s[0] + s[1]) * (2 * lambda), difference = (s[1] - s[0]) * (2 * lambda);
		double missing = beyond ? 0 : w[0] * 2 * lambda;
		strip->sum[2 * k] = creal(sum);
		strip->sum[2 * k + 1] = cimag(sum);
		strip->difference[2 * k] = creal(difference);
		strip->difference[2 * k + 1] = cimag(difference);
		strip->sum_behind[2 * k] = creal(sum) + (beyond ? 0 : missing);
		strip->sum_behind[2 * k + 1] = cimag(sum);
	}
	if (first < FAR)       /* no angle is far from both axes for such long waves */
		return 0;
	double *scaled = malloc(6 * (size_t)strip->n * sizeof *scaled);
	if (!scaled)
		return -1;
	for (int k = 0; k < strip->n; k++) {
		double scale = 1 / sqrt(first + k + 0.5);
		for (int i = 0; i < 2; i++) {
			scaled[2 * k + i] = strip->sum[2 * k + i] * scale;
			scaled[2 * (strip->n + k) + i] = strip->sum_behind[2 * k + i] * scale;
			scaled[2 * (2 * strip->n + k) + i] = strip->difference[2 * k + i] * scale;
		}
	}
	int failed = spectrum_new(&strip->spectrum, strip->n, (const double *[4]){ scaled, scaled + 2 * strip->n, scaled + 4 * strip->n, NULL });
	free(scaled);
	return failed;
}

int edge_new(struct edge *e, double x, double complex m)
{
	double top = 1 + OUT * cbrt(x / 2) / x, begin = 1, focus = 0;
	int failed;
	memset(e, 0, sizeof *e);
	e->x = x;
	e->m = m;
	e->disc = (int)x;
	set_windows(e);
	for (int p = 0; p <= EDGE_ORDERS + 1; p++) {
		const struct window *w = &e->window[p];
		if (w->over[0] > 0)
			begin = fmin(begin, w->zero[0]);
		else
			focus = w->zero[0];
	}
	if (e->n == 2) {
		failed = waves_new(e, &e->strip[0], begin, e->only[0].zero[1], creal(m), &e->only[0]) ||
		         waves_new(e, &e->strip[1], e->only[1].zero[0], top, 1, &e->only[1]);
	} else if (focus > 0 && focus < begin) {
		e->n = 2;
		failed = waves_new(e, &e->strip[0], 0, focus, focus / 2, NULL) || waves_new(e, &e->strip[1], begin, top, 1, NULL);
	} else {
		failed = waves_new(e, &e->strip[0], focus > 0 ? 0 : begin, top, creal(m) < 1 ? (begin + 1) / 2 : 1, NULL);
	}
	if (failed)
		edge_free(e);
	return failed ? -1 : 0;
}

void edge_free(struct edge *e)
{
	for (int k = 0; k < 2; k++) {
		free(e->strip[k].sum);
		spectrum_free(&e->strip[k].spectrum);
	}
	memset(e, 0, sizeof *e);
}

double edge_absorption(const struct edge *e)
{
	/* Gauss-Legendre on [-1, 1], Abramowitz and Stegun table 25.4 */
	static const double node[4] = { 0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363 };
	static const double weight[4] = { 0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763 };
	double x = e->x, n = creal(e->m), s = cbrt(x / 2) / x, sy = cbrt(n * x / 2) / x, q = 0;
	if (cimag(e->m) == 0)
		return 0;
	if (e->whole)
		return fmax(e->lost / (x * x), 0);
	/* panels in the angle of incidence, of the size of the edge near it and near the critical angle */
	double at[40], turn = n < 1 ? n : 1;
	int panels = 0;
	for (int k = 0; k < 8; k++)
		at[panels++] = sin(asin(turn - 8 * sy) * k / 8);
	for (int k = -4; k <= 4; k++)
		at[panels++] = turn + 2 * k * (n < 1 ? sy : s);
	for (int k = 1; k <= 8 && n < 1; k++)
		at[panels++] = turn + 8 * sy + (1 - 8 * s - turn - 8 * sy) * k / 8;
	for (int k = -3; k <= 4 && n < 1; k++)
		at[panels++] = 1 + 2 * k * s;
	for (int k = 0; k + 1 < panels; k++)
		for (int i = 0; i < 8; i++) {
			double half = (at[k + 1] - at[k]) / 2, u = (at[k] + at[k + 1]) / 2 + half * (i < 4 ? -node[3 - i] : node[i - 4]);
			struct debye d;
			if (half <= 0)
				continue;
			debye_term(x, e->m, x * u, &d);
			for (int j = 0; j < 2; j++) {
				double r = creal(d.r[j] * conj(d.r[j])), t = creal(d.t[j] * conj(d.t[j])), in = creal(d.i[j] * conj(d.i[j]));
				q += half * (i < 4 ? weight[3 - i] : weight[i - 4]) * u * (1 - r - (t > 0 ? t / (1 - in) : 0));
			}
		}
	return fmax(q, 0);
}

void edge_aim(int n, const double *theta, struct edge_packet *out)
{
	for (int b = 0; b * EDGE_WIDTH < n; b++) {
		struct edge_packet *k = &out[b];
		k->sine = 1;
		for (int i = 0; i < EDGE_WIDTH; i++) {
			double t = theta[b * EDGE_WIDTH + i < n ? b * EDGE_WIDTH + i : n - 1], f = fmin(t, 180 - t) * (M_PI / 180);
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
	double z1 = nu * theta + 0.375 * (cot - 1 / theta) / nu, z0 = nu * theta - (tan(theta / 2) + 0.125 * (cot - 1 / theta)) / nu;
	*p = sqrt(both) * q * j1(z1) / st;
	*v = (both * q * j0(z0) + l * 2 * half * half * *p) / (l + 1);
}

double edge_disc(int n, double theta)
{
	/* P'_n + P'_(n+1) - (P_n + P_(n+1))/(1 + cos theta) */
	double sum = 0, st = sin(theta), bend = theta > 1e-3 ? 1 / theta - cos(theta) / st : theta / 3, q = theta > 0 ? sqrt(theta / st) : 1;
	for (int l = n; l <= n + 1; l++) {
		double nu = l + 0.5, z = nu * theta + bend / (8 * nu), v = j0(z);
		double slope = theta > 1e-9 ? (nu * j1(z) - bend * v / 2) / st : (nu * nu - 1.0 / 3) / 2;
		sum += q * (slope - v / (1 + cos(theta)));
	}
	return sum;
}

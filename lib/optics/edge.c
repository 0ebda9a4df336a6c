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
#define LANES 32
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

static int waves_new(struct edge *e, struct edge_strip *strip, double from, double to, const struct window *only)
{
	int first = (int)fmax(floor(from * e->x - 0.5), 1), last = (int)fmax(ceil(to * e->x), 2);
	strip->first = first;
	strip->n = last - first + 1;
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
	return 0;
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
		failed = waves_new(e, &e->strip[0], begin, e->only[0].zero[1], &e->only[0]) ||
		         waves_new(e, &e->strip[1], e->only[1].zero[0], top, &e->only[1]);
	} else if (focus > 0 && focus < begin) {
		e->n = 2;
		failed = waves_new(e, &e->strip[0], 0, focus, NULL) || waves_new(e, &e->strip[1], begin, top, NULL);
	} else {
		failed = waves_new(e, &e->strip[0], focus > 0 ? 0 : begin, top, NULL);
	}
	if (failed)
		edge_free(e);
	return failed ? -1 : 0;
}

void edge_free(struct edge *e)
{
	for (int k = 0; k < 2; k++)
		free(e->strip[k].sum);
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

/* pi_l and v_l = pi_l - pi_(l-1) at l, theta in [0, pi/2], c = 1 - cos theta: uniform Bessel forms of d^l_10 and d^l_11. */
static void angular_start(int l, double theta, double c, double *p, double *v)
{
	double nu = l + 0.5, both = l * (l + 1.0);
	if (l == 1 || theta == 0) {
		*p = both / 2;
		*v = l;
		return;
	}
	double st = sin(theta), cot = cos(theta) / st, q = sqrt(theta / st);
	double z1 = nu * theta + 0.375 * (cot - 1 / theta) / nu, z0 = nu * theta - (tan(theta / 2) + 0.125 * (cot - 1 / theta)) / nu;
	*p = sqrt(both) * q * j1(z1) / st;
	*v = (both * q * j0(z0) + l * c * *p) / (l + 1);
}

/* The strip's sums at LANES angles: S1 + S2 and S1 - S2, in the front half by theta, behind by pi - theta. */
static void strip_direct(const struct edge_strip *strip, int behind, const double *theta, double out[4][LANES])
{
	double c[LANES], p[LANES], v[LANES], s0[LANES] = { 0 }, s1[LANES] = { 0 }, s2[LANES] = { 0 }, s3[LANES] = { 0 };
	const double *sum = behind ? strip->sum_behind : strip->sum, *difference = strip->difference;
	for (int i = 0; i < LANES; i++) {
		double h = sin(theta[i] / 2);
		c[i] = 2 * h * h;
		angular_start(strip->first, theta[i], c[i], &p[i], &v[i]);
	}
	for (int k = 0; k < strip->n; k++) {
		double f = strip->first + k, f1 = f + 1, k1 = f1 / f, k2 = (2 * f + 1) / f, norm = 1 / (f * f1);
		double sign = behind && (strip->first + k) % 2 == 0 ? -norm : norm;
		double xr = sum[2 * k] * sign, xi = sum[2 * k + 1] * sign, yr = difference[2 * k] * sign, yi = difference[2 * k + 1] * sign;
#pragma omp simd
		for (int i = 0; i < LANES; i++) {
			double cp = c[i] * p[i], plus = f1 * v[i] - f * cp, minus = 2 * p[i] - plus;
			double s = behind ? minus : plus, d = behind ? plus : minus;
			s0[i] += xr * s;
			s1[i] += xi * s;
			s2[i] += yr * d;
			s3[i] += yi * d;
			v[i] = k1 * v[i] - k2 * cp;
			p[i] += v[i];
		}
	}
	for (int i = 0; i < LANES; i++) {
		out[0][i] = s0[i];
		out[1][i] = s1[i];
		out[2][i] = s2[i];
		out[3][i] = s3[i];
	}
}

/* sum_(l <= n) (2l+1)/(l(l+1)) (pi_l + tau_l) = P'_n + P'_(n+1) - (P_n + P_(n+1))/(1 + cos theta), Hilb's forms for P. */
static double disc(int n, double theta)
{
	double sum = 0, st = sin(theta), bend = theta > 1e-3 ? 1 / theta - cos(theta) / st : theta / 3, q = theta > 0 ? sqrt(theta / st) : 1;
	for (int l = n; l <= n + 1; l++) {
		double nu = l + 0.5, z = nu * theta + bend / (8 * nu), v = j0(z);
		double slope = theta > 1e-9 ? (nu * j1(z) - bend * v / 2) / st : (nu * nu - 1.0 / 3) / 2;
		sum += q * (slope - v / (1 + cos(theta)));
	}
	return sum;
}

int edge_add(const struct edge *e, int n, const double *theta, double complex *s1, double complex *s2)
{
	for (int k = 0; k < n; k += LANES)
		for (int behind = 0; behind < 2; behind++) {
			double t[LANES], out[4][LANES];
			int at[LANES], used = 0;
			for (int i = k; i < n && i < k + LANES; i++)
				if ((theta[i] > 90) == behind) {
					t[used] = (behind ? 180 - theta[i] : theta[i]) * (M_PI / 180);
					at[used++] = i;
				}
			if (!used)
				continue;
			for (int i = used; i < LANES; i++)
				t[i] = t[0];
			for (int s = 0; s < e->n; s++) {
				strip_direct(&e->strip[s], behind, t, out);
				for (int i = 0; i < used; i++) {
					double complex sum = CMPLX(out[0][i], out[1][i]), difference = CMPLX(out[2][i], out[3][i]);
					s1[at[i]] += (sum + difference) / 2;
					s2[at[i]] += (sum - difference) / 2;
				}
			}
			for (int i = 0; !behind && i < used; i++) {
				double d = e->disc ? disc(e->disc, t[i]) / 2 : 0;
				s1[at[i]] += d;
				s2[at[i]] += d;
			}
		}
	return 0;
}

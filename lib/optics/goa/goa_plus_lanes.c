/* The loops of GOA+: compiled for each processor, BUILD the name of what comes out. */
#include "optics/goa/goa_plus_lanes.h"

#include "optics/goa/debye_waves.h"
#include "optics/numerics/gauss.h"

#include <math.h>

/* Amplitudes of a packet's rays without F. */
static void ray_sizes(const struct goa_plus_packet *k, double x, double size[GOA_WIDTH])
{
	double half = x * x / 2;
#pragma omp simd
	for (int i = 0; i < GOA_WIDTH; i++) {
		double most = x * k->spread[i];
		size[i] = lane_select(x, k->from[i], 0, lane_select(most, half, most, half));
	}
	if (k->fades)
#pragma omp simd
		for (int i = 0; i < GOA_WIDTH; i++)
			size[i] *= lane_decay(x * k->fade[i]);
}

/* Without a window: none of these rays is summed as waves. */
static void rays_alone(const struct goa_plus_packet *k, double x, double s[4][GOA_WIDTH])
{
	double size[GOA_WIDTH];
	ray_sizes(k, x, size);
#pragma omp simd
	for (int i = 0; i < GOA_WIDTH; i++) {
		double sine, cosine, over = x / (x * x + k->hold[i]);
		lane_sincos(x * k->path[i] + k->quarters[i], &sine, &cosine);
		double c = size[i] * cosine, d = size[i] * sine;
		double re1 = k->f[0][i] - k->g[1][i] * over, im1 = k->f[1][i] + k->g[0][i] * over;
		double re2 = k->f[2][i] - k->g[3][i] * over, im2 = k->f[3][i] + k->g[2][i] * over;
		s[0][i] += re1 * c - im1 * d;
		s[1][i] += re1 * d + im1 * c;
		s[2][i] += re2 * c - im2 * d;
		s[3][i] += re2 * d + im2 * c;
	}
}

static void rays_windowed(const struct goa_plus_packet *k, const struct goa_plus_window *w, double x, double s[4][GOA_WIDTH])
{
	double size[GOA_WIDTH];
	ray_sizes(k, x, size);
	/* pieces that are not there begin beyond every u */
	const double from1 = w->n > 1 ? w->from[1] : 2, from2 = w->n > 2 ? w->from[2] : 2;
	const double zero0 = w->zero[0], zero1 = w->zero[1], zero2 = w->zero[2], over0 = w->over[0], over1 = w->over[1];
	const double over2 = w->over[2];
#pragma omp simd
	for (int i = 0; i < GOA_WIDTH; i++) {
		double sine, cosine, over = x / (x * x + k->hold[i]), u = k->u[i], w1, w2;
		double zero = lane_select(u, from1, zero0, lane_select(u, from2, zero1, zero2));
		double slope = lane_select(u, from1, over0, lane_select(u, from2, over1, over2));
		double rest = 1 - smoothstep(zero, slope, u, &w1, &w2);
		lane_sincos(x * k->path[i] + k->quarters[i], &sine, &cosine);
		double c = size[i] * cosine, d = size[i] * sine, g = over * rest, h = over * w1, f = -over * k->e[i] * w2;
		double re1 = k->f[0][i] * rest - (k->g[1][i] * g + k->h[1][i] * h + k->f[1][i] * f);
		double im1 = k->f[1][i] * rest + (k->g[0][i] * g + k->h[0][i] * h + k->f[0][i] * f);
		double re2 = k->f[2][i] * rest - (k->g[3][i] * g + k->h[3][i] * h + k->f[3][i] * f);
		double im2 = k->f[3][i] * rest + (k->g[2][i] * g + k->h[2][i] * h + k->f[2][i] * f);
		s[0][i] += re1 * c - im1 * d;
		s[1][i] += re1 * d + im1 * c;
		s[2][i] += re2 * c - im2 * d;
		s[3][i] += re2 * d + im2 * c;
	}
}

static void rays(const struct goa_plus_packet *k, size_t n, const struct goa_plus_edge *e, double s[4][GOA_WIDTH])
{
	for (const struct goa_plus_packet *end = k + n; k < end; k++) {
		const struct goa_plus_window *w = &e->windows.order[k->p];
		if (e->x * k->clearest > GOA_PLUS_ABSORBED)
			continue;
		double all = goa_plus_window_constant(w, k->least, k->most);
		if (all == 0)
			rays_alone(k, e->x, s);
		else if (all < 0)
			rays_windowed(k, w, e->x, s);
	}
}

/* The partial waves of a strip one by one, in the front half by theta, behind by pi - theta; out: S1 + S2, S1 - S2 (re, im). */
static void direct(const struct goa_plus_edge_strip *strip, int behind, const double *theta, double out[4][GOA_WIDTH])
{
	double c[GOA_WIDTH], p[GOA_WIDTH], v[GOA_WIDTH];
	double sr[GOA_WIDTH] = { 0 }, si[GOA_WIDTH] = { 0 }, dr[GOA_WIDTH] = { 0 }, di[GOA_WIDTH] = { 0 };
	/* behind, pi_l + tau_l and pi_l - tau_l change places, with (-1)^(l-1) */
	const double *with_plus = behind ? strip->difference : strip->sum;
	const double *with_minus = behind ? strip->sum_behind : strip->difference;
	for (int i = 0; i < GOA_WIDTH; i++) {
		double h = sin(theta[i] / 2);
		c[i] = 2 * h * h;
		goa_plus_edge_start(strip->first, theta[i], &p[i], &v[i]);
	}
	for (int k = 0; k < strip->n; k++) {
		int l = strip->first + k;
		double f = l, f1 = f + 1, k1 = f1 / f, k2 = (2 * f + 1) / f, norm = (behind && l % 2 == 0 ? -1 : 1) / (f * f1);
		double xr = with_plus[2 * k] * norm, xi = with_plus[2 * k + 1] * norm, yr = with_minus[2 * k] * norm;
		double yi = with_minus[2 * k + 1] * norm;
#pragma omp simd
		for (int i = 0; i < GOA_WIDTH; i++) {
			double cp = c[i] * p[i], plus = f1 * v[i] - f * cp, minus = 2 * p[i] - plus;
			sr[i] += xr * plus;
			si[i] += xi * plus;
			dr[i] += yr * minus;
			di[i] += yi * minus;
			v[i] = k1 * v[i] - k2 * cp;
			p[i] += v[i];
		}
	}
	for (int i = 0; i < GOA_WIDTH; i++) {
		out[behind ? 2 : 0][i] = sr[i];
		out[behind ? 3 : 1][i] = si[i];
		out[behind ? 0 : 2][i] = dr[i];
		out[behind ? 1 : 3][i] = di[i];
	}
}

/* Near an axis. */
static void near_axis(const struct goa_plus_edge *e, const struct goa_plus_edge_packet *k, double s[4][GOA_WIDTH])
{
	for (int behind = 0; behind < 2; behind++) {
		int any = 0;
		for (int i = 0; i < GOA_WIDTH; i++)
			any |= k->behind[i] == behind;
		for (int strip = 0; any && strip < e->n; strip++) {
			double out[4][GOA_WIDTH];
			direct(&e->strip[strip], behind, k->folded, out);
			for (int i = 0; i < GOA_WIDTH; i++)
				if (k->behind[i] == behind) {
					s[0][i] += (out[0][i] + out[2][i]) / 2;
					s[1][i] += (out[1][i] + out[3][i]) / 2;
					s[2][i] += (out[0][i] - out[2][i]) / 2;
					s[3][i] += (out[1][i] - out[3][i]) / 2;
				}
		}
	}
	for (int i = 0; e->disc && i < GOA_WIDTH; i++)
		if (!k->behind[i]) {
			double d = goa_plus_edge_disc(e->disc, k->theta[i]) / 2;
			s[0][i] += d;
			s[2][i] += d;
		}
}

/* Half a row of a transform: real or imaginary parts. */
typedef double row __attribute__((vector_size(32), aligned(8), may_alias));

/* Where in a transform GOA_WIDTH angles are: the row below, and the kernel's weights of the rows from 3 before it on. */
static void locate(const struct nufft *nufft, const double phi[GOA_WIDTH], int at[GOA_WIDTH],
		   double weight[NUFFT_TAPS][GOA_WIDTH])
{
	double part[GOA_WIDTH], size = nufft->size;
	for (int i = 0; i < GOA_WIDTH; i++) {
		double turns = phi[i] * (1 / (2 * M_PI)), place = (turns - floor(turns)) * size;
		at[i] = (int)place;
		part[i] = place - at[i];
	}
	for (int t = 0; t < NUFFT_TAPS; t++)
#pragma omp simd
		for (int i = 0; i < GOA_WIDTH; i++) {
			double z = (t - 3 - part[i]) * 0.25, inside = 1 - z * z;
			weight[t][i] = lane_decay(NUFFT_SHAPE * (1 - sqrt(lane_select(0, inside, inside, 0))));
		}
}

/* Away from the axes, where d^l_1,+-1 = sqrt(2/(pi nu sin theta)) cos(nu theta - pi/4 - c/nu), nu = l + 1/2. */
static void far_strip(const struct goa_plus_edge_strip *strip, const struct goa_plus_edge_packet *k, double s[4][GOA_WIDTH])
{
	const struct nufft *nufft = &strip->nufft;
	double nu = strip->about, centre = strip->first + strip->n / 2 + 0.5, phi[GOA_WIDTH], weight[NUFFT_TAPS][GOA_WIDTH];
	double value[8][GOA_WIDTH];
	int at[GOA_WIDTH];
	for (int i = 0; i < GOA_WIDTH; i++)
		phi[i] = k->theta[i] + (k->plus[i] + k->minus[i]) / (2 * nu * nu);
	locate(nufft, phi, at, weight);
	for (int i = 0; i < GOA_WIDTH; i++) {
		/* the sums at phi and -phi */
		const double *above = nufft->row + 8 * (at[i] - 3);
		const double *below = nufft->row + 8 * (((nufft->size - at[i]) & (nufft->size - 1)) + 3);
		row up_re = { 0 }, up_im = { 0 }, down_re = { 0 }, down_im = { 0 };
		for (int t = 0; t < NUFFT_TAPS; t++) {
			up_re += weight[t][i] * *(const row *)(above + 8 * t);
			up_im += weight[t][i] * *(const row *)(above + 8 * t + 4);
			down_re += weight[t][i] * *(const row *)(below - 8 * t);
			down_im += weight[t][i] * *(const row *)(below - 8 * t + 4);
		}
		int sum = k->behind[i] != 0;
		const double found[8] = { up_re[sum], up_im[sum], down_re[sum], down_im[sum],
			up_re[2], up_im[2], down_re[2], down_im[2] };
		for (int j = 0; j < 8; j++)
			value[j][i] = found[j];
	}
#pragma omp simd
	for (int i = 0; i < GOA_WIDTH; i++) {
		double shift = (k->plus[i] + k->minus[i]) / (2 * nu * nu);
		double base = nu * k->theta[i] + (centre - nu) * (k->theta[i] + shift);
		double sine, cosine, half = k->root[i] / 2;
		/* e^(i a) E(phi) + e^(-i a) E(-phi) */
		lane_sincos((base - k->plus[i] / nu) * M_2_PI - 0.5, &sine, &cosine);
		double sr = half * (cosine * (value[0][i] + value[2][i]) - sine * (value[1][i] - value[3][i]));
		double si = half * (cosine * (value[1][i] + value[3][i]) + sine * (value[0][i] - value[2][i]));
		/* d^l_1,-1 with the other sign */
		lane_sincos((base - k->minus[i] / nu) * M_2_PI - 0.5, &sine, &cosine);
		double dr = -half * (cosine * (value[4][i] + value[6][i]) - sine * (value[5][i] - value[7][i]));
		double di = -half * (cosine * (value[5][i] + value[7][i]) + sine * (value[4][i] - value[6][i]));
		s[0][i] += (sr + dr) / 2;
		s[1][i] += (si + di) / 2;
		s[2][i] += (sr - dr) / 2;
		s[3][i] += (si - di) / 2;
	}
}

/* The disc away from the axes: goa_plus_edge_disc with Hankel's asymptotics. */
static void far_disc(int n, const struct goa_plus_edge_packet *k, double s[4][GOA_WIDTH])
{
#pragma omp simd
	for (int i = 0; i < GOA_WIDTH; i++) {
		double sum = 0;
		for (int l = n; l <= n + 1; l++) {
			double nu = l + 0.5, z = nu * k->theta[i] + k->bend[i] / (8 * nu), w = 1 / z, w2 = w * w, sine, cosine;
			lane_sincos(z * M_2_PI - 0.5, &sine, &cosine);
			double p0 = 1 + w2 * (-0.0703125 + 0.112152099609375 * w2);
			double q0 = w * (-0.125 + w2 * (0.0732421875 - 0.227108001708984375 * w2));
			double p1 = 1 + w2 * (0.1171875 - 0.144195556640625 * w2);
			double q1 = w * (0.375 + w2 * (-0.1025390625 + 0.277576446533203125 * w2));
			double v0 = p0 * cosine - q0 * sine, v1 = p1 * sine + q1 * cosine;
			sum += sqrt(1 / nu) * ((nu * v1 - k->bend[i] * v0 / 2) * k->slope[i] - v0 * k->slant[i]);
		}
		double d = (1 - k->behind[i]) * k->root[i] * sum / 2;
		s[0][i] += d;
		s[2][i] += d;
	}
}

static void waves(const struct goa_plus_edge *e, const struct goa_plus_edge_packet *k, double s[4][GOA_WIDTH])
{
	int far = 1, front = 0;
	for (int strip = 0; strip < e->n; strip++)
		far &= e->strip[strip].nufft.size && e->strip[strip].first * k->sine > GOA_PLUS_EDGE_FAR;
	if (!far) {
		near_axis(e, k, s);
		return;
	}
	for (int strip = 0; strip < e->n; strip++)
		far_strip(&e->strip[strip], k, s);
	for (int i = 0; i < GOA_WIDTH; i++)
		front |= !k->behind[i];
	if (front && e->disc)
		far_disc(e->disc, k, s);
}

static double coefficients(const struct goa_plus_edge *e, const struct goa_plus_window *only, struct goa_plus_edge_strip *strip)
{
	double x = e->x, lost = 0;
	const struct debye_bounds bounds = debye_bounds(x, e->m);
	for (int k0 = 0; k0 < strip->n; k0 += DEBYE_WIDTH) {
		double lambda_of[DEBYE_WIDTH];
		struct debye_phase outside, inside;
		for (int i = 0; i < DEBYE_WIDTH; i++)
			lambda_of[i] = strip->first + k0 + i + 0.5;
		debye_phases(lambda_of, x, &outside);
		debye_phases(lambda_of, x * creal(e->m), &inside);
		for (int i = 0, k = k0; i < DEBYE_WIDTH && k < strip->n; i++, k++) {
			double lambda = lambda_of[i], u = lambda / x, w[GOA_PLUS_ORDERS + 2], rest;
			struct debye d;
			double complex s[2];
			int beyond = strip->first + k > e->disc;
			debye_term(x, e->m, &bounds, lambda, i, &outside, &inside, &d);
			for (int p = 0; p <= GOA_PLUS_ORDERS + 1; p++)
				w[p] = p && (only || e->windows.same[p]) ? w[p - 1] : goa_plus_window_at(only ? only : &e->windows.order[p], u);
			rest = w[GOA_PLUS_ORDERS + 1];
			for (int j = 0; j < 2; j++) {
				/* all p >= 1 in closed form with the last one's share, and what the others have more */
				double complex part = d.t[j], rays = rest * part / (1 - d.i[j]);
				for (int p = 1; p <= GOA_PLUS_ORDERS && fabs(creal(part)) + fabs(cimag(part)) > 1e-6;
				     p++, part *= d.i[j])
					rays += (w[p] - rest) * part;
				s[j] = -(w[0] * (d.r[j] - beyond) + rays) / 2;
				if (e->windows.whole) {
					double complex all = d.r[j] + d.t[j] / (1 - d.i[j]);
					lost += lambda * (1 - creal(all * conj(all)));
				}
			}
			double complex sum = (s[0] + s[1]) * (2 * lambda), difference = (s[1] - s[0]) * (2 * lambda);
			strip->sum[2 * k] = creal(sum);
			strip->sum[2 * k + 1] = cimag(sum);
			strip->sum_behind[2 * k] = creal(sum) + (beyond ? 0 : w[0] * 2 * lambda);
			strip->sum_behind[2 * k + 1] = cimag(sum);
			strip->difference[2 * k] = creal(difference);
			strip->difference[2 * k + 1] = cimag(difference);
		}
	}
	return lost;
}

static double absorption(const struct goa_plus_edge *e)
{
	double x = e->x, n = creal(e->m), s = cbrt(x / 2) / x, sy = cbrt(n * x / 2) / x, q = 0;
	if (cimag(e->m) == 0)
		return 0;
	if (e->windows.whole)
		return fmax(e->lost / (x * x), 0);
	/* panels in the angle of incidence, of the size of the edge near it and near the critical angle */
	const struct debye_bounds bounds = debye_bounds(x, e->m);
	double at[40], turn = fmin(n, 1);
	int panels = 0;
	for (int k = 0; k <= 8; k++)
		at[panels++] = sin(M_PI_2 * k / 8);
	for (int k = -4; k <= 4; k++)
		if (k)
			at[panels++] = 1 + 2 * k * s;
	for (int k = -4; k <= 4 && n < 1; k++)
		at[panels++] = turn + 2 * k * sy;
	for (int i = 1; i < panels; i++)
		for (int j = i; j > 0 && at[j - 1] > at[j]; j--) {
			double swap = at[j];
			at[j] = at[j - 1];
			at[j - 1] = swap;
		}
	for (int k = 0; k + 1 < panels; k++) {
		double half = (at[k + 1] - at[k]) / 2, lambda[DEBYE_WIDTH];
		struct debye_phase outside, inside;
		for (int i = 0; i < DEBYE_WIDTH; i++)
			lambda[i] = x * ((at[k] + at[k + 1]) / 2 + half * gauss_node[i]);
		debye_phases(lambda, x, &outside);
		debye_phases(lambda, x * n, &inside);
		for (int i = 0; i < DEBYE_WIDTH; i++) {
			struct debye d;
			double sum = 0;
			if (lambda[i] <= 0 || lambda[i] > x * (1 + 8 * s))
				continue;
			debye_term(x, e->m, &bounds, lambda[i], i, &outside, &inside, &d);
			for (int j = 0; j < 2; j++) {
				double r = creal(d.r[j] * conj(d.r[j])), t = creal(d.t[j] * conj(d.t[j]));
				double in = creal(d.i[j] * conj(d.i[j]));
				sum += 1 - r - (t > 0 ? t / (1 - in) : 0);
			}
			q += half * gauss_weight[i] * lambda[i] / x * sum;
		}
	}
	return fmax(q, 0);
}

const struct goa_plus_lanes BUILD = { .rays = rays, .waves = waves, .coefficients = coefficients, .absorption = absorption };

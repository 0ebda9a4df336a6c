/* window - a function of bounded frequency at any point from its values on equal steps.
 *
 * Where f(t) = sum c_k exp(2 pi i k t) with |k| <= 1/(2 sigma), sigma >= 2, and g the same with c_k / W(k): f(t) is the sum of
 * w(t - j) g(j) over the TAPS nearest j, w(z) = I0(b sqrt(1 - (2 z/TAPS)^2)), W its transform.
 * Error exp(-pi TAPS sqrt(1 - 1/sigma)). */
#ifndef OPTICS_KERN_WINDOW_H
#define OPTICS_KERN_WINDOW_H

#include "optics/numerics/kern/wide.h"

#include <math.h>

#define TAPS 16
#define DEGREE 19     /* of the polynomials for the weights between two steps: 1e-16 of the largest */

static double bessel_i0(double z)
{
	double term = 1, sum = 1;
	for (int k = 1; term > 1e-17 * sum; k++) {
		term *= z * z / (4.0 * k * k);
		sum += term;
	}
	return sum;
}

/* window_weights - poly[d][r] of the weight of tap r: a polynomial in 2 f - 1, f in [0, 1) the distance from tap TAPS/2 - 1. */
static void window_weights(double b, double poly[DEGREE + 1][TAPS])
{
	for (int r = 0; r < TAPS; r++) {
		double value[DEGREE + 1], cheb[DEGREE + 1], t[3][DEGREE + 1] = { { 1 }, { 0, 1 } };
		for (int i = 0; i <= DEGREE; i++) {
			double z = (0.5 + 0.5 * cos(M_PI * (i + 0.5) / (DEGREE + 1)) + TAPS / 2 - 1 - r) * 2 / TAPS;
			value[i] = bessel_i0(b * sqrt((1 - z) * (1 + z)));
		}
		for (int k = 0; k <= DEGREE; k++) {
			cheb[k] = 0;
			for (int i = 0; i <= DEGREE; i++)
				cheb[k] += (k ? 2.0 : 1.0) / (DEGREE + 1) * value[i] * cos(M_PI * k * (i + 0.5) / (DEGREE + 1));
		}
		for (int d = 0; d <= DEGREE; d++)
			poly[d][r] = 0;
		for (int k = 0; k <= DEGREE; k++) {    /* T_k = 2 u T_{k-1} - T_{k-2}, in powers of u */
			double *now = t[k % 3];
			for (int d = 0; k > 1 && d <= DEGREE; d++)
				now[d] = (d ? 2 * t[(k + 2) % 3][d - 1] : 0) - t[(k + 1) % 3][d];
			for (int d = 0; d <= DEGREE; d++)
				poly[d][r] += cheb[k] * now[d];
		}
	}
}

/* window_transform - W at frequency k (cycles a step). */
static double window_transform(double b, double k)
{
	double a = M_PI * TAPS * k, r = sqrt((b - a) * (b + a));
	return TAPS * sinh(r) / r;
}

/* window_sum - four functions at distance f beyond g[TAPS/2 - 1], from g[TAPS][4]. */
static inline void window_sum(double poly[DEGREE + 1][TAPS], double f, const double *g, double value[4])
{
	wide u = wide_of(2 * f - 1), w[2] = { wide_load(poly[DEGREE]), wide_load(poly[DEGREE] + 8) }, sum[2] = { { 0 }, { 0 } };
	for (int d = DEGREE - 1; d >= 0; d--)
		for (int h = 0; h < 2; h++)
			w[h] = w[h] * u + wide_load(poly[d] + 8 * h);
	for (int h = 0; h < 2; h++)
		for (int i = 0; i < 4; i++)
			sum[h] += wide_pair(w[h][2 * i], w[h][2 * i + 1]) * wide_load(g + 32 * h + 8 * i);
	sum[0] += sum[1];
	for (int i = 0; i < 4; i++)
		value[i] = sum[0][i] + sum[0][i + 4];
}

#endif

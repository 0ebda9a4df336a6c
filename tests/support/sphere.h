/* A small Lorenz-Mie and Debye code, kept apart from lib/optics so that tests have something else to compare with. */
#ifndef SUPPORT_SPHERE_H
#define SUPPORT_SPHERE_H

#include <complex.h>
#include <math.h>
#include <stdlib.h>

static inline int sphere_terms(double x) { return (int)(x + 7 * cbrt(x) + 8); }

/* Mie coefficients a[1..n], b[1..n]: D downward, psi upward below n = x and by downward ratios beyond. */
static inline void sphere_mie(double x, double complex m, int n, double complex *a, double complex *b)
{
	double complex y = m * x;
	int top = (int)fmax(n, cabs(y)) + 16 + (int)(8 * cbrt(cabs(y)));
	double complex *d = malloc(((size_t)top + 1) * sizeof *d);
	double *ratio = malloc(((size_t)n + 2) * sizeof *ratio), r = 0;
	d[top] = 0;
	for (int l = top; l > 0; l--)
		d[l - 1] = l / y - 1 / (d[l] + l / y);
	for (int l = n + 60; l > 0; l--) {
		r = 1 / ((2 * l + 1) / x - r);
		if (l <= n)
			ratio[l] = r;
	}
	double p2 = cos(x), p1 = sin(x), c2 = -sin(x), c1 = cos(x);
	for (int l = 1; l <= n; l++) {
		double p = l < x ? (2 * l - 1) / x * p1 - p2 : ratio[l] * p1, c = (2 * l - 1) / x * c1 - c2;
		double complex ta = d[l] / m + l / x, tb = d[l] * m + l / x;
		a[l] = (ta * p - p1) / (ta * (p - I * c) - (p1 - I * c1));
		b[l] = (tb * p - p1) / (tb * (p - I * c) - (p1 - I * c1));
		p2 = p1, p1 = p, c2 = c1, c1 = c;
	}
	free(d);
	free(ratio);
}

/* Order p of the Debye series (p >= 0) as coefficients; p = 0 with what is diffracted. Hankel functions upward; inside scaled
 * by exp(-+iy). Good for Im y up to a few hundred. */
static inline void sphere_debye(double x, double complex m, int p, int n, double complex *a, double complex *b)
{
	double complex y = m * x, z2 = cexp(I * x), z1 = -I * z2, u1 = -I, u1m = 1, u2 = I, u2m = 1, turn = cexp(2 * I * y);
	int stop = 0;
	for (int l = 1; l <= n; l++) {
		double complex z = (2 * l - 1) / x * z1 - z2, v1 = (2 * l - 1) / y * u1 - u1m, v2 = (2 * l - 1) / y * u2 - u2m;
		double complex a1 = z1 / z - l / x, a2 = conj(a1), l1 = u1 / v1 - l / y, l2 = u2 / v2 - l / y;
		double complex rx = conj(z) / z, ry = v1 / v2 * turn;
		for (int k = 0; k < 2; k++) {
			double complex f = k ? m : 1 / m, b1 = f * l1, b2 = f * l2, part;
			if (p == 0) {
				part = -rx * (a2 - b2) / (a1 - b2);
			} else {
				double complex inner = -ry * (b1 - a1) / (b2 - a1);
				part = -rx * ry * (a1 - a2) * (b2 - b1) / ((a1 - b2) * (a1 - b2));
				for (int i = 1; i < p; i++)
					part *= inner;
			}
			if (stop)
				part = p == 0;
			(k ? b : a)[l] = 0.5 * ((p == 0) - part);
		}
		stop = stop || cabs(z) > 1e60;
		z2 = z1, z1 = z, u1m = u1, u1 = v1, u2m = u2, u2 = v2;
	}
}

/* S1, S2 at theta (rad). */
static inline void sphere_sum(int n, const double complex *a, const double complex *b, double theta, double complex *s1, double complex *s2)
{
	double mu = cos(theta), before = 0, pi = 1;
	*s1 = *s2 = 0;
	for (int l = 1; l <= n; l++) {
		double tau = l * mu * pi - (l + 1) * before, f = (2 * l + 1) / (l * (l + 1.0));
		*s1 += f * (a[l] * pi + b[l] * tau);
		*s2 += f * (a[l] * tau + b[l] * pi);
		double next = ((2 * l + 1) * mu * pi - (l + 1) * before) / l;
		before = pi, pi = next;
	}
}

/* Q_ext, Q_sca, g. */
static inline void sphere_q(double x, int n, const double complex *a, const double complex *b, double *ext, double *sca, double *g)
{
	*ext = *sca = *g = 0;
	for (int l = 1; l <= n; l++) {
		*ext += (2 * l + 1) * creal(a[l] + b[l]);
		*sca += (2 * l + 1) * (creal(a[l] * conj(a[l])) + creal(b[l] * conj(b[l])));
		*g += (2 * l + 1) / (l * (l + 1.0)) * creal(a[l] * conj(b[l]));
		if (l < n)
			*g += l * (l + 2.0) / (l + 1) * creal(a[l] * conj(a[l + 1]) + b[l] * conj(b[l + 1]));
	}
	*g *= 2 / *sca;
	*ext *= 2 / (x * x);
	*sca *= 2 / (x * x);
}

#endif

#include "optics/goa/debye_order.h"

#include <math.h>

/* 1/z with one division; z is no zero. */
static double complex reciprocal(double complex z)
{
	double r = 1 / (creal(z) * creal(z) + cimag(z) * cimag(z));
	return CMPLX(creal(z) * r, -cimag(z) * r);
}

void debye_order_amplitude(int p, double complex m, double complex u, double epsilon, double complex f[2])
{
	double complex u2 = u * u, ci = csqrt(1 - u2), q;
	if (cimag(m) == 0 && cimag(u) == 0) {
		double n = creal(m), q2 = (n - 1) * (n + 1) + creal(ci) * creal(ci);
		q = q2 >= 0 ? sqrt(q2) : CMPLX(0, sqrt(-q2));
	} else {
		q = csqrt(m * m - u2);
		if (cimag(u) == 0 && cimag(q) < 0)
			q = -q;
	}
	double complex k = epsilon ? epsilon * u2 / (2 * ci * ci) : 0, ky = epsilon ? epsilon * u2 / (2 * m * q * q) : 0;
	double complex over = reciprocal(m), c = q * over;
	double complex a1 = I * ci - k, a2 = -I * ci - k, l1 = I * c - ky, l2 = -I * c - ky;
	for (int j = 0; j < 2; j++) {
		double complex a = j ? over : m, b1 = a * l1, b2 = a * l2, d = reciprocal(a1 - b2);
		if (p == 0) {
			f[j] = -(a2 - b2) * d;
			continue;
		}
		double complex inside = -(b1 - a1) * reciprocal(b2 - a1);
		f[j] = -(a1 - a2) * (b2 - b1) * d * d;
		for (int i = 1; i < p; i++)
			f[j] *= inside;
	}
}

double complex debye_order_chord(double complex m, double complex u)
{
	if (cimag(m) == 0)
		return 2 * csqrt((m - u) * (m + u));
	double n = creal(m);
	double complex real = cimag(u) == 0 ? acos(fmin(creal(u) / n, 1)) : cacos(u / n);
	double complex chord = 2 * (csqrt(m * m - u * u) - u * (cacos(u / m) - real));
	return cimag(u) != 0 ? chord : CMPLX(creal(chord), fmax(cimag(chord), 0));
}

double complex debye_order_path(int p, double complex m, double complex u)
{
	double complex outside = 2 * csqrt((1 - u) * (1 + u));
	return p == 0 ? -outside : p * debye_order_chord(m, u) - outside;
}

/* Derivatives by u of phase/x: phi'' to phi''''. */
static void phases(int p, double n, double u, double *p2, double *p3, double *p4)
{
	double c = sqrt((1 - u) * (1 + u)), c3 = c * c * c;
	*p2 = -2 / c;
	*p3 = -2 * u / c3;
	*p4 = -2 * (1 / c3 + 3 * u * u / (c3 * c * c));
	if (p) {
		double q = sqrt((n - u) * (n + u)), q3 = q * q * q;
		*p2 += 2 * p / q;
		*p3 += 2 * p * u / q3;
		*p4 += 2 * p * (1 / q3 + 3 * u * u / (q3 * q * q));
	}
}

void debye_order_terms(int p, double complex m, double u, double theta, int sigma, int axial, struct debye_order_terms *out)
{
	double n = creal(m), end = p && n < 1 ? n : 1, at = u;
	if (axial && u < DEBYE_ORDER_AXIAL && end > 2 * DEBYE_ORDER_AXIAL) {
		at = DEBYE_ORDER_AXIAL;
		double axis = fabs(2 * asin(at) - 2 * p * asin(at / n));
		theta = p % 2 ? axis : M_PI - axis;
	}
	double h = fmin(1e-3 * fmin(1, 20 * at), (end - at) / 8), p2, p3, p4;
	int total = p == 0 && at >= n;      /* reflection: R turns fast, the strip has what is near */
	double complex lo[2], hi[2], up[2], down[2], f[2];
	debye_order_amplitude(p, m, u, 0, out->f);
	out->path = debye_order_path(p, m, u);
	out->e = 0;
	for (int j = 0; j < 2; j++)
		out->g[j] = out->h[j] = 0;
	if (h <= 0 || (p == 0 && n < 1 && fabs(at - n) < 2 * h))
		return;
	debye_order_amplitude(p, m, at, 0, f);
	debye_order_amplitude(p, m, at - h, 0, lo);
	debye_order_amplitude(p, m, at + h, 0, hi);
	debye_order_amplitude(p, m, at, 1e-5, up);
	debye_order_amplitude(p, m, at, -1e-5, down);
	phases(p, n, at, &p2, &p3, &p4);
	if (!(fabs(p2) > 1e-8))    /* a focus: no form of rays holds */
		return;
	double c = sqrt((1 - at) * (1 + at)), debye = (3 / c + 5 * at * at / (c * c * c)) / 12;
	if (!total && p) {
		double q = sqrt((n - at) * (n + at));
		debye -= p * (3 / q + 5 * at * at / (q * q * q)) / 12;
	}
	/* A wave exp(-x a(u)) on the ray of the real index; its slope moves the stationary point. */
	double complex slope = 0, bend = 0;
	if (p && cimag(m) != 0) {
		slope = 2 * p * (acos(fmin(at / n, 1)) - cacos(at / m));
		bend = 2 * p * (1 / csqrt(m * m - at * at) - 1 / sqrt(n * n - at * at));
		double complex more = -slope * slope / (2 * p2);
		if (cabs(more) < 0.2 * cimag(out->path))     /* else a caustic, or too little light to matter */
			out->path += more;
		else
			slope = bend = 0;
	}
	double tilt = tan(theta / 2), cot = 1 / tan(theta), plus = tilt + cot / 8, minus = -1 / tilt + cot / 8;
	out->e = 1 / (2 * p2);
	for (int j = 0; j < 2; j++) {
		double complex f1 = (hi[j] - lo[j]) / (2 * h), f2 = (hi[j] - 2 * f[j] + lo[j]) / (h * h);
		double complex stationary = f2 + f1 / at - f[j] / (4 * at * at) - p3 / p2 * (f1 + f[j] / (2 * at)) +
			f[j] * (5 * p3 * p3 / (12 * p2 * p2) - p4 / (4 * p2));
		double complex sum = (f[0] + f[1]) / 2, difference = (j ? f[1] - f[0] : f[0] - f[1]) / 2;
		out->g[j] = stationary / (2 * p2) + f[j] * debye - I * (up[j] - down[j]) / 2e-5 -
			sigma / at * (plus * sum + minus * difference);
		out->f[j] -= (bend * f[j] + slope * (2 * f1 + f[j] / at - p3 / p2 * f[j])) / (2 * p2);
		out->h[j] = at == u ? (f[j] * p3 / p2 - 2 * f1 - f[j] / u) / (2 * p2) : 0;
	}
}

/* debye_waves - the partial waves of a large sphere one reflection after the other (Debye series), by asymptotic forms. Part
 * of the loops that are compiled for each processor.
 *
 * A wave's scattering coefficient is a_l = (1 - S_2)/2, b_l = (1 - S_1)/2, S = R + sum_(p>=1) T I^(p-1): reflected outside, or
 * transmitted into p chords. Index 0 is b_l (amplitude S1, perpendicular), index 1 is a_l. lambda = l + 1/2.
 *
 * Accuracy: relative to the exact Riccati-Bessel functions about lambda^(-4/3)/60; energy is conserved exactly for real m.
 * Source: Nussenzveig 1992, Diffraction Effects in Semiclassical Scattering, ch. 9; uniform forms: Langer's, Abramowitz and
 * Stegun 9.3.35 to 9.3.39 to leading order, and Debye's, 9.3.15, to second order away from the turning points. */
#ifndef OPTICS_DEBYE_WAVES_H
#define OPTICS_DEBYE_WAVES_H

#include "optics/goa/debye_bounds.h"
#include "optics/numerics/airy.h"
#include "optics/numerics/lane_math.h"

#include <math.h>

#define DEBYE_WIDTH 8

/* What a real argument z (outside x, inside m x) gives at DEBYE_WIDTH waves away from its turning point:
 * xi'/xi = i c - k, and e^(2 i phase) of xi. */
struct debye_phase {
	double c[DEBYE_WIDTH], k[DEBYE_WIDTH], cosine[DEBYE_WIDTH], sine[DEBYE_WIDTH];
};

struct debye {
	double complex r[2], t[2], i[2];
};

/* Langer's variable of a cylinder function of order lambda at z lambda: zeta, and q = 4 zeta/(1 - z^2). */
static void langer_real(double z, double *zeta, double *q)
{
	double e = 1 - z;
	if (fabs(e) < 1e-3) {
		*zeta = cbrt(2) * e * (1 + e * (0.3 + 32.0 / 175 * e));
		*q = 2 * cbrt(2) * (1 + e * (0.8 + 0.682857142857 * e));
		return;
	}
	double s = sqrt(fabs((1 - z) * (1 + z)));
	*zeta = z > 1 ? -pow(1.5 * (s - acos(1 / z)), 2.0 / 3) : pow(1.5 * (log((1 + s) / z) - s), 2.0 / 3);
	*q = 4 * *zeta / ((1 - z) * (1 + z));
}

static void langer_complex(double complex z, double complex *zeta, double complex *q)
{
	double complex e = 1 - z;
	if (cabs(e) < 1e-3) {
		*zeta = cbrt(2) * e * (1 + e * (0.3 + 32.0 / 175 * e));
		*q = 2 * cbrt(2) * (1 + e * (0.8 + 0.682857142857 * e));
		return;
	}
	double complex s = csqrt((1 - z) * (1 + z));
	if (creal(z) > 1) {
		s = csqrt((z - 1) * (z + 1));
		*zeta = -cpow(1.5 * (s - cacos(1 / z)), 2.0 / 3);
	} else {
		*zeta = cpow(1.5 * (clog((1 + s) / z) - s), 2.0 / 3);
	}
	*q = 4 * *zeta / ((1 - z) * (1 + z));
}

static void debye_phases(const double lambda_of[DEBYE_WIDTH], double z, struct debye_phase *out)
{
#pragma omp simd
	for (int i = 0; i < DEBYE_WIDTH; i++) {
		double lambda = lambda_of[i], s2 = (z - lambda) * (z + lambda);
		s2 = lane_select(s2, 1e-300, 1e-300, s2);      /* beyond the turning point others serve */
		double s = sqrt(s2), phase = s - lambda * lane_atan2(s, lambda) - (3 + 5 * lambda * lambda / s2) / (24 * s);
		out->c[i] = s / z;
		out->k[i] = lambda * lambda / (2 * z * s2);
		lane_sincos(phase * (4 / M_PI) - 1, &out->sine[i], &out->cosine[i]);
	}
}

/* R, T, I of one polarisation from the logarithmic derivatives and phases of the waves outside and inside. Not a loop over both:
 * gcc contracts the complex products of such a loop whatever -ffp-contract says, and builds would differ. */
static void debye_surface(double complex f, double complex a1, double complex l1, double complex l2, double complex rx,
			  double complex ry, double complex *r, double complex *t, double complex *i)
{
	double complex a2 = conj(a1), b1 = f * l1, b2 = f * l2, d = 1 / (a1 - b2);
	*r = -rx * (a2 - b2) * d;
	*t = -rx * ry * (a1 - a2) * (b2 - b1) * d * d;
	*i = -ry * (b1 - a1) / (b2 - a1);
}

/* xi'/xi of the outgoing wave outside, and xi*(x)/xi(x). */
static void debye_outside(double x, const struct debye_bounds *bounds, double lambda, int i, const struct debye_phase *outside,
                          double complex *a1, double complex *rx)
{
	if (lambda < bounds->outside) {
		*a1 = CMPLX(-outside->k[i], outside->c[i]);
		*rx = CMPLX(outside->cosine[i], -outside->sine[i]);
		return;
	}
	double z = x / lambda, zeta, q, l = cbrt(lambda);
	langer_real(z, &zeta, &q);
	struct airy a = airy_real(fmin(l * l * zeta, 60));
	double root = sqrt(sqrt(q));
	double complex h = root / l * CMPLX(a.ai, -a.bi), hp = -(2 / z) / (root * l * l) * CMPLX(a.aip, -a.bip);
	*a1 = 1 / (2 * x) + hp / h;
	*rx = conj(h) / h;
}

/* The regular wave inside and its derivative, but for a common factor; real for a real index. */
static void debye_regular(double complex y, int absorbs, double lambda, double complex *psi, double complex *psip)
{
	double l = cbrt(lambda);
	if (!absorbs) {
		double z = creal(y) / lambda, zeta, q;
		langer_real(z, &zeta, &q);
		double at = l * l * zeta, root = sqrt(sqrt(q)), ai = 1;
		double aip = -sqrt(at) - 0.25 / at; /* far outside but for a factor */
		if (at < 30) {
			struct airy a = airy_real(at);
			ai = a.ai;
			aip = a.aip;
		}
		*psi = root / l * ai;
		*psip = *psi / (2 * creal(y)) - (2 / z) / (root * l * l) * aip;
	} else {
		double complex z = y / lambda, zeta, q;
		langer_complex(z, &zeta, &q);
		double complex root = csqrt(csqrt(q));
		*psi = root / l;      /* but for Ai */
		*psip = *psi / (2 * y) - (2 / z) / (root * l * l) * airy_ratio(l * l * zeta);
	}
}

/* The logarithmic derivatives of both waves inside, and the phase of a chord. */
static void debye_inside(double complex y, int absorbs, const struct debye_bounds *bounds, double lambda, int i,
                         const struct debye_phase *inside, double complex *l1, double complex *l2, double complex *ry)
{
	if (!absorbs) {
		*l1 = CMPLX(-inside->k[i], inside->c[i]);
		*l2 = conj(*l1);
		*ry = CMPLX(inside->cosine[i], inside->sine[i]);
		return;
	}
	double complex s = csqrt((y - lambda) * (y + lambda));
	if (cimag(s) < 0)
		s = -s;
	double complex c = s / y, k = lambda * lambda / (2 * y * s * s);
	*l1 = I * c - k;
	*l2 = -I * c - k;
	*ry = 0;
	if (!bounds->opaque)
		*ry = cexp(2 * I * (s - lambda * cacos(lambda / y) - M_PI / 4 - (3 + 5 * lambda * lambda / (s * s)) / (24 * s)));
}

/* R, T, I of one wave, number i of those that the phases are of. Where the orders cannot be told apart (debye_separable), r is the
 * whole sum S and t, i are 0. lambda is at most x + 8 (x/2)^(1/3). */
static void debye_term(double x, double complex m, const struct debye_bounds *bounds, double lambda, int i,
                       const struct debye_phase *outside, const struct debye_phase *inside, struct debye *out)
{
	double complex a1, rx, y = m * x;
	const double complex f[2] = { m, 1 / m };
	debye_outside(x, bounds, lambda, i, outside, &a1, &rx);
	if (lambda >= bounds->separable) {
		double complex a2 = conj(a1), psi, psip;
		debye_regular(y, cimag(m) != 0, lambda, &psi, &psip);
		out->r[0] = -rx * (a2 * psi - f[0] * psip) / (a1 * psi - f[0] * psip);
		out->r[1] = -rx * (a2 * psi - f[1] * psip) / (a1 * psi - f[1] * psip);
		out->t[0] = out->t[1] = out->i[0] = out->i[1] = 0;
		return;
	}
	double complex l1, l2, ry;
	debye_inside(y, cimag(m) != 0, bounds, lambda, i, inside, &l1, &l2, &ry);
	debye_surface(f[0], a1, l1, l2, rx, ry, &out->r[0], &out->t[0], &out->i[0]);
	debye_surface(f[1], a1, l1, l2, rx, ry, &out->r[1], &out->t[1], &out->i[1]);
}

#endif

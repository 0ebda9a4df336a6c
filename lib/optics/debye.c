#include "optics/debye.h"

#include "optics/airy.h"

#include <math.h>

#define TURN 5    /* widths (z/2)^(1/3) around a turning point where Airy functions are needed */

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

/* Away from the turning point: xi_l'/xi_l = i c - k, and the phase of xi_l. */
static void debye_real(double lambda, double x, double *c, double *k, double *phase)
{
	double s = sqrt((x - lambda) * (x + lambda));
	*c = s / x;
	*k = lambda * lambda / (2 * x * s * s);
	*phase = s - lambda * atan2(s, lambda) - M_PI / 4 - (3 + 5 * lambda * lambda / (s * s)) / (24 * s);
}

int debye_separable(double x, double complex m, double lambda)
{
	double y = creal(m) * x, width = TURN * cbrt(y / 2);
	return lambda < y - width || cimag(m) * x > width;
}

void debye_term(double x, double complex m, double lambda, struct debye *out)
{
	double complex a1, rx;      /* xi'/xi of the outgoing wave outside; xi*(x)/xi(x) */
	if (lambda < x - TURN * cbrt(x / 2)) {
		double c, k, phase;
		debye_real(lambda, x, &c, &k, &phase);
		a1 = CMPLX(-k, c);
		rx = CMPLX(cos(2 * phase), -sin(2 * phase));
	} else {
		double z = x / lambda, zeta, q, l = cbrt(lambda);
		langer_real(z, &zeta, &q);
		struct airy a = airy_real(fmin(l * l * zeta, 60));
		double root = sqrt(sqrt(q));
		double complex h = root / l * CMPLX(a.ai, -a.bi), hp = -(2 / z) / (root * l * l) * CMPLX(a.aip, -a.bip);
		a1 = 1 / (2 * x) + hp / h;
		rx = conj(h) / h;
	}
	double complex a2 = conj(a1), y = m * x;
	const double complex f[2] = { m, 1 / m };
	if (!debye_separable(x, m, lambda)) {
		/* the regular wave inside and its derivative; real for a real index */
		double l = cbrt(lambda);
		double complex psi, psip;
		if (cimag(m) == 0) {
			double z = creal(y) / lambda, zeta, q;
			langer_real(z, &zeta, &q);
			double at = l * l * zeta, root = sqrt(sqrt(q)), ai = 1, aip = -sqrt(at) - 0.25 / at;    /* far outside but for a factor */
			if (at < 30) {
				struct airy a = airy_real(at);
				ai = a.ai;
				aip = a.aip;
			}
			psi = root / l * ai;
			psip = psi / (2 * creal(y)) - (2 / z) / (root * l * l) * aip;
		} else {
			double complex z = y / lambda, zeta, q, ai, aip;
			langer_complex(z, &zeta, &q);
			double complex at = l * l * zeta;
			if (creal(at) < 30) {
				airy_complex(at, &ai, &aip);
			} else {
				ai = 1;
				aip = -csqrt(at) - 0.25 / at;
			}
			double complex root = csqrt(csqrt(q));
			psi = root / l * ai;
			psip = psi / (2 * y) - (2 / z) / (root * l * l) * aip;
		}
		for (int j = 0; j < 2; j++) {
			out->r[j] = -rx * (a2 * psi - f[j] * psip) / (a1 * psi - f[j] * psip);
			out->t[j] = out->i[j] = 0;
		}
		return;
	}
	double complex l1, l2, ry;
	if (cimag(m) == 0) {
		double c, k, phase;
		debye_real(lambda, creal(y), &c, &k, &phase);
		l1 = CMPLX(-k, c);
		l2 = conj(l1);
		ry = CMPLX(cos(2 * phase), sin(2 * phase));
	} else {
		double complex s = csqrt((y - lambda) * (y + lambda));
		if (cimag(s) < 0)
			s = -s;
		double complex c = s / y, k = lambda * lambda / (2 * y * s * s);
		double complex phase = s - lambda * cacos(lambda / y) - M_PI / 4 - (3 + 5 * lambda * lambda / (s * s)) / (24 * s);
		l1 = I * c - k;
		l2 = -I * c - k;
		ry = cexp(2 * I * phase);
	}
	for (int j = 0; j < 2; j++) {
		double complex b1 = f[j] * l1, b2 = f[j] * l2, d = 1 / (a1 - b2);
		out->r[j] = -rx * (a2 - b2) * d;
		out->t[j] = -rx * ry * (a1 - a2) * (b2 - b1) * d * d;
		out->i[j] = -ry * (b1 - a1) / (b2 - a1);
	}
}

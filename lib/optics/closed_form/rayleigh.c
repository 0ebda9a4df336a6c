#include "optics/closed_form/rayleigh.h"

#include <float.h>
#include <math.h>

/* Beyond here the series is a guess that only has to be a number. */
#define LARGEST 1.0

static double complex over(double complex a, double complex b)
{
	double w = 1 / norm2(b);
	return CMPLX((creal(a) * creal(b) + cimag(a) * cimag(b)) * w, (cimag(a) * creal(b) - creal(a) * cimag(b)) * w);
}

/* a + b i times c + d i, without the search for infinities */
static double complex times(double complex a, double complex b)
{
	return CMPLX(creal(a) * creal(b) - cimag(a) * cimag(b), creal(a) * cimag(b) + cimag(a) * creal(b));
}

/* The orders left out: of scattering from x^6 on, and of absorption from x^4 on. */
double rayleigh_error(double x, double complex m)
{
	double w = sqrt(norm2(m - 1) * norm2(m + 1)), w3 = w * w * w, x2 = x * x, x4 = x2 * x2;
	double scattering = (0.0015 + 0.015 * w + 2e-4 * w3) * x4 * x2;
	double absorption = cimag(m) > 0 ? (0.018 + 0.022 * w + 3e-4 * w3) * x4 : 0;
	double error = (scattering + absorption) * (1 + x2 * (0.2 + 0.15 * w)) + 4 * DBL_EPSILON;
	return x > LARGEST ? fmax(error, 1) : error;
}

struct efficiencies rayleigh_efficiencies(double x, double complex m)
{
	double x2 = fmin(x, LARGEST) * fmin(x, LARGEST), x3 = fmin(x, LARGEST) * x2, x4 = x2 * x2;
	double complex k = conj(m), q = times(k, k), contrast = times(k - 1, k + 1);
	/* a1, b1, a2 over x^3 i */
	double complex shape = 2.0 / 3 * times(contrast, 1 - x2 / 10 + (4 * q + 5) * (x4 / 1400));
	double complex damped = 2.0 / 3 * x3 * (1 - x2 / 10) * contrast;
	double complex inside = q + 2 + (1 - 0.7 * q) * x2 - (times(8 * q - 385, q) + 350) * (x4 / 1400);
	double complex d = inside + CMPLX(-cimag(damped), creal(damped)), a1 = over(shape, d);
	double complex b1 = x2 / 45 * times(contrast, over(1 + (2 * q - 5) * (x2 / 70), 1 - (2 * q - 5) * (x2 / 30)));
	double complex a2 = x2 / 15 * (1 - x2 / 14) * over(contrast, 2 * q + 3 - (2 * q - 7) * (x2 / 14));
	double total = norm2(a1) + norm2(b1) + 5.0 / 3 * norm2(a2);
	struct efficiencies e;
	e.sca = 6 * x4 * total;
	/* Not extinction less scattering, which cancel where little is absorbed: -Im a1 = |a1|^2 Im(1/a1), whose share of `damped' is what a1
	 * scatters. */
	double absorbed = cimag(m) == 0 ? 0 : norm2(a1) * cimag(over(inside, shape)) - cimag(b1) - 5.0 / 3 * cimag(a2);
	e.abs = fmax(6 * fmin(x, LARGEST) * absorbed, 0);
	e.ext = e.sca + e.abs;
	e.g = creal(times(a1, conj(a2 + b1))) / total;
	e.back = x4 * norm2(3 * (a1 - b1) - 5 * a2);
	return e;
}

#include "optics/mie.h"

#include "optics/mie_lanes.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* one sphere, in plain doubles */
#define LANES 1
#define UNROLL 1
#include "optics/mie_solve.h"

int mie_terms(double x, double complex m)
{
	double edge = cbrt(x), y = sqrt(norm2(m)) * x, broad = cimag(m) * x;
	double n = x + 7 * edge + 8;                  /* psi_l / chi_l < 1e-16, falling as e^(-1.89 t^(3/2)) at x + t x^(1/3) */
	if (broad >= 1)
		return (int)ceil(n);
	/* Narrow resonances, below y, lift it by 1/chi_l^2, but by no more than absorption, which broadens them: < 1e-32 without any. */
	double t = broad > 1e-18 ? cbrt(pow((36 - log(broad)) / 1.89, 2)) : 12;
	return (int)ceil(fmax(n, fmin(y + 2, x + t * edge + 10)));
}

int mie_coefficients(double x, double complex m, int n, double complex *a, double complex *b)
{
	struct spheres s = { { x }, { creal(m) }, { cimag(m) }, { n }, n, cimag(m) > 0, mie_near(m) };
	double *room = malloc(3 * ((size_t)n + 2) * sizeof *room);
	if (!room)
		return -1;
	struct ratios e = ratios_of(&s, room);
	struct climb k = climb_start(&s);
	a[0] = b[0] = 0;
	for (int l = 1; l <= n; l++) {
		double al[2], bl[2];
		int outside = l >= e.outside;
		climb_to(&k, &s, &e, l, outside);
		climb_waves(&k, &s, &e, l, 0, outside, al, bl);
		a[l] = CMPLX(al[0], al[1]);
		b[l] = CMPLX(bl[0], bl[1]);
	}
	free(room);
	return 0;
}

int mie_lossless(int n, const double complex *a, const double complex *b)
{
	/* Squares below the normal range have lost digits; so small a wave tells nothing. */
	for (int l = 1; l <= n; l++) {
		double a2 = norm2(a[l]), b2 = norm2(b[l]);
		if (fabs(creal(a[l]) - a2) > 16 * DBL_EPSILON * a2 + DBL_MIN || fabs(creal(b[l]) - b2) > 16 * DBL_EPSILON * b2 + DBL_MIN)
			return 0;
	}
	return 1;
}

struct efficiencies mie_of_sums(double x, int lossless, const struct mie_sums *s)
{
	double sca = lossless || s->sca > s->ext ? s->ext : s->sca;    /* greater by rounding alone: Re a >= |a|^2 */
	struct efficiencies q;
	q.ext = 2 / (x * x) * s->ext;
	q.sca = 2 / (x * x) * sca;
	q.abs = q.ext - q.sca;
	q.g = 2 * s->asym / sca;
	q.back = (s->back_re * s->back_re + s->back_im * s->back_im) / (x * x);    /* S1(180 deg) = sum (2l+1) (-1)^l (b - a) / 2 */
	return q;
}

double mie_error_of_sums(double x, int lossless, const struct mie_sums *s)
{
	/* The largest coefficient is about (4/9) |m-1| x^3 where x is small, |m-1| x where it is large and m near 1; of all, the sum of
	 * (2l+1) |a|^2 tells: 3 |a_1|^2 or about x^2 times the largest. */
	double size = sqrt((lossless ? s->ext : s->sca) / fmax(3, x * x));
	double contrast = fmin(1, size / fmin(1, 4.0 / 9 * x * x * x) / fmax(1, x));
	return 2 * DBL_EPSILON * (10 + x + 1 / contrast);
}

struct efficiencies mie_efficiencies(double x, int lossless, int n, const double complex *a, const double complex *b, double *error)
{
	struct solved q = { { 0 }, { 0 }, { 0 }, { 0 }, { 0 } };
	struct spheres s = { .absorb = !lossless };
	double old_a[2] = { 0, 0 }, old_b[2] = { 0, 0 };
	for (int l = 1; l <= n; l++) {
		double al[2] = { creal(a[l]), cimag(a[l]) }, bl[2] = { creal(b[l]), cimag(b[l]) };
		solved_add(&q, &s, l, 0, al, bl, old_a, old_b);
		memcpy(old_a, al, sizeof al);
		memcpy(old_b, bl, sizeof bl);
	}
	struct mie_sums sums = { q.ext[0], q.sca[0], q.asym[0], q.back_re[0], q.back_im[0] };
	if (error)
		*error = mie_error_of_sums(x, lossless, &sums);
	return mie_of_sums(x, lossless, &sums);
}

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
	double edge = cbrt(x), y = cabs(m) * x, broad = cimag(m) * x;
	double n = x + 7 * edge + 8;                  /* psi_l / chi_l < 1e-16, falling as e^(-1.89 t^(3/2)) at x + t x^(1/3) */
	if (broad >= 1)
		return (int)ceil(n);
	/* Narrow resonances, below y, lift it by 1/chi_l^2, but by no more than absorption, which broadens them: < 1e-32 without any. */
	double t = broad > 1e-18 ? cbrt(pow((36 - log(broad)) / 1.89, 2)) : 12;
	return (int)ceil(fmax(n, fmin(y + 2, x + t * edge + 10)));
}

int mie_coefficients(double x, double complex m, int n, double complex *a, double complex *b)
{
	struct spheres s = { { x }, { creal(m) }, { cimag(m) }, { n }, n, cimag(m) > 0, cabs(m - 1) < MIE_NEAR };
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

static double norm2(double complex z)
{
	return creal(z) * creal(z) + cimag(z) * cimag(z);
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

double mie_error_of_sums(double x, const struct mie_sums *s)
{
	/* The largest coefficient is about (4/9) |m-1| x^3 where x is small, |m-1| x where it is large and m near 1. */
	double contrast = fmin(1, sqrt(s->top) / fmin(1, 4.0 / 9 * x * x * x) / fmax(1, x));
	return 2 * DBL_EPSILON * (10 + x + 1 / contrast);
}

static struct mie_sums sums_of(int lossless, int n, const double complex *a, const double complex *b)
{
	struct solved q = { { 0 }, { 0 }, { 0 }, { 0 }, { 0 }, { 0 } };
	struct spheres s = { .absorb = !lossless };
	double old_a[2] = { 0, 0 }, old_b[2] = { 0, 0 };
	for (int l = 1; l <= n; l++) {
		double al[2] = { creal(a[l]), cimag(a[l]) }, bl[2] = { creal(b[l]), cimag(b[l]) };
		solved_add(&q, &s, l, 0, al, bl, old_a, old_b);
		memcpy(old_a, al, sizeof al);
		memcpy(old_b, bl, sizeof bl);
	}
	return (struct mie_sums){ q.ext[0], q.sca[0], q.asym[0], q.back_re[0], q.back_im[0], q.top[0] };
}

struct efficiencies mie_efficiencies(double x, int lossless, int n, const double complex *a, const double complex *b)
{
	struct mie_sums s = sums_of(lossless, n, a, b);
	return mie_of_sums(x, lossless, &s);
}

double mie_error(double x, int lossless, int n, const double complex *a, const double complex *b)
{
	struct mie_sums s = sums_of(lossless, n, a, b);
	return mie_error_of_sums(x, &s);
}

#define ANGLES 32

/* Sums over l of s_l (pi_l + tau_l) and d_l (pi_l - tau_l) in ANGLES angles at once, theta in [0, 90] deg given by
 * c = 1 - cos theta. s, d, re and im apart, have the factor (2l+1)/(l(l+1)) in them.
 *
 * pi_l is carried with the difference v_l = pi_l - pi_{l-1} (after Wiscombe 1979, with mu = 1 - c put in), so that c counts
 * with all its digits: v_{l+1} = ((l+1) v_l - (2l+1) c pi_l)/l, pi_l + tau_l = (l+1) v_l - l c pi_l. */
static void sums(int n, const double *restrict sr, const double *restrict si, const double *restrict dr, const double *restrict di,
                 const double *restrict c, double out[restrict 4][ANGLES])
{
	double p[ANGLES], v[ANGLES], s0[ANGLES], s1[ANGLES], s2[ANGLES], s3[ANGLES];
	for (int i = 0; i < ANGLES; i++) {
		p[i] = v[i] = 1;
		s0[i] = s1[i] = s2[i] = s3[i] = 0;
	}
	for (int l = 1; l <= n; l++) {
		double f = l, f1 = l + 1.0, k1 = f1 / f, k2 = (2 * f + 1) / f, xr = sr[l], xi = si[l], yr = dr[l], yi = di[l];
#pragma omp simd
		for (int i = 0; i < ANGLES; i++) {
			double cp = c[i] * p[i], u = f1 * v[i] - f * cp, w = 2 * p[i] - u;
			s0[i] += xr * u;
			s1[i] += xi * u;
			s2[i] += yr * w;
			s3[i] += yi * w;
			v[i] = k1 * v[i] - k2 * cp;
			p[i] += v[i];
		}
	}
	for (int i = 0; i < ANGLES; i++) {
		out[0][i] = s0[i];
		out[1][i] = s1[i];
		out[2][i] = s2[i];
		out[3][i] = s3[i];
	}
}

int mie_amplitudes(int n, const double complex *a, const double complex *b, int ntheta, const double *theta,
                   double complex *s1, double complex *s2)
{
	size_t size = (size_t)n + 1;
	double *k = malloc(8 * size * sizeof *k);
	int *order = malloc((size_t)ntheta * sizeof *order);
	if (!k || !order) {
		free(k);
		free(order);
		return -1;
	}
	/* S1 + S2 = sum s (pi + tau), S1 - S2 = sum d (pi - tau). Behind 90 deg, with theta' = 180 - theta, pi + tau becomes
	 * (-1)^(l-1) (pi - tau) and the two sums change places. */
	for (int l = 1; l <= n; l++) {
		double w = (2.0 * l + 1) / (l * (l + 1.0)), back = l % 2 ? w : -w;
		double complex s = a[l] + b[l], d = a[l] - b[l];
		const double value[8] = { w * creal(s), w * cimag(s), w * creal(d), w * cimag(d),
		                          back * creal(d), back * cimag(d), back * creal(s), back * cimag(s) };
		for (int j = 0; j < 8; j++)
			k[(size_t)j * size + (size_t)l] = value[j];
	}
	/* Angles of the front half first: a block of lanes has one kind. */
	int nfront = 0, at = 0;
	for (int i = 0; i < ntheta; i++)
		if (theta[i] <= 90)
			order[nfront++] = i;
	at = nfront;
	for (int i = 0; i < ntheta; i++)
		if (!(theta[i] <= 90))
			order[at++] = i;
	int front_blocks = (nfront + ANGLES - 1) / ANGLES, blocks = front_blocks + (ntheta - nfront + ANGLES - 1) / ANGLES;
#pragma omp parallel for schedule(dynamic) if ((double)n * ntheta > 1e6)
	for (int block = 0; block < blocks; block++) {
		int behind = block >= front_blocks;
		int first = behind ? nfront + (block - front_blocks) * ANGLES : block * ANGLES, end = behind ? ntheta : nfront;
		int lanes = end - first < ANGLES ? end - first : ANGLES;
		const double *q = k + (behind ? 4 * size : 0);
		double c[ANGLES] = { 0 }, out[4][ANGLES];
		for (int i = 0; i < lanes; i++) {
			double t = theta[order[first + i]], h = sin((behind ? 180 - t : t) * (M_PI / 360));
			c[i] = 2 * h * h;
		}
		sums(n, q, q + size, q + 2 * size, q + 3 * size, c, out);
		for (int i = 0; i < lanes; i++) {
			double complex u = CMPLX(out[0][i], out[1][i]), w = CMPLX(out[2][i], out[3][i]);
			s1[order[first + i]] = (u + w) / 2;
			s2[order[first + i]] = (behind ? w - u : u - w) / 2;
		}
	}
	free(k);
	free(order);
	return 0;
}

#include "optics/mie.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Symbols. psi_l, chi_l, xi_l = psi_l - i chi_l Riccati-Bessel functions with psi_0 = sin, chi_0 = cos;
 * y = m x; E_l(z) = -psi_{l+1}(z)/psi_l(z), so that D_l(z) = psi_l'(z)/psi_l(z) = E_l(z) + (l+1)/z.
 *
 * With a_l = A/(A - iC), A = f psi_l - psi_{l-1}, C = f chi_l - chi_{l-1}, f = D_l(y)/m + l/x (m D_l(y) + l/x for b_l;
 * Bohren and Huffman 1983, eq 4.88), and the Wronskian psi_l chi_{l-1} - psi_{l-1} chi_l = -1,
 *
 *     a_l = (|A|^2 - Im f + i Re(A* C)) / (|A|^2 + |C|^2 - 2 Im f),    Im f <= 0.
 *
 * Every sum here but Re(A* C) has terms of one sign: extinction by a weak absorber is not lost, and Re a_l >= |a_l|^2 holds.
 * E in place of D removes the terms (l+1)/z which cancel in b_l where z is small, so that no separate series is needed there. */

int mie_terms(double x, double complex m)
{
	double edge = cbrt(x), y = cabs(m) * x;
	double n = x + 7 * edge + 8;                  /* psi_l / chi_l < 1e-16 */
	double resonant = fmin(y + 2, x + 12 * edge + 10);   /* < 1e-32: not even a resonance can lift it */
	return (int)ceil(fmax(n, resonant));
}

/* First order of the downward recurrence that leaves no trace at order n (rounding included) of its start with 0. */
static int start(int n, double y)
{
	return (int)ceil(fmax(n, y)) + 16 + (int)(8 * cbrt(y));
}

/* E_l(z), l = 0 .. n, downward: E_{l-1} = -1 / ((2l+1)/z + E_l); z real. */
static void ratios_real(int n, double z, double *e)
{
	double inv = 1 / z, v = 0;
	for (int l = start(n, z); l > 0; l--) {
		double t = (2.0 * l + 1) * inv + v;
		v = -1 / (t != 0 ? t : DBL_MIN);      /* a zero of psi_{l-1}; the next step brings it back */
		if (l - 1 <= n)
			e[l - 1] = v;
	}
}

/* The same for complex z. */
static void ratios(int n, double complex z, double *er, double *ei)
{
	double zr = creal(z), zi = cimag(z), z2 = zr * zr + zi * zi, vr = 0, vi = 0;
	double ir = zr / z2, ii = -zi / z2;
	for (int l = start(n, sqrt(z2)); l > 0; l--) {
		double k = 2.0 * l + 1, tr = k * ir + vr, ti = k * ii + vi, t2 = tr * tr + ti * ti;
		double s = 1 / (t2 > DBL_MIN ? t2 : DBL_MIN);
		vr = -tr * s;
		vi = ti * s;
		if (l - 1 <= n) {
			er[l - 1] = vr;
			ei[l - 1] = vi;
		}
	}
}

/* The Riccati-Bessel functions of x at two neighbouring orders: old is l - 1. */
struct bessel {
	double psi_old, psi, chi_old, chi;
};

static struct bessel bessel_start(double x)
{
	return (struct bessel){ cos(x), sin(x), -sin(x), cos(x) };    /* orders -1 and 0 */
}

/* psi upward while l < x, by ratios beyond (upward it would be lost there; ratios fail where psi passes a zero); chi upward. */
static void bessel_step(struct bessel *s, int l, double x, double inv_x, double ex_old)
{
	double k = (2.0 * l - 1) * inv_x;
	double psi = l < x ? k * s->psi - s->psi_old : -ex_old * s->psi;
	double chi = k * s->chi - s->chi_old;
	s->psi_old = s->psi;
	s->psi = psi;
	s->chi_old = s->chi;
	s->chi = chi;
}

#define CHI_MAX 1e140    /* beyond, a_l and b_l are below 1e-280 and chi^2 would overflow */

static void zero_from(int l, int n, double complex *a, double complex *b)
{
	for (; l <= n; l++)
		a[l] = b[l] = 0;
}

static void solve_real(double x, double m, int n, const double *ex, const double *ey, double complex *a, double complex *b)
{
	double inv_x = 1 / x, inv_m = 1 / m, c = (1 - m) * (1 + m) * inv_m * inv_m;    /* 1/m^2 - 1 */
	struct bessel s = bessel_start(x);
	for (int l = 1; l <= n; l++) {
		bessel_step(&s, l, x, inv_x, ex[l - 1]);
		if (fabs(s.chi) > CHI_MAX) {
			zero_from(l, n, a, b);
			return;
		}
		/* f psi_l - psi_{l-1}; beyond x with psi_{l-1}/psi_l = E_l(x) + (2l+1)/x taken off f by hand */
		double w = (l + 1) * inv_x * c, k = (2.0 * l + 1) * inv_x;
		double ga = ey[l] * inv_m + w, gb = ey[l] * m;
		double A = l < x ? (ga + k) * s.psi - s.psi_old : (ga - ex[l]) * s.psi;
		double B = l < x ? (gb + k) * s.psi - s.psi_old : (gb - ex[l]) * s.psi;
		double C = (ga + k) * s.chi - s.chi_old, D = (gb + k) * s.chi - s.chi_old;
		double ra = 1 / (A * A + C * C), rb = 1 / (B * B + D * D);
		a[l] = CMPLX(A * A * ra, A * C * ra);
		b[l] = CMPLX(B * B * rb, B * D * rb);
	}
}

/* One coefficient from g = f - (2l+1)/x. */
static double complex coefficient(double gr, double gi, double k, double ex, int inside, const struct bessel *s)
{
	double ar = inside ? (gr + k) * s->psi - s->psi_old : (gr - ex) * s->psi, ai = gi * s->psi;
	double cr = (gr + k) * s->chi - s->chi_old, ci = gi * s->chi;
	double a2 = ar * ar + ai * ai, r = 1 / (a2 + cr * cr + ci * ci - 2 * gi);
	return CMPLX((a2 - gi) * r, (ar * cr + ai * ci) * r);
}

static void solve(double x, double complex m, int n, const double *ex, const double *er, const double *ei,
                  double complex *a, double complex *b)
{
	double mr = creal(m), mi = cimag(m), m2 = mr * mr + mi * mi, inv_x = 1 / x;
	double vr = mr / m2, vi = -mi / m2;                    /* 1/m */
	double v2r = vr * vr - vi * vi, v2i = 2 * vr * vi;
	double cr = ((1 - mr) * (1 + mr) + mi * mi) * v2r + 2 * mr * mi * v2i, ci = v2i;    /* 1/m^2 - 1 = (1 - m^2)/m^2 */
	struct bessel s = bessel_start(x);
	for (int l = 1; l <= n; l++) {
		bessel_step(&s, l, x, inv_x, ex[l - 1]);
		if (fabs(s.chi) > CHI_MAX) {
			zero_from(l, n, a, b);
			return;
		}
		double w = (l + 1) * inv_x, k = (2.0 * l + 1) * inv_x;
		a[l] = coefficient(er[l] * vr - ei[l] * vi + w * cr, er[l] * vi + ei[l] * vr + w * ci, k, ex[l], l < x, &s);
		b[l] = coefficient(er[l] * mr - ei[l] * mi, er[l] * mi + ei[l] * mr, k, ex[l], l < x, &s);
	}
}

int mie_coefficients(double x, double complex m, int n, double complex *a, double complex *b)
{
	size_t size = (size_t)n + 1;
	double *e = malloc(3 * size * sizeof *e), *ex = e, *er = e + size, *ei = e + 2 * size;
	if (!e)
		return -1;
	a[0] = b[0] = 0;
	ratios_real(n, x, ex);
	if (cimag(m) == 0) {
		ratios_real(n, creal(m) * x, er);
		solve_real(x, creal(m), n, ex, er, a, b);
	} else {
		ratios(n, CMPLX(creal(m) * x, cimag(m) * x), er, ei);
		solve(x, m, n, ex, er, ei, a, b);
	}
	free(e);
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

struct efficiencies mie_efficiencies(double x, int lossless, int n, const double complex *a, const double complex *b)
{
	double ext = 0, sca = 0, asym = 0, back_re = 0, back_im = 0;
	for (int l = 1; l <= n; l++) {
		double w = 2.0 * l + 1, sign = l % 2 ? -w : w;
		ext += w * (creal(a[l]) + creal(b[l]));
		sca += w * (norm2(a[l]) + norm2(b[l]));
		asym += w / (l * (l + 1.0)) * (creal(a[l]) * creal(b[l]) + cimag(a[l]) * cimag(b[l]));
		if (l < n)
			asym += l * (l + 2.0) / (l + 1.0) * (creal(a[l]) * creal(a[l + 1]) + cimag(a[l]) * cimag(a[l + 1]) +
			                                     creal(b[l]) * creal(b[l + 1]) + cimag(b[l]) * cimag(b[l + 1]));
		back_re += sign * (creal(a[l]) - creal(b[l]));
		back_im += sign * (cimag(a[l]) - cimag(b[l]));
	}
	if (lossless || sca > ext)    /* greater by rounding alone: Re a >= |a|^2 */
		sca = ext;
	struct efficiencies q;
	q.ext = 2 / (x * x) * ext;
	q.sca = 2 / (x * x) * sca;
	q.abs = q.ext - q.sca;
	q.g = 2 * asym / sca;
	q.back = (back_re * back_re + back_im * back_im) / (x * x);    /* S1(180 deg) = sum (2l+1) (-1)^l (b - a) / 2 */
	return q;
}

double mie_error(double x, int n, const double complex *a, const double complex *b)
{
	double top = 0;
	for (int l = 1; l <= n; l++)
		top = fmax(top, fmax(norm2(a[l]), norm2(b[l])));
	/* The largest coefficient is about (4/9) |m-1| x^3 where x is small, |m-1| x where it is large and m near 1. */
	double contrast = fmin(1, sqrt(top) / fmin(1, 4.0 / 9 * x * x * x) / fmax(1, x));
	return 2 * DBL_EPSILON * (10 + x + 1 / contrast);
}

#define LANES 32

/* Sums over l of s_l (pi_l + tau_l) and d_l (pi_l - tau_l) in LANES angles at once, theta in [0, 90] deg given by
 * c = 1 - cos theta. s, d, re and im apart, have the factor (2l+1)/(l(l+1)) in them.
 *
 * pi_l is carried with the difference v_l = pi_l - pi_{l-1} (after Wiscombe 1979, with mu = 1 - c put in), so that c counts
 * with all its digits: v_{l+1} = ((l+1) v_l - (2l+1) c pi_l)/l, pi_l + tau_l = (l+1) v_l - l c pi_l. */
static void sums(int n, const double *restrict sr, const double *restrict si, const double *restrict dr, const double *restrict di,
                 const double *restrict c, double out[restrict 4][LANES])
{
	double p[LANES], v[LANES], s0[LANES], s1[LANES], s2[LANES], s3[LANES];
	for (int i = 0; i < LANES; i++) {
		p[i] = v[i] = 1;
		s0[i] = s1[i] = s2[i] = s3[i] = 0;
	}
	for (int l = 1; l <= n; l++) {
		double f = l, f1 = l + 1.0, k1 = f1 / f, k2 = (2 * f + 1) / f, xr = sr[l], xi = si[l], yr = dr[l], yi = di[l];
#pragma omp simd
		for (int i = 0; i < LANES; i++) {
			double cp = c[i] * p[i], u = f1 * v[i] - f * cp, w = 2 * p[i] - u;
			s0[i] += xr * u;
			s1[i] += xi * u;
			s2[i] += yr * w;
			s3[i] += yi * w;
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
	int front_blocks = (nfront + LANES - 1) / LANES, blocks = front_blocks + (ntheta - nfront + LANES - 1) / LANES;
#pragma omp parallel for schedule(dynamic) if ((double)n * ntheta > 1e6)
	for (int block = 0; block < blocks; block++) {
		int behind = block >= front_blocks;
		int first = behind ? nfront + (block - front_blocks) * LANES : block * LANES, end = behind ? ntheta : nfront;
		int lanes = end - first < LANES ? end - first : LANES;
		const double *q = k + (behind ? 4 * size : 0);
		double c[LANES] = { 0 }, out[4][LANES];
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

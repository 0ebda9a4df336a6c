#include "optics/mie/mie_host.h"

#include "optics/mie/mie_lanes.h"

#define LANES 1
#define UNROLL 1
#include "optics/mie/mie_coefficients.h"

#include <stdlib.h>
#include <string.h>

#define DEEP 1    /* beta from which on chi, of the order of e^(beta/2), hides xi = psi - i chi */

double mie_host_gamma(double beta)
{
	if (beta >= 0.1)
		return 2 * (beta + expm1(-beta)) / (beta * beta);
	double sum = 0;
	for (int j = 10; j >= 0; j--)    /* 2 sum (-beta)^j / (j+2)! */
		sum = (1 - sum * beta) / (j + 2);
	return 2 * sum;
}

int mie_host_terms(double complex x, double complex m)
{
	double size = cabs(x);
	double complex y = m * x;
	return mie_terms(size, CMPLX(creal(y) / size, fmax(0, cimag(y)) / size));
}

/* 1/z, each part to its own last digits; a zero of Bessel functions met to the last bit becomes a near miss. */
static double complex inverse(double complex z)
{
	if (z == 0)
		z = 1e-20;
	double r = norm2(z);
	return CMPLX(creal(z) / r, -cimag(z) / r);
}

/* i z */
static double complex turned(double complex z) { return CMPLX(-cimag(z), creal(z)); }

/* E_l(x) (of mie_coefficients.h), and E_l(y), or where m is near 1 their difference d_l, for 0 <= l <= n. */
static void ratios(double complex x, double complex m, int n, int near, double complex rise, double complex *ex, double complex *e)
{
	double complex y = m * x, inv_x = inverse(x), inv_y = inverse(y), at_x = 0, at_y = 0, d = 0;
	int top_x = ratio_downward_start(n, creal(x), cimag(x)), top_y = ratio_downward_start(n, creal(y), cimag(y));
	for (int l = top_x > top_y ? top_x : top_y; l >= 1; l--) {
		double k = 2.0 * l + 1;
		at_x = -inverse(k * inv_x + at_x);
		at_y = -inverse(k * inv_y + at_y);
		if (near)
			d = (k * rise + d) * (at_x * at_y);
		if (l - 1 > n)
			continue;
		ex[l - 1] = at_x;
		e[l - 1] = near ? d : at_y;
	}
}

/* a = A / (A - iC), C far greater than A where the wave is weak: Re a = [|A|^2 + Im(A* C)] / |A - iC|^2 without Im a's terms in it. */
static double complex shallow_wave(double complex A, double complex C)
{
	double r = norm2(A - turned(C)), ar = creal(A), ai = cimag(A), cr = creal(C), ci = cimag(C);
	return CMPLX((norm2(A) + (ar * ci - ai * cr)) / r, (ar * cr + ai * ci) / r);
}

int mie_host_coefficients(double complex x, double complex m, int n, double complex *a, double complex *b)
{
	double complex *ex = malloc(2 * ((size_t)n + 2) * sizeof *ex), *e = ex + n + 2;
	if (!ex)
		return -1;
	int near = mie_near(m), deep = 2 * cimag(x) >= DEEP;
	double size = cabs(x);
	double complex inv_x = inverse(x), inv_m = inverse(m), m_1 = CMPLX(creal(m) - 1, cimag(m));
	double complex less = -(m_1 * inv_m), c = less * (1 + inv_m) * inv_x;    /* 1/m - 1, (1/m^2 - 1)/x */
	ratios(x, m, n, near, less * inv_x, ex, e);
	/* Outgoing waves: chi while it holds xi, and keeps real what is real for a real x; else xi. */
	double complex psi_old = ccos(x), psi = csin(x), out_old = deep ? cexp(turned(x)) : -psi, out = deep ? -turned(out_old) : psi_old;
	memset(a, 0, ((size_t)n + 1) * sizeof *a);
	memset(b, 0, ((size_t)n + 1) * sizeof *b);
	for (int l = 1; l <= n; l++) {
		int outside = l >= size;
		double complex w = (2.0 * l - 1) * inv_x, t = (2.0 * l + 1) * inv_x, next = w * out - out_old;
		out_old = out;
		out = next;
		if (norm2(out) > CHI_MAX * CHI_MAX)
			break;
		if (deep) {    /* upward psi would be lost in xi, downward psi_0 is large: psi_l xi_{l-1} - psi_{l-1} xi_l = i is at hand */
			psi = turned(inverse(out_old - out * (ex[l] + t)));
		} else {
			next = outside ? -(ex[l - 1] * psi) : w * psi - psi_old;
			psi_old = psi;
			psi = next;
		}
		double complex ey = near ? ex[l] + e[l] : e[l], rest = (l + 1.0) * c, fa = ey * inv_m + rest + t, fb = ey * m + t;
		double complex p = near ? e[l] * inv_m + ex[l] * less + rest : ey * inv_m - ex[l] + rest;    /* f - psi_{l-1}/psi_l */
		double complex q = near ? e[l] * m + ex[l] * m_1 : ey * m - ex[l];
		double complex A = deep || outside || (near && norm2(p) < 1) ? p * psi : fa * psi - psi_old;
		double complex B = deep || outside || (near && norm2(q) < 1) ? q * psi : fb * psi - psi_old;
		double complex C = fa * out - out_old, D = fb * out - out_old;
		a[l] = deep ? A * inverse(C) : shallow_wave(A, C);
		b[l] = deep ? B * inverse(D) : shallow_wave(B, D);
	}
	free(ex);
	return 0;
}

/* e^(-beta) / gamma, the factor of eq 29. */
static double per_incident(double complex x)
{
	double beta = 2 * cimag(x);
	return exp(-2 * beta) / mie_host_gamma(beta);
}

struct efficiencies mie_host_efficiencies(double complex x, int n, const double complex *a, const double complex *b, double *error)
{
	struct mie_sums q;
	double ext_im = 0, bulk_re = 0, bulk_im = 0, x2 = norm2(x), of_x = per_incident(x);
	mie_sums_of(0, n, a, b, &q);
	for (int l = 1; l <= n; l++) {
		double w = 2.0 * l + 1;
		ext_im += w * (cimag(a[l]) + cimag(b[l]));
		bulk_re += w * (fabs(creal(a[l])) + fabs(creal(b[l])));
		bulk_im += w * (fabs(cimag(a[l])) + fabs(cimag(b[l])));
	}
	/* Re[S / x^2] = Re[S conj(x^2)] / |x|^4, S = 2 S(0) */
	double re = (creal(x) - cimag(x)) * (creal(x) + cimag(x)), im = 2 * creal(x) * cimag(x), ext = q.ext * re + ext_im * im;
	struct efficiencies out = {
		.ext = 2 / (x2 * x2) * ext,
		.sca = 2 / x2 * of_x * q.sca,
		.g = 2 * q.asym / q.sca,
		.back = of_x / x2 * (q.back_re * q.back_re + q.back_im * q.back_im),
	};
	out.abs = out.ext - out.sca;
	if (error) {
		struct mie_sums as_real = { .sca = out.sca * x2 / 2 };
		*error = mie_sums_error(sqrt(x2), 0, &as_real) * fmax(1, (bulk_re * fabs(re) + bulk_im * im) / fabs(ext));
	}
	return out;
}

double mie_host_norm(double complex x, double sca)
{
	return M_PI * norm2(x) * sca / per_incident(x);
}

/* fourier - discrete Fourier transform of two complex sequences at once, radix 4 and what is left of 2 and 3, in the order of
 * Stockham (self-sorting: every stage writes what the next reads in rows). */
#ifndef OPTICS_KERN_FOURIER_H
#define OPTICS_KERN_FOURIER_H

#include "optics/numerics/kern/wide.h"

#include <math.h>

struct complex_wide {
	wide re, im;
};

/* fourier_waves - wave[k] = exp(2 pi i k / n) in pairs, n a multiple of 8; by the first octant, where
 * arguments are least off. */
static void fourier_waves(int n, double *wave)
{
	int quarter = n / 4;
	for (int k = 0; k <= n / 8; k++) {
		double a = 2 * M_PI * k / n;
		wave[2 * k] = wave[2 * (quarter - k) + 1] = cos(a);
		wave[2 * k + 1] = wave[2 * (quarter - k)] = sin(a);
	}
	for (int k = quarter; k < n; k++) {
		wave[2 * k] = -wave[2 * (k - quarter) + 1];
		wave[2 * k + 1] = wave[2 * (k - quarter)];
	}
}

static inline struct complex_wide load(const double *re, const double *im, long at)
{
	return (struct complex_wide){ wide_load(re + at), wide_load(im + at) };
}

static inline struct complex_wide turn(struct complex_wide a, wide c, wide s)    /* a (c + i s) */
{
	return (struct complex_wide){ a.re * c - a.im * s, a.im * c + a.re * s };
}

/* Four points to four frequencies, exp(+2 pi i ..). */
static inline void butterfly(const struct complex_wide a[4], struct complex_wide out[4])
{
	wide pr = a[0].re + a[2].re, pi = a[0].im + a[2].im, mr = a[0].re - a[2].re, mi = a[0].im - a[2].im;
	wide qr = a[1].re + a[3].re, qi = a[1].im + a[3].im, nr = a[1].re - a[3].re, ni = a[1].im - a[3].im;
	out[0] = (struct complex_wide){ pr + qr, pi + qi };
	out[1] = (struct complex_wide){ mr - ni, mi + nr };
	out[2] = (struct complex_wide){ pr - qr, pi - qi };
	out[3] = (struct complex_wide){ mr + ni, mi - nr };
}

/* The first stage, where the two sequences alone stand side by side: four points abreast. re, im [2 n], n a multiple of 16. */
static void fourier_first(int n, const double *wave, const double *re, const double *im, double *to_re, double *to_im)
{
	int m = n / 4;
	for (int p = 0; p < m; p += 4) {
		struct complex_wide a[4], b[4];
		double c[8], s[8], x[8], y[8];
		for (int k = 0; k < 4; k++)
			a[k] = load(re, im, 2 * (p + (long)k * m));
		butterfly(a, b);
		for (int k = 0; k < 4; k++) {
			for (int i = 0; i < 4; i++) {
				c[2 * i] = c[2 * i + 1] = wave[2 * k * (p + i)];
				s[2 * i] = s[2 * i + 1] = wave[2 * k * (p + i) + 1];
			}
			b[k] = turn(b[k], wide_load(c), wide_load(s));
			wide_store(x, b[k].re);
			wide_store(y, b[k].im);
			for (int i = 0; i < 4; i++) {
				memcpy(to_re + 2 * (4 * (p + i) + k), x + 2 * i, 2 * sizeof *x);
				memcpy(to_im + 2 * (4 * (p + i) + k), y + 2 * i, 2 * sizeof *y);
			}
		}
	}
}

/* A later stage: n points of radix r in rows of s, wave[] in steps of step. */
static inline void fourier_stage(int r, int n, int s, int step, const double *wave, const double *re, const double *im,
                                 double *to_re, double *to_im)
{
	int m = n / r;
	for (int p = 0; p < m; p++)
		for (int q = 0; q < s; q += 8) {
			struct complex_wide a[4], b[4];
			for (int k = 0; k < r; k++)
				a[k] = load(re, im, q + (long)s * (p + k * m));
			if (r == 4) {
				butterfly(a, b);
			} else if (r == 2) {
				b[0] = (struct complex_wide){ a[0].re + a[1].re, a[0].im + a[1].im };
				b[1] = (struct complex_wide){ a[0].re - a[1].re, a[0].im - a[1].im };
			} else {
				wide sr = a[1].re + a[2].re, si = a[1].im + a[2].im, h = wide_of(sqrt(0.75));
				wide dr = (a[1].re - a[2].re) * h, di = (a[1].im - a[2].im) * h;
				wide mr = a[0].re - 0.5 * sr, mi = a[0].im - 0.5 * si;
				b[0] = (struct complex_wide){ a[0].re + sr, a[0].im + si };
				b[1] = (struct complex_wide){ mr - di, mi + dr };
				b[2] = (struct complex_wide){ mr + di, mi - dr };
			}
			for (int k = 0; k < r; k++) {
				const double *w = wave + 2 * (long)k * p * step;
				struct complex_wide c = k ? turn(b[k], wide_of(w[0]), wide_of(w[1])) : b[0];
				wide_store(to_re + q + (long)s * (r * p + k), c.re);
				wide_store(to_im + q + (long)s * (r * p + k), c.im);
			}
		}
}

/* fourier - out_j = sum_k in_k exp(2 pi i j k / n), j, k = 0 .. n-1, for two sequences: the two values of a point stand together
 * in re[2 n] and im[2 n], other real and imaginary room of the same size. n = 16 2^a 3^b; wave[k] = exp(2 pi i k / n) in pairs.
 * Returns which of the two rooms has the result: 0 or 1. */
static int fourier(int n, const double *wave, double *re[2], double *im[2])
{
	int at = 1, left = n / 4, s = 8;
	fourier_first(n, wave, re[0], im[0], re[1], im[1]);
	while (left > 1) {
		int step = n / left;
		if (left % 4 == 0)
			fourier_stage(4, left, s, step, wave, re[at], im[at], re[!at], im[!at]);
		else if (left % 3 == 0)
			fourier_stage(3, left, s, step, wave, re[at], im[at], re[!at], im[!at]);
		else
			fourier_stage(2, left, s, step, wave, re[at], im[at], re[!at], im[!at]);
		int r = left % 4 == 0 ? 4 : left % 3 == 0 ? 3 : 2;
		left /= r;
		s *= r;
		at = !at;
	}
	return at;
}

#endif

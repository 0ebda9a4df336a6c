#include "optics/mie/mie_fast_amplitudes.h"

#include <stdlib.h>

struct legendre_series *mie_fast_amplitudes_new(int n, const double complex *a, const double complex *b)
{
	double (*c)[LEGENDRE_SERIES_SUMS] = malloc(((size_t)n + 1) * sizeof *c);
	if (!c)
		return NULL;
	double complex x1 = 0, x2 = 0;
	for (int k = n; k >= 0; k--) {
		double h = 2.0 * k + 1, own = k / (k + 1.0), w = k ? h / (k * (k + 1.0)) : 0;
		double complex s1 = h * (own * b[k] + x1), s2 = h * (own * a[k] + x2), next1 = w * a[k] - x2;
		x2 = w * b[k] - x1;
		x1 = next1;
		c[k][0] = creal(s1);
		c[k][1] = cimag(s1);
		c[k][2] = creal(s2);
		c[k][3] = cimag(s2);
	}
	struct legendre_series *s = legendre_series_new(n, c);
	free(c);
	return s;
}

#define BLOCK 1024

void mie_fast_amplitudes_at(const struct legendre_series *s, int ntheta, const double *theta,
                            double complex *s1, double complex *s2)
{
#pragma omp parallel for schedule(static) if (ntheta > 16 * BLOCK)
	for (int from = 0; from < ntheta; from += BLOCK) {
		double v[BLOCK][LEGENDRE_SERIES_SUMS];
		int count = ntheta - from < BLOCK ? ntheta - from : BLOCK;
		legendre_series_at(s, count, theta + from, v);
		for (int i = 0; i < count; i++) {
			s1[from + i] = CMPLX(v[i][0], v[i][1]);
			s2[from + i] = CMPLX(v[i][2], v[i][3]);
		}
	}
}

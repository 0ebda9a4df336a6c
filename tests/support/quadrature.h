/* Integrals over angles, for the tests. */
#ifndef SUPPORT_QUADRATURE_H
#define SUPPORT_QUADRATURE_H

#include <math.h>

/* Integral of f sin theta over [0, pi] from n equal angles, exact for polynomials in cos theta of degree < n. */
static inline double clenshaw_curtis(int n, const double *f)
{
	int steps = n - 1;
	double sum = 0;
	for (int k = 0; k <= steps; k += 2) {
		double c = 0;    /* cosine coefficient of f */
		for (int i = 0; i <= steps; i++)
			c += (i == 0 || i == steps ? 0.5 : 1) * f[i] * cos(M_PI * (double)((long)i * k % (2 * steps)) / steps);
		sum += (k == 0 || k == steps ? 0.5 : 1) * (2.0 / steps) * c * 2 / (1 - (double)k * k);
	}
	return sum;
}

#endif

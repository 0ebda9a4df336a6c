#include "medium/rng.h"

#include <math.h>

/* ln of mean^k e^-mean / k!, without the cancellation between its terms when k is near a large mean. */
static double log_pmf(double k, double mean)
{
	if (k < 10) {
		double sum = k * log(mean) - mean;
		for (int i = 2; i <= k; i++)
			sum -= log(i);
		return sum;
	}
	double d = (k - mean) / mean, kk = k * k;
	double stirling = (1.0 / 12 - (1.0 / 360 - (1.0 / 1260 - 1.0 / 1680 / kk) / kk) / kk) / k;
	return -mean * ((1 + d) * log1p(d) - d) - 0.5 * log(2 * 3.14159265358979323846 * k) - stirling;
}

/* Small means: multiply uniform numbers until they fall below e^-mean. Others: transformed rejection with squeeze, PTRS of
 * W. Hormann, The transformed rejection method for generating Poisson random variables, Insurance: Math. Econ. 12, 39 (1993). */
double rng_poisson(double mean, uint64_t seed, uint64_t stream)
{
	uint32_t w[4];
	if (mean < 10) {
		double floor_ = exp(-mean), product = 1;
		for (uint64_t k = 0;; k++) {
			rng_block(seed, k, stream, w);
			product *= 1 - rng_unit53(w[0], w[1]);
			if (product <= floor_)
				return (double)k;
		}
	}
	double b = 0.931 + 2.53 * sqrt(mean), a = -0.059 + 0.02483 * b;
	double inv_alpha = 1.1239 + 1.1328 / (b - 3.4), squeeze = 0.9277 - 3.6224 / (b - 2);
	for (uint64_t i = 0;; i++) {
		rng_block(seed, i, stream, w);
		double u = rng_unit53(w[0], w[1]) - 0.5, v = 1 - rng_unit53(w[2], w[3]), us = 0.5 - fabs(u);
		double k = floor((2 * a / us + b) * u + mean + 0.43);
		if (us >= 0.07 && v <= squeeze)
			return k;
		if (!(k >= 0) || (us < 0.013 && v > us))
			continue;
		if (log(v * inv_alpha / (a / (us * us) + b)) <= log_pmf(k, mean))
			return k;
	}
}

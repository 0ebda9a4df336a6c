/* Random numbers: published vectors of the generator; Poisson numbers against their distribution; densities of a grid.
 * Seeds are fixed; with others a false alarm of any one test would have a chance below 1e-5. */
#include "medium/density.h"
#include "medium/rng.h"
#include "support/tap.h"

#include <math.h>
#include <string.h>

#define DRAWS 40000
#define Z 4.8                    /* standard deviations; two-sided chance 1.6e-6 */

static void vector(uint64_t seed, uint64_t counter, uint64_t stream, const uint32_t want[4])
{
	uint32_t got[4];
	rng_block(seed, counter, stream, got);
	ok(!memcmp(got, want, sizeof got), "Philox4x32-10: %08x %08x %08x %08x", got[0], got[1], got[2], got[3]);
}

/* Mean and variance of many numbers, in standard deviations of each. */
static void spread(double mean)
{
	double sum = 0, square = 0;
	for (int i = 0; i < DRAWS; i++) {
		double d = rng_poisson(mean, (uint64_t)i, 1) - mean;
		sum += d;
		square += d * d;
	}
	double z1 = sum / sqrt(DRAWS * mean), z2 = (square / DRAWS - mean) / sqrt((mean + 2 * mean * mean) / DRAWS);
	ok(fabs(z1) < Z && fabs(z2) < Z, "Poisson, mean %g: mean off by %.2f, variance by %.2f standard deviations", mean, z1, z2);
}

/* Chi-square of the numbers drawn, one bin for each k from lo to hi, the ends open. */
static void histogram(double mean)
{
	static double count[4000];
	double w = 4 * sqrt(mean);
	int lo = (int)fmax(0, floor(mean - w)), hi = (int)ceil(mean + w), dof = -1;
	double chi = 0, expected = 0, seen = 0, covered = 0;
	memset(count, 0, sizeof count);
	for (int i = 0; i < DRAWS; i++) {
		double k = fmin(fmax(rng_poisson(mean, (uint64_t)i, 2), lo), hi);
		count[(int)k - lo]++;
	}
	for (int k = 0; k <= hi; k++) {
		double p = exp(k * log(mean) - mean - lgamma(k + 1.0));
		p = k == hi ? 1 - covered : p;
		covered += p;
		expected += DRAWS * p;
		seen += k >= lo ? count[k - lo] : 0;
		if ((expected >= 10 && DRAWS * (1 - covered) >= 10) || k == hi) {
			chi += (seen - expected) * (seen - expected) / expected;
			dof++;
			expected = seen = 0;
		}
	}
	/* Wilson and Hilferty: (chi/dof)^(1/3) is nearly normal */
	double v = 2.0 / (9 * dof), z = (cbrt(chi / dof) - (1 - v)) / sqrt(v);
	ok(dof > 0 && z < Z, "Poisson, mean %g: chi-square %.1f at %d degrees of freedom, %.2f standard deviations", mean, chi, dof, z);
}

int main(void)
{
	/* Salmon et al., Random123: known answers */
	vector(0, 0, 0, (const uint32_t[]){ 0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8 });
	vector(UINT64_MAX, UINT64_MAX, UINT64_MAX, (const uint32_t[]){ 0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd });
	vector(0x299f31d0a4093822, 0x85a308d3243f6a88, 0x0370734413198a2e, (const uint32_t[]){ 0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1 });

	static const double means[] = { 0.1, 1, 9.9, 10, 12, 50, 1e3, 1e5, 1e7, 1e9, 1e12 };
	for (size_t i = 0; i < sizeof means / sizeof *means; i++)
		spread(means[i]);
	static const double small[] = { 0.1, 1, 9.9, 10, 12, 50, 1e3, 1e5 };
	for (size_t i = 0; i < sizeof small / sizeof *small; i++)
		histogram(small[i]);

	float v[] = { 0, 1, 2, 3, 4, 5, 6, 7 };
	struct npy_grid g = { 2, 2, 2, v };
	ok(density_at(&g, 0, 0, 0) == 0 && density_at(&g, 1, 1, 1) == 7, "the border has the outer voxels' density");
	ok(density_at(&g, 0.75, 0.25, 0.25) == 1 && density_at(&g, 0.25, 0.25, 0.75) == 4, "x is the last index, z the first");
	ok(density_at(&g, 0.5, 0.5, 0.5) == 3.5, "trilinear between the centres");
	ok(density_at(&g, 0.5, 0, 0.75) == 4.5, "linear along x, constant beyond the centres");
	struct npy_grid one = { 1, 1, 1, v + 3 };
	ok(density_at(&one, 0.3, 0.9, 0.1) == 3, "one voxel is a constant");
	double sum = 0;
	for (int i = 0; i < 64000; i++)
		sum += density_at(&g, (i % 40 + 0.5) / 40, (i / 40 % 40 + 0.5) / 40, (i / 1600 + 0.5) / 40);
	ok(fabs(sum / 64000 - 3.5) < 1e-12, "the mean over the box is the mean of the voxels");
	return done_testing();
}

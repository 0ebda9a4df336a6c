/* Efficiencies of random spheres are finite and physical, however large. The counts of a test are small; --full takes 10^6, 10^4 and 100
 * spheres (minutes; under UBSan with make build/asan/tests/physics/mie_random), the measure of a change to the recurrences. */
#include "optics/mie/mie_lanes.h"
#include "support/tap.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define BATCH 1000

static uint64_t state = 7;

/* Uniform in [0, 1); the same everywhere. */
static double uniform(void)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

/* Dielectrics above and below 1, next to 1, absorbing by any degree, metals, near-perfect conductors. */
static double complex any_index(void)
{
	double re = pow(10, -1 + 2 * uniform()), im = uniform() < 0.4 ? 0 : pow(10, -12 + 13 * uniform()), kind = uniform();
	if (kind < 0.1)
		re = 1 + (uniform() < 0.5 ? -1 : 1) * pow(10, -6 * uniform() - 1);
	if (kind > 0.97)
		re = im = pow(10, 1 + 2 * uniform());
	return CMPLX(re, im);
}

/* Of n spheres with x up to most, those whose efficiencies cannot be. */
static int impossible(int n, double most)
{
	static double x[BATCH], error[BATCH];
	static double complex m[BATCH];
	static struct efficiencies q[BATCH];
	int bad = 0;
	for (int from = 0, count; from < n; from += count) {
		count = n - from < BATCH ? n - from : BATCH;
		for (int i = 0; i < count; i++) {
			m[i] = any_index();
			x[i] = most * pow(10, -11 * uniform() * uniform());    /* more of large ones */
			x[i] = fmin(fmax(x[i], 1e-8), 1e8 / cabs(m[i]));
		}
		if (mie_many(count, x, m, q, error))
			exit(2);
		for (int i = 0; i < count; i++)
			if (!(q[i].ext >= q[i].sca && q[i].sca >= 0 && q[i].abs >= 0 && fabs(q[i].g) <= 1 && q[i].back >= 0 && isfinite(q[i].ext) &&
			      isfinite(q[i].back))) {
				printf("# x = %.17g, m = %.17g+%.17gi: Q %g %g g %g back %g\n", x[i], creal(m[i]), cimag(m[i]), q[i].ext, q[i].sca,
				       q[i].g, q[i].back);
				bad++;
			}
	}
	return bad;
}

int main(int argc, char **argv)
{
	int full = argc > 1 && !strcmp(argv[1], "--full");
	const struct { double most; int few, many; } kind[] = { { 1e3, 5000, 1000000 }, { 1e5, 100, 10000 }, { 1e7, 2, 100 } };
	for (int i = 0; i < 3; i++) {
		int n = full ? kind[i].many : kind[i].few, bad = impossible(n, kind[i].most);
		ok(!bad, "%d spheres with x up to %g: %d whose efficiencies cannot be", n, kind[i].most, bad);
	}
	return done_testing();
}

/* Each order of rays against the same order of the Debye series, amplitude and phase, where rays hold: away from the edge,
 * the rainbows and the ends of the orders. */
#include "optics/goa/goa.h"

#include "support/sphere.h"
#include "support/tap.h"

#define X 1000.49

/* Over lo..hi degrees: the largest difference over the root mean square of the Debye amplitude, so that Brewster's angle and the
 * minima between two rays do no harm; the largest phase difference where the amplitude is at least half of that. */
static void compare(double complex m, int p, double lo, double hi, double *worst, double *phase)
{
	enum { N = 301 };
	int n = sphere_terms(X);
	double complex *a = calloc((size_t)n + 1, sizeof *a), *b = calloc((size_t)n + 1, sizeof *b);
	double complex s1[N], s2[N], less1[N] = { 0 }, less2[N] = { 0 }, d1[N], d2[N];
	double theta[N], mean = 0;
	sphere_debye(X, m, p, n, a, b);
	for (int k = 0; k < N; k++) {
		theta[k] = lo + (hi - lo) * k / (N - 1);
		sphere_sum(n, a, b, theta[k] * (M_PI / 180), &d1[k], &d2[k]);
		mean += (creal(d1[k] * conj(d1[k])) + creal(d2[k] * conj(d2[k]))) / (2 * N);
	}
	goa_amplitudes(X, m, p, N, theta, s1, s2);
	if (p)
		goa_amplitudes(X, m, p - 1, N, theta, less1, less2);
	*worst = *phase = 0;
	mean = sqrt(mean);
	for (int k = 0; k < N; k++) {
		double complex g1 = s1[k] - less1[k], g2 = s2[k] - less2[k];
		*worst = fmax(*worst, fmax(cabs(g1 - d1[k]), cabs(g2 - d2[k])) / mean);
		if (cabs(d1[k]) > mean / 2)
			*phase = fmax(*phase, fabs(carg(g1 / d1[k])));
		if (cabs(d2[k]) > mean / 2)
			*phase = fmax(*phase, fabs(carg(g2 / d2[k])));
	}
	free(a), free(b);
}

int main(void)
{
	static const struct { double complex m; int p; double lo, hi; } part[] = {
		{ 1.33, 0, 100, 180 }, { 1.33, 1, 0, 45 }, { 1.33, 3, 20, 60 },
		{ 1.5, 0, 100, 180 }, { 1.5, 1, 0, 60 }, { 1.5, 3, 10, 30 }, { 1.5, 4, 120, 180 },
		{ 2.5, 1, 0, 90 }, { 2.5, 2, 135, 180 }, { 1.8, 5, 60, 80 },
		{ 0.75, 0, 120, 180 }, { 0.75, 1, 0, 45 }, { 0.75, 2, 120, 170 },
		{ 1.33 + 0.001 * I, 1, 0, 45 }, { 2.5 + 0.001 * I, 2, 135, 180 }, { 1.33 + 0.003 * I, 1, 0, 35 },
	};
	enum { PARTS = sizeof part / sizeof *part };
	for (int k = 0; k < PARTS; k++) {
		double worst, phase;
		compare(part[k].m, part[k].p, part[k].lo, part[k].hi, &worst, &phase);
		ok(worst < 0.01 && phase < 0.01, "m = %g%+gi, p = %d, %g to %g degrees: within %.4f, phase within %.4f rad",
		   creal(part[k].m), cimag(part[k].m), part[k].p, part[k].lo, part[k].hi, worst, phase);
	}
	return done_testing();
}

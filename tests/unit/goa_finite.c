/* Whatever one asks, the answer is a number: random sizes, indices and angles, with the caustics and axes among them. */
#include "optics/goa/goa.h"
#include "optics/goa/goa_plus.h"
#include "optics/goa/rays.h"

#include "support/tap.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

static double uniform(void)
{
	static uint64_t state = 20220801;
	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

/* An index, often one at which something degenerates. */
static double index_re(void)
{
	static const double odd[] = { 1, 1 + DBL_EPSILON, 1 - DBL_EPSILON / 2, 1 + 1e-9, 1 - 1e-9, 2, 2 - DBL_EPSILON, 2 + 2 * DBL_EPSILON, 3,
		M_SQRT2, 0.5, 1.0 / 3, 1e-3, 1e3 };
	unsigned k = (unsigned)(uniform() * 2 * (sizeof odd / sizeof *odd));
	return k < sizeof odd / sizeof *odd ? odd[k] : exp(log(0.3) + uniform() * log(10));
}

/* An angle, often an axis, the end of the diffraction or a rainbow of n. */
static double angle(double n)
{
	double t = 180 * uniform();
	switch ((int)(uniform() * 8)) {
	case 0: return 0;
	case 1: return 180;
	case 2: return 90;
	case 3: return t * 1e-9;
	case 4: return 180 - t * 1e-9;
	case 5: {
		int p = 2 + (int)(uniform() * 4);
		struct caustic c = rays_caustic(n, p);
		if (isnan(c.tau))
			return t;
		double at = fabs(remainder(c.tau + (p - 1) * M_PI, 2 * M_PI)) * (180 / M_PI);
		for (int k = (int)(uniform() * 5); k > 0; k--)
			at = nextafter(at, uniform() < 0.5 ? 0 : 180);
		return fmin(at, 180);
	}
	}
	return t;
}

/* Phase functions of GOA+ and of the incoherent sum at n angles of so many spheres: numbers, and not negative. */
static void phase_functions(int spheres)
{
	enum { EACH = 10 };
	int bad = 0, large = 0;
	for (int k = 0; k < spheres; k++) {
		double x = pow(10, -2 + 8 * uniform()), n = index_re(), theta[EACH], i1[EACH], i2[EACH], norm;
		double complex m = uniform() < 0.5 ? n : n + I * pow(10, -12 + 13 * uniform()), s1[EACH], s2[EACH];
		struct efficiencies q;
		for (int i = 0; i < EACH; i++)
			theta[i] = angle(n);
		struct goa_plus *plus = goa_plus_new(m);
		struct goa *goa = goa_new(m, (int)(uniform() * 5));
		int failed = !plus || !goa || goa_plus_aim(plus, EACH, theta) || goa_plus_at(plus, x, s1, s2, &q) ||
			     goa_aim(goa, EACH, theta) || goa_incoherent(goa, x, i1, i2, &norm);
		int wrong = failed || !(q.sca > 0) || !isfinite(q.sca) || !isfinite(q.back) || !(norm > 0) || !isfinite(norm);
		for (int i = 0; !failed && i < EACH; i++) {
			double p = (creal(s1[i] * conj(s1[i])) + creal(s2[i] * conj(s2[i]))) / (2 * M_PI * x * x * q.sca);
			double apart = (i1[i] + i2[i]) / (2 * norm);
			wrong += !(p >= 0) || isinf(p) || !(apart >= 0) || isinf(apart);
			int beyond = cabs(s1[i]) > 10 * x * x + 10 * x || i1[i] > 100 * (x * x + x) * (x * x + x);
			large += beyond;
			if (beyond)
				printf("# x = %a, m = %a%+ai, theta = %a: %g, %g\n", x, creal(m), cimag(m), theta[i], cabs(s1[i]),
				       sqrt(i1[i]));
		}
		if (wrong)
			printf("# x = %a, m = %a%+ai: sca %g, norm %g\n", x, creal(m), cimag(m), q.sca, norm);
		bad += wrong;
		goa_plus_free(plus);
		goa_free(goa);
	}
	ok(!bad, "GOA+ and incoherent at %d angles: %d not numbers, or negative", EACH * spheres, bad);
	ok(!large, "%d larger than any disc of that size diffracts", large);
}

/* With an argument, so many spheres for GOA+ (10 angles each). */
int main(int argc, char **argv)
{
	phase_functions(argc > 1 ? atoi(argv[1]) : 600);
	enum { EACH = 10 };
	int bad = 0, large = 0;
	for (int k = 0; k < 10000; k++) {
		double x = pow(10, -2 + 9 * uniform()), n = index_re();
		double complex m = uniform() < 0.5 ? n : n + I * pow(10, -12 + 13 * uniform()), s1[EACH], s2[EACH];
		double theta[EACH];
		for (int i = 0; i < EACH; i++)
			theta[i] = angle(n);
		if (goa_amplitudes(x, m, (int)(uniform() * 7), EACH, theta, s1, s2))
			bad++;
		for (int i = 0; i < EACH; i++) {
			double a = cabs(s1[i]), b = cabs(s2[i]);
			int wrong = !isfinite(a) || !isfinite(b);
			bad += wrong;
			/* diffraction, and no ray may exceed x^2/2 */
			large += a > 10 * x * x + 10 * x;
			if (wrong)
				printf("# x = %a, m = %a%+ai, theta = %a: %g, %g\n", x, creal(m), cimag(m), theta[i], a, b);
		}
	}
	ok(!bad, "1e5 amplitudes: %d not finite", bad);
	ok(!large, "%d larger than any disc of that size diffracts", large);

	bad = 0;
	for (int k = 0; k < 300; k++) {
		double x = pow(10, -1 + 5 * uniform()), n = index_re(), error;
		double complex m = uniform() < 0.5 ? n : n + I * pow(10, -12 + 13 * uniform());
		struct efficiencies q = goa_efficiencies(x, m, k % 5, &error);
		int wrong = !isfinite(q.ext) || !isfinite(q.sca) || !isfinite(q.back) || !(fabs(q.g) <= 1) || isnan(error) || q.abs < 0;
		if (wrong || (error < 1 && (q.ext <= 0 || q.sca < 0 || q.abs > q.ext)))
			bad++, printf("# x = %a, m = %a%+ai: ext %g sca %g abs %g g %g back %g error %g\n", x, creal(m), cimag(m), q.ext, q.sca, q.abs, q.g, q.back, error);
		double norm = goa_norm(x, m, k % 5);
		bad += !(norm > 0 && isfinite(norm));
	}
	ok(!bad, "efficiencies: %d of 300 wrong", bad);

	/* Continuous across a cap: the amplitude of the rainbow's rays one step beside dT differs by little. */
	double x = 1000, worst = 0, peak = 0;
	double complex s1[2], s2[2];
	struct caustic c = rays_caustic(1.33, 2);
	double at = 180 + c.tau * (180 / M_PI);
	for (int k = 0; k < 4000; k++) {
		double pair[2] = { at + 1e-9 + k * 5e-4, at + 1e-9 + k * 5e-4 + 1e-7 };
		goa_amplitudes(x, 1.33, 2, 2, pair, s1, s2);
		worst = fmax(worst, cabs(s1[1] - s1[0]) / cabs(s1[0]));
		peak = fmax(peak, cabs(s1[0]) / x);
	}
	ok(worst < 1e-3, "no step beyond the rainbow: %.1e over 1e-7 degrees", worst);
	ok(peak > 0.3 && peak < 3, "its peak is %.2f x", peak);

	/* The glory of bubbles and of 1.4 < n < 2 grows no further than x^(3/2). */
	double back[2] = { 180, 180 - 1e-7 };
	goa_amplitudes(x, 1.7, 2, 2, back, s1, s2);
	ok(cabs(s1[0] - s1[1]) < 1e-3 * cabs(s1[0]) && cabs(s1[0]) < pow(x, 1.5), "glory at 180 degrees: %.3g", cabs(s1[0]));
	double axis[2] = { 0, 1e-7 };
	goa_amplitudes(x, 0.75, 3, 2, axis, s1, s2);
	ok(cabs(s1[0] - s1[1]) < 1e-3 * cabs(s1[0]), "and forward of a bubble");

	/* An axial ray counts once: p = 1 at 0, and p = 2 at 180 degrees where n > 2 leaves no other. */
	double theta[2] = { 0, 1e-6 };
	goa_amplitudes(x, 1.33, 1, 2, theta, s1, s2);
	ok(cabs(s1[0] - s1[1]) < 1e-5 * cabs(s1[0]), "nothing jumps at 0 degrees");
	theta[0] = 180, theta[1] = 180 - 1e-6;
	goa_amplitudes(x, 2.5, 2, 2, theta, s1, s2);
	ok(cabs(s1[0] - s1[1]) < 1e-5 * cabs(s1[0]), "nor at 180 degrees");
	return done_testing();
}

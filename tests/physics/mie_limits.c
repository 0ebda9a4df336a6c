/* Lorenz-Mie within itself: conservation, normalisation, limits, and every corner of its domain. */
#include "optics/phase/angle_grid.h"
#define LANES 1
#define UNROLL 1
#include "optics/numerics/vec_sincos.h"

#include "support/quadrature.h"
#include "support/tap.h"
#include "support/waves.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static void *room(size_t n, size_t size)
{
	void *p = calloc(n, size);
	if (!p)
		exit(2);
	return p;
}

/* Uniform in [0, 1); the same everywhere. */
static double uniform(void)
{
	static uint64_t s = 1;
	s = s * 6364136223846793005u + 1442695040888963407u;
	return (double)(s >> 11) * 0x1p-53;
}

static double relative(double got, double want) { return fabs(got - want) / fabs(want); }

static void conservation(void)
{
	static const double m[] = { 0.3, 0.75, 0.95, 1.0001, 1.1, 1.33, 1.5, 2.5, 10 };
	double worst = 0;
	int lossless = 1, lossy = 1;
	for (int i = 0; i < 9; i++)
		for (double x = 1e-3; x < 3e4; x *= 3.7) {
			struct waves w = waves(x, m[i]);
			struct efficiencies q = mie_efficiencies(x, 0, w.n, w.a, w.b, NULL);
			worst = fmax(worst, relative(q.sca, q.ext));
			lossless &= mie_lossless(w.n, w.a, w.b);
			drop(&w);
			w = waves(x, m[i] + 1e-9 * I);
			lossy &= !mie_lossless(w.n, w.a, w.b);
			drop(&w);
		}
	ok(worst <= 1e-12, "real m: C_sca = C_ext within 1e-12 (%.2g)", worst);
	ok(lossless, "coefficients of a particle without absorption are recognised");
	ok(lossy, "and those of a weakly absorbing one are not taken for it");
}

static void normalisation(void)
{
	static const struct { double x; double complex m; } at[] = {
		{ 1e-4, 1.5 }, { 0.5, 10 }, { 3, 1.33 }, { 30, 1.5 + 0.1 * I }, { 30, 0.75 }, { 101.5, 1.33 + 1e-5 * I }, { 200, 1.0001 }, { 250, 3.5 },
	};
	double worst = 0;
	for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
		struct waves w = waves(at[k].x, at[k].m);
		int n = 4 * w.n + 2;
		double *theta = room((size_t)n, sizeof *theta), *p = room((size_t)n, sizeof *p);
		double complex *s = room(2 * (size_t)n, sizeof *s);
		angle_grid_equal(n, theta);
		mie_amplitudes(w.n, w.a, w.b, n, theta, s, s + n);
		double q = mie_efficiencies(at[k].x, cimag(at[k].m) == 0, w.n, w.a, w.b, NULL).sca;
		for (int i = 0; i < n; i++)
			p[i] = (creal(s[i] * conj(s[i])) + creal(s[n + i] * conj(s[n + i]))) / (2 * M_PI * at[k].x * at[k].x * q);
		worst = fmax(worst, fabs(2 * M_PI * clenshaw_curtis(n, p) - 1));
		free(theta);
		free(p);
		free(s);
		drop(&w);
	}
	ok(worst <= 1e-10, "p integrates to 1 over the sphere within 1e-10 (%.2g)", worst);
}

/* S(0) of the sums against extinction, S1 = S2 and S1 = -S2 on the axes, an angle alone against the same among others. */
static void axes(void)
{
	double worst = 0, alone = 0, theta[101];
	double complex s1[101], s2[101], t1, t2;
	angle_grid_equal(101, theta);
	for (double x = 1e-5; x < 1e4; x *= 9.1) {
		struct waves w = waves(x, 1.4 + 0.02 * I);
		struct efficiencies q = mie_efficiencies(x, 0, w.n, w.a, w.b, NULL);
		mie_amplitudes(w.n, w.a, w.b, 101, theta, s1, s2);
		worst = fmax(worst, relative(4 / (x * x) * creal(s1[0]), q.ext));
		worst = fmax(worst, cabs(s1[0] - s2[0]) / cabs(s1[0]));
		worst = fmax(worst, cabs(s1[100] + s2[100]) / cabs(s1[100]));
		worst = fmax(worst, relative(4 / (x * x) * creal(s1[100] * conj(s1[100])), q.back));
		for (int i = 0; i < 101; i += 7) {
			mie_amplitudes(w.n, w.a, w.b, 1, &theta[i], &t1, &t2);
			alone = fmax(alone, cabs(t1 - s1[i]) + cabs(t2 - s2[i]));
		}
		drop(&w);
	}
	ok(worst <= 1e-10, "S on the axes agrees with Q_ext and Q_back (%.2g)", worst);
	ok(alone == 0, "an angle does not depend on the others");
}

static void limits(void)
{
	struct efficiencies a = q_of(1e-5, 1.5), b = q_of(1e-4, 1.5);
	double c = (1.5 * 1.5 - 1) / (1.5 * 1.5 + 2);
	ok(relative(b.sca, 8.0 / 3 * 1e-16 * c * c) < 1e-7 && relative(b.sca / a.sca, 1e4) < 1e-7, "Q_sca ~ x^4 for small x, Rayleigh's value");
	ok(relative(q_of(1e-4, 1.5 + 0.1 * I).abs, 4e-4 * cimag(((1.5 + 0.1 * I) * (1.5 + 0.1 * I) - 1) / ((1.5 + 0.1 * I) * (1.5 + 0.1 * I) + 2))) < 1e-7,
	   "Q_abs ~ x for small x, Rayleigh's value");
	double worst = 0;
	for (double d = 1e-2; d > 1e-12; d /= 10) {
		double ratio = q_of(10, 1 + d).sca / q_of(10, 1 + d / 10).sca;
		worst = fmax(worst, relative(ratio, 100) / fmax(d * 100, 1e-13 / d));
	}
	ok(worst < 10, "Q ~ (m-1)^2 as m goes to 1 (%.2g of what is allowed)", worst);
	int falls = 1;
	double old = 1;
	for (double x = 10; x < 1e6; x *= 10) {
		double e = fabs(q_of(x, 1.5 + 0.1 * I).ext - 2);
		falls &= e < old && relative(e, 1.9924 * pow(x, -2.0 / 3)) < 0.5;
		old = e;
	}
	ok(falls, "Q_ext goes to 2 with x, as its edge term does");
	ok(mie_terms(1.164916898385314, 10) > 11 && q_of(1.164916898385314, 10).ext > 15, "a resonance whose order exceeds x is counted");
}

static void everywhere(void)
{
	enum { n = 3000 };
	static double all_x[n], alone[n], together[n];
	static double complex all_m[n];
	static struct efficiencies q_alone[n], q_together[n];
	double streamed = 0;
	int bad = 0;
	for (int i = 0; i < n; i++) {
		double x = pow(10, -8 + 12 * uniform());
		if (i % 100 == 0)
			x = M_PI * floor(1 + 300 * uniform());
		double re = pow(10, -2 + 3.3 * uniform()), im = uniform() < 0.3 ? 0 : pow(10, -20 + 21.5 * uniform());
		if (i % 50 == 0)
			re = 1 + pow(10, -15 * uniform());
		if (x * hypot(re, im) > 5e4)
			x = 5e4 / hypot(re, im);
		struct waves w = waves(x, CMPLX(re, im));
		double error;
		struct efficiencies q = mie_efficiencies(x, im == 0, w.n, w.a, w.b, &error);
		double complex s1[3], s2[3];
		mie_amplitudes(w.n, w.a, w.b, 3, (double[]){ 0, 180 * uniform(), 180 }, s1, s2);
		int good = q.ext >= q.sca && q.sca >= 0 && q.abs >= 0 && fabs(q.g) <= 1 && isfinite(q.ext) && isfinite(q.back) && error > 0 &&
		           (isfinite(error) || q.ext < 1e-200);
		for (int k = 0; k < 3; k++)
			good &= isfinite(cabs(s1[k])) && isfinite(cabs(s2[k]));
		if (!good) {
			printf("# x = %.17g, m = %.17g+%.17gi: Q %g %g %g g %g back %g error %g\n", x, re, im, q.ext, q.sca, q.abs, q.g, q.back, error);
			bad++;
		}
		drop(&w);
		all_x[i] = x;
		all_m[i] = CMPLX(re, im);
		if (mie_many(1, &x, &all_m[i], &q_alone[i], &alone[i]))
			exit(2);
		double d = fmax(relative(q.ext, q_alone[i].ext), fabs(q.g - q_alone[i].g));
		streamed = fmax(streamed, d / (cabs(all_m[i] - 1) < 1e-3 ? 1e-12 : 1e-13));
	}
	ok(!bad, "%d random spheres: %d not finite or not physical", n, bad);
	ok(streamed <= 1, "each from its coefficients as by itself within 1e-13, 1e-12 for m near 1 (%.2g of that)", streamed);
	bad = mie_many(n, all_x, all_m, q_together, together);
	ok(!bad && !memcmp(q_alone, q_together, sizeof q_alone) && !memcmp(alone, together, sizeof alone), "all at once they are the same to the last bit");
}

/* At random, and next to multiples of a quarter turn, where little is left after the reduction. */
static void sines(void)
{
	double worst = 0;
	for (int i = 0; i < 300000; i++) {
		double z = pow(10, -8 + 17 * uniform()), s, c;
		if (i % 3 == 0)
			z = floor(z / M_PI_2) * M_PI_2;
		vec_sincos(z, &s, &c);
		worst = fmax(worst, (double)fmaxl(fabsl(s - sinl(z)), fabsl(c - cosl(z))));
	}
	ok(worst <= 1.2e-16, "sine and cosine to 1e9 within 1.2e-16 (%.2g)", worst);
}

static void grids(void)
{
	int bad = 0;
	for (double x = 1e-8; x < 2e7; x *= 5.3) {
		int n = angle_grid_count(x);
		double *theta = room((size_t)n, sizeof *theta);
		angle_grid(x, theta);
		bad += theta[0] != 0 || theta[n - 1] != 180 || theta[n / 2] != 90 || n > 10000;
		for (int i = 1; i < n; i++)
			bad += !(theta[i] > theta[i - 1]) || (i < n / 2 && 180 - theta[i] != theta[n - 1 - i]);
		free(theta);
	}
	double equal[1801];
	angle_grid_equal(1801, equal);
	bad += equal[1] != 0.1 || equal[900] != 90 || equal[1800] != 180;
	angle_grid_equal(2, equal);
	bad += equal[0] != 0 || equal[1] != 180;
	ok(!bad, "angular grids ascend from 0 to 180, symmetric");
}

int main(void)
{
	conservation();
	normalisation();
	axes();
	limits();
	everywhere();
	sines();
	grids();
	return done_testing();
}

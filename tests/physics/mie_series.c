/* All angles at once against sums in higher precision, and the angles chosen by a phase function against that function. */
#include "base/cpu.h"
#include "optics/phase/angle_grid.h"
#include "optics/numerics/kern/fourier.h"
#include "optics/mie/mie_fast_amplitudes.h"

#include "support/tap.h"
#include "support/waves.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void *room(size_t n, size_t size)
{
	void *p = calloc(n, size);
	if (!p)
		exit(2);
	return p;
}

/* S1, S2 summed in long double, theta in degrees; as in mie.c, from the nearer axis. */
static void reference(const struct waves *w, double theta, double complex s[2])
{
	int behind = theta > 90;
	long double t = behind ? 180 - (long double)theta : theta, h = sinl(t * 3.14159265358979323846264338327950288L / 360);
	long double c = 2 * h * h, p = 1, v = 1, sum[4] = { 0 };
	for (int l = 1; l <= w->n; l++) {
		long double k = l, f = (2 * k + 1) / (k * (k + 1)), plus = (k + 1) * v - k * c * p, minus = 2 * p - plus;
		long double pi = (plus + minus) / 2, tau = (plus - minus) / 2;
		if (behind) {
			pi *= l % 2 ? 1 : -1;
			tau *= l % 2 ? -1 : 1;
		}
		sum[0] += f * (creal(w->a[l]) * pi + creal(w->b[l]) * tau);
		sum[1] += f * (cimag(w->a[l]) * pi + cimag(w->b[l]) * tau);
		sum[2] += f * (creal(w->b[l]) * pi + creal(w->a[l]) * tau);
		sum[3] += f * (cimag(w->b[l]) * pi + cimag(w->a[l]) * tau);
		v = (k + 1) / k * v - (2 * k + 1) / k * c * p;
		p += v;
	}
	s[0] = CMPLX((double)sum[0], (double)sum[1]);
	s[1] = CMPLX((double)sum[2], (double)sum[3]);
}

/* Angles at and near both axes, and between: some on simple fractions of the circle, where periodic errors would meet. */
static int angles_to_try(double x, double *theta)
{
	static const double between[] = { 3, 11.25, 22.5, 30, 45, 60.123, 67.5, 90, 101.7, 112.5, 135, 137.9, 157.5, 171.2 };
	int n = 0;
	for (double t = 0; t < 40; t += t < 3 ? 0.7 : 11)
		if (t * 57 / x < 90) {
			theta[n++] = t * 57 / x;
			theta[n++] = 180 - t * 57 / x;
		}
	for (size_t i = 0; i < sizeof between / sizeof *between; i++)
		theta[n++] = between[i];
	return n;
}

static void accuracy(void)
{
	static const struct { double x; double complex m; } at[] = {
		{ 1e-3, 1.5 }, { 0.7, 10 }, { 3, 1.33 }, { 20.3, 0.75 }, { 57, 1.5 + 0.1 * I }, { 96.903239374958, 1.33 },
		{ 333.3, 1.0001 }, { 1000.5, 1.33 }, { 1001, 3 + 2 * I }, { 4000.1, 1.5 + 1e-5 * I }, { 2e4, 1.33 },
		{ 2e4, 1.01 + 0.01 * I }, { 3e4, 1.5 + 0.1 * I }, { 1e5, 1.33 },
	};
	double forward = 0, local = 0, sum = 0;
	for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
		struct waves w = waves(at[k].x, at[k].m);
		struct legendre_series *s = mie_fast_amplitudes_new(w.n, w.a, w.b);
		double theta[64];
		double complex s1[64], s2[64], zero[2], want[2], d1[64], d2[64];
		int n = angles_to_try(at[k].x, theta);
		if (!s)
			exit(2);
		mie_fast_amplitudes_at(s, n, theta, s1, s2);
		reference(&w, 0, zero);
		if (at[k].x < 5000 && mie_amplitudes(w.n, w.a, w.b, n, theta, d1, d2))
			exit(2);
		double one = 0, own = 0;
		for (int i = 0; i < n; i++) {
			double near[41], rms = 0;
			double complex n1[41], n2[41];
			reference(&w, theta[i], want);
			for (int j = 0; j < 41; j++)    /* over +-10/x rad */
				near[j] = fmin(180, fmax(0, theta[i] + (j - 20) * 0.5 / at[k].x * (180 / M_PI)));
			mie_fast_amplitudes_at(s, 41, near, n1, n2);
			for (int j = 0; j < 41; j++)
				rms += (norm2(n1[j]) + norm2(n2[j])) / (2 * 41);
			double e = fmax(cabs(s1[i] - want[0]), cabs(s2[i] - want[1]));
			one = fmax(one, e / cabs(zero[0]));
			own = fmax(own, e / sqrt(rms));
			if (at[k].x < 5000)
				sum = fmax(sum, fmax(cabs(s1[i] - d1[i]), cabs(s2[i] - d2[i])) / cabs(zero[0]));
		}
		printf("# x = %g, m = %g+%gi: %.1e of S(0), %.1e of what is near\n", at[k].x, creal(at[k].m), cimag(at[k].m), one, own);
		forward = fmax(forward, one);
		local = fmax(local, own);
		legendre_series_free(s);
		drop(&w);
	}
	ok(forward <= 1e-13, "error of S1, S2 at every angle within 1e-13 S(0) (%.2g)", forward);
	ok(local <= 1e-8, "and within 1e-8 of the rms of S1, S2 over +-10/x rad (%.2g)", local);
	ok(sum <= 1e-13, "as the direct sums have them (%.2g)", sum);
}

/* Reference amplitudes to 20 digits (tests/data/README). */
static void oracle(void)
{
	FILE *f = fopen("tests/data/mie_amplitudes.csv", "r");
	double v[8], x = 0, worst = 0;
	double complex m = 0, zero[2];
	struct legendre_series *s = NULL;
	int rows = 0;
	if (!f || fscanf(f, "%*[^\n]") < 0) {
		printf("Bail out! cannot read tests/data/mie_amplitudes.csv\n");
		exit(2);
	}
	while (fscanf(f, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", v, v + 1, v + 2, v + 3, v + 4, v + 5, v + 6, v + 7) == 8) {
		double complex s1, s2;
		if (x != v[0] || m != CMPLX(v[1], v[2])) {
			struct waves w = waves(x = v[0], m = CMPLX(v[1], v[2]));
			legendre_series_free(s);
			s = mie_fast_amplitudes_new(w.n, w.a, w.b);
			if (!s)
				exit(2);
			reference(&w, 0, zero);
			drop(&w);
		}
		mie_fast_amplitudes_at(s, 1, &v[3], &s1, &s2);
		double e = fmax(cabs(s1 - CMPLX(v[4], v[5])), cabs(s2 - CMPLX(v[6], v[7]))) / cabs(zero[0]);
		worst = fmax(worst, e / fmax(1, 100 * DBL_EPSILON * 2 * cabs(m) / cabs(m - 1) / 1e-10));    /* as far as m - 1 is known */
		rows++;
	}
	fclose(f);
	legendre_series_free(s);
	ok(rows == 533 && worst <= 1e-10, "%d reference amplitudes within 1e-10 S(0) (%.2g)", rows, worst);
}

/* The same bits whatever other angles are asked for, and on every processor. */
static void independence(void)
{
	struct waves w = waves(700, 1.4 + 0.001 * I);
	double theta[501];
	double complex s[2][501], one[2], other[2][501];
	angle_grid_equal(501, theta);
	int same = 1, alone = 1;
	for (int c = 0; c < CPU_LEVELS; c++) {
		if (!cpu_has(c))
			continue;
		setenv("MOTES_CPU", cpu_name(c), 1);
		struct legendre_series *series = mie_fast_amplitudes_new(w.n, w.a, w.b);
		if (!series)
			exit(2);
		mie_fast_amplitudes_at(series, 501, theta, c ? other[0] : s[0], c ? other[1] : s[1]);
		same &= !c || !memcmp(s, other, sizeof s);
		for (int i = 0; i < 501; i += 7) {
			mie_fast_amplitudes_at(series, 1, &theta[i], &one[0], &one[1]);
			alone &= one[0] == s[0][i] && one[1] == s[1][i];
		}
		legendre_series_free(series);
	}
	unsetenv("MOTES_CPU");
	drop(&w);
	ok(same, "the same bits by MOTES_CPU scalar, v2, v3, v4, as far as this processor has them");
	ok(alone, "an angle alone and among others");
}

/* Integral of f over the sphere by the rule of Clenshaw and Curtis on equal angles, exact for polynomials in cos theta of degree
 * <= steps, 8 2^a. The weights are the cosine transform of the integrals of cos(k t) sin t, 2/(1 - k^2) for even k. */
static double sphere(int steps, double (*f)(void *, double), void *context)
{
	size_t n = 2 * (size_t)steps;
	double *data = room(10 * n, sizeof *data), *re[2] = { data, data + 2 * n }, *im[2] = { data + 4 * n, data + 6 * n }, sum = 0;
	for (int k = 0; k <= steps; k += 2)
		re[0][2 * k] = re[0][2 * ((n - (size_t)k) % n)] = 2 / (1 - (double)k * k);
	fourier_waves((int)n, data + 8 * n);
	int at = fourier((int)n, data + 8 * n, re, im);
	for (int i = 0; i <= steps; i++)
		sum += (i == 0 || i == steps ? 0.5 : 1) * re[at][2 * i] / steps * f(context, 180.0 * i / steps);
	free(data);
	return 2 * M_PI * sum;
}

struct sphere {
	struct legendre_series *series;
	double norm;
};

static double p_at(void *context, double theta)
{
	struct sphere *s = context;
	double v[1][LEGENDRE_SERIES_SUMS], sum = 0;
	legendre_series_at(s->series, 1, &theta, v);
	for (int i = 0; i < LEGENDRE_SERIES_SUMS; i++)
		sum += v[0][i] * v[0][i];
	return sum / (2 * s->norm);
}

static struct sphere sphere_of(double x, double complex m, int *n)
{
	struct waves w = waves(x, m);
	struct sphere s = { mie_fast_amplitudes_new(w.n, w.a, w.b),
		M_PI * x * x * mie_efficiencies(x, cimag(m) == 0, w.n, w.a, w.b, NULL).sca };
	if (!s.series)
		exit(2);
	*n = w.n;
	drop(&w);
	return s;
}

static void normalisation(void)
{
	static const struct { double x; double complex m; } at[] = {
		{ 1e-3, 1.5 }, { 3, 1.33 }, { 30, 1.5 + 0.1 * I }, { 101.5, 1.33 + 1e-5 * I }, { 2003.7, 1.33 }, { 1e5, 1.33 }, { 1e5, 1.5 + 0.1 * I },
	};
	double worst = 0;
	for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
		int n;
		struct sphere s = sphere_of(at[k].x, at[k].m, &n);
		int steps = 64;
		while (steps < 2 * n)
			steps *= 2;
		worst = fmax(worst, fabs(sphere(steps, p_at, &s) - 1));
		legendre_series_free(s.series);
	}
	ok(worst <= 1e-10, "p integrates to 1 over the sphere within 1e-10 (%.2g)", worst);
}

/* What thinning leaves, against p on equal steps that have nothing to do with it. */
static void thinning(void)
{
	static const struct { double x; double complex m; double tolerance, most; } at[] = {
		{ 1e-3, 1.5, 1e-3, 181 }, { 1, 1.33, 1e-3, 190 }, { 30, 1.5, 1e-3, 500 }, { 100.3, 1.33, 1e-3, 1100 },
		{ 100.3, 1.33, 1e-2, 400 }, { 100.3, 1.33, 1e-5, 11500 }, { 1000.49, 1.33, 1e-3, 7700 },
		{ 1000.49, 1.5 + 0.1 * I, 1e-3, 700 }, { 1e4, 1.33, 1e-3, 65000 }, { 3e4, 0.75, 1e-3, 125000 },
	};
	double over = 0, many = 0, under = 1;
	for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
		int terms, steps = (int)(101 * at[k].x) + 20000;
		struct sphere s = sphere_of(at[k].x, at[k].m, &terms);
		long n = angle_grid_fine(at[k].x, at[k].tolerance, NULL), *keep = room((size_t)n, sizeof *keep);
		double *theta = room((size_t)n, sizeof *theta), *p = room((size_t)n, sizeof *p), error = 0;
		angle_grid_fine(at[k].x, at[k].tolerance, theta);
		for (long i = 0; i < n; i++)
			p[i] = p_at(&s, theta[i]);
		long kept = angle_grid_thin(n, theta, 1, &p, at[k].tolerance, keep), j = 0;
		int good = kept >= 181 && keep[0] == 0 && keep[kept - 1] == n - 1 && theta[0] == 0 && theta[n - 1] == 180;
		for (long i = 0; i + 1 < kept; i++)
			good &= theta[keep[i + 1]] > theta[keep[i]] && theta[keep[i + 1]] - theta[keep[i]] <= 1 + 1e-12;
		for (int i = 0; i < steps; i++) {
			double t = (i + 0.5) * 180 / steps;
			while (theta[keep[j + 1]] < t)
				j++;
			double f = (t - theta[keep[j]]) / (theta[keep[j + 1]] - theta[keep[j]]);
			double off = p_at(&s, t) - (1 - f) * p[keep[j]] - f * p[keep[j + 1]];
			error += M_PI * sin(t * M_PI / 180) * M_PI / steps * fabs(off);
		}
		printf("# x = %g, m = %g+%gi, tolerance %g: %ld angles, off by %.3g\n", at[k].x, creal(at[k].m), cimag(at[k].m),
		       at[k].tolerance, kept, error);
		over = fmax(over, error / at[k].tolerance);
		many = fmax(many, kept / at[k].most);
		under = fmin(under, good);
		free(keep);
		free(theta);
		free(p);
		legendre_series_free(s.series);
	}
	ok(over <= 1.001, "p linear between the angles chosen is within the tolerance (%.4g of it)", over);
	ok(many <= 1, "and these are few (%.3g of what is allowed)", many);
	ok(under == 1, "from 0 to 180 degrees, none farther apart than one");

	/* Two waves at once: each within the tolerance, so no fewer than for either. */
	int terms;
	struct sphere s[2] = { sphere_of(50, 1.33, &terms), sphere_of(41, 1.33, &terms) };
	long n = angle_grid_fine(50, 1e-3, NULL), *keep = room((size_t)n, sizeof *keep), kept[3];
	double *theta = room((size_t)n, sizeof *theta), *p[2] = { room((size_t)n, sizeof(double)), room((size_t)n, sizeof(double)) };
	angle_grid_fine(50, 1e-3, theta);
	for (int w = 0; w < 2; w++) {
		for (long i = 0; i < n; i++)
			p[w][i] = p_at(&s[w], theta[i]);
		kept[w] = angle_grid_thin(n, theta, 1, &p[w], 1e-3, keep);
	}
	kept[2] = angle_grid_thin(n, theta, 2, p, 1e-3, keep);
	ok(kept[2] >= kept[0] && kept[2] >= kept[1], "angles for two at once: %ld, for each %ld and %ld", kept[2], kept[0], kept[1]);
	for (int w = 0; w < 2; w++) {
		free(p[w]);
		legendre_series_free(s[w].series);
	}
	free(theta);
	free(keep);
}

/* Fewer terms, within the tolerance that they were cut for. */
static void enough(void)
{
	double worst = 0, saved = 0;
	for (double x = 10; x < 2000; x *= 5)
		for (double tolerance = 1e-2; tolerance > 1e-7; tolerance /= 100) {
			struct waves w = waves(x, 1.33);
			int n = mie_terms_enough(w.n, w.a, w.b, tolerance), steps = 20 * (int)x + 500;
			double *theta = room((size_t)steps, sizeof *theta), error = 0;
			double complex *s = room(4 * (size_t)steps, sizeof *s), *s2 = s + steps, *t1 = s2 + steps, *t2 = t1 + steps;
			for (int i = 0; i < steps; i++)
				theta[i] = (i + 0.5) * 180 / steps;
			if (mie_amplitudes(w.n, w.a, w.b, steps, theta, s, s2) || mie_amplitudes(n, w.a, w.b, steps, theta, t1, t2))
				exit(2);
			for (int i = 0; i < steps; i++)
				error += sin(theta[i] * M_PI / 180) * fabs(norm2(s[i]) + norm2(s2[i]) - norm2(t1[i]) - norm2(t2[i]));
			error *= M_PI * M_PI / steps / (2 * M_PI * x * x * mie_efficiencies(x, 1, w.n, w.a, w.b, NULL).sca);
			worst = fmax(worst, error / tolerance);
			saved += w.n - n;
			free(theta);
			free(s);
			drop(&w);
		}
	ok(worst <= 1 && saved > 0, "terms left out for a tolerance cost no more than that (%.3g of it)", worst);
}

int main(void)
{
	accuracy();
	oracle();
	independence();
	normalisation();
	thinning();
	enough();
	return done_testing();
}

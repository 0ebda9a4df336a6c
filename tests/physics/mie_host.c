/* Lorenz-Mie theory in a host that absorbs: reference values, the limit of a clear host, and every corner of its domain. */
#include "optics/mie/mie_host.h"

#include "support/csv.h"
#include "optics/phase/angle_grid.h"
#include "support/quadrature.h"
#include "support/tap.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

struct waves {
	int n;
	double complex *a, *b;
};

static struct waves waves(double complex x, double complex m)
{
	struct waves w = { cimag(x) > 0 ? mie_host_terms(x, m) : mie_terms(creal(x), m), NULL, NULL };
	w.a = malloc(((size_t)w.n + 1) * sizeof *w.a);
	w.b = malloc(((size_t)w.n + 1) * sizeof *w.b);
	if (!w.a || !w.b || (cimag(x) > 0 ? mie_host_coefficients(x, m, w.n, w.a, w.b) : mie_coefficients(creal(x), m, w.n, w.a, w.b)))
		exit(2);
	return w;
}

static void drop(struct waves *w)
{
	free(w->a);
	free(w->b);
}

static struct efficiencies q_of(double complex x, double complex m, double *error)
{
	struct waves w = waves(x, m);
	struct efficiencies q = cimag(x) > 0 ? mie_host_efficiencies(x, w.n, w.a, w.b, error)
	                                     : mie_efficiencies(creal(x), cimag(m) == 0, w.n, w.a, w.b, error);
	drop(&w);
	return q;
}

/* Relative index of a particle and its host, with the digits of a small imaginary part. */
static double complex relative_index(double complex p, double complex h)
{
	return CMPLX(creal(p) * creal(h) + cimag(p) * cimag(h), cimag(p) * creal(h) - creal(p) * cimag(h)) / norm2(h);
}

static void cross_sections(void)
{
	FILE *f = open_data("mie_absorbing_host.csv");
	char line[4096], *v[16];
	double worst_ext = 0, worst_sca = 0;
	int rows = 0;
	for (; fields(f, line, sizeof line, v, 16) == 10; rows++) {
		double r = atof(v[1]), k = 2 * M_PI / atof(v[0]), area = M_PI * r * r;
		double complex h = CMPLX(atof(v[4]), atof(v[5])), x = CMPLX(k * r * creal(h), k * r * cimag(h));
		struct efficiencies q = q_of(x, relative_index(CMPLX(atof(v[2]), atof(v[3])), h), NULL);
		worst_ext = fmax(worst_ext, off(q.ext * area, atof(v[6])));
		worst_sca = fmax(worst_sca, off(q.sca * area, atof(v[7])));
	}
	fclose(f);
	ok(rows == 32, "%d rows of reference cross sections", rows);
	ok(worst_ext <= 1e-12 && worst_sca <= 1e-13, "c_ext within %.1e, c_sca within %.1e", worst_ext, worst_sca);
}

/* What rounding leaves of a value: 20 times that of x, by the value's own condition number (of Q_ext with what cancels in its sum), but no less
 * than 2e-13; where that was not computed, 1e-12. */
static double allowed(const char *condition)
{
	return *condition ? fmax(2e-13, 20 * 2.2e-16 * atof(condition)) : 1e-12;
}

static void reference(void)
{
	static const char *const names[4] = { "Q_ext", "Q_sca", "g", "Q_back" };
	FILE *f = open_data("mie_host.csv");
	char line[4096], *v[16];
	double worst[4] = { 0 }, estimate = 0;
	int rows = 0, at[4] = { 0 };
	for (; fields(f, line, sizeof line, v, 16) == 13; rows++) {
		double complex x = CMPLX(atof(v[0]), atof(v[1])), m = CMPLX(atof(v[2]), atof(v[3]));
		double error;
		struct efficiencies q = q_of(x, m, &error);
		const double got[4] = { q.ext, q.sca, q.g, q.back };
		for (int i = 0; i < 4; i++) {
			double e = off(got[i], atof(v[4 + i])) / allowed(v[8 + i]);
			if (getenv("MIE_ROWS"))
				fprintf(stderr, "%s %s %s %s %s %s %.1e of %.1e\n", v[0], v[1], v[2], v[3], names[i], v[12], e * allowed(v[8 + i]), allowed(v[8 + i]));
			if (!(e <= worst[i])) {
				worst[i] = e;
				at[i] = rows + 1;
			}
		}
		if (strcmp(v[12], "resonance"))    /* of the computed value: the true one can be far smaller */
			estimate = fmax(estimate, fmax(fmax(fabs(atof(v[4]) / got[0] - 1), off(got[1], atof(v[5]))), fabs(got[2] - atof(v[6]))) / error);
	}
	fclose(f);
	ok(rows == 53, "%d rows of reference efficiencies", rows);
	for (int i = 0; i < 4; i++)
		ok(worst[i] <= 1, "%s: error at most %.2g of what is allowed, in row %d", names[i], worst[i], at[i]);
	ok(estimate <= 10, "error over estimate: %.2g", estimate);
}

static void gamma_factor(void)
{
	static const double want[][2] = {    /* in higher precision */
		{ 1e-8, 0.999999996666666675 }, { 1e-6, 0.99999966666674999998 }, { 0.09999999999999999, 0.96748360719191463549 },
		{ 0.1, 0.96748360719191463109 }, { 1, 0.73575888234288464319 }, { 10, 0.1800009079985952497 }, { 600, 0.0033277777777777777778 },
	};
	double worst = 0;
	for (size_t i = 0; i < sizeof want / sizeof *want; i++)
		worst = fmax(worst, off(mie_host_gamma(want[i][0]), want[i][1]));
	ok(worst <= 4e-15 && mie_host_gamma(0) == 1, "gamma from beta = 0 to 600 (%.2g)", worst);
}

/* A host of vanishing absorption leaves what a clear one gives, at any size: small parts of the coefficients are not lost. */
static void clear_limit(void)
{
	static const double complex index[] = { 1.33, 1.5 + 0.1 * I, 1.5 + 1e-9 * I, 0.75, 1.0001, 0.05 + 3 * I, 10 };
	double none = 0, little = 0;
	for (size_t k = 0; k < sizeof index / sizeof *index; k++)
		for (double x = 1e-8; x < 3e3; x *= 6.7) {
			double scale = 2e-15 * (10 + x) * fmax(1, 0.1 / cabs(index[k] - 1));
			double complex host = CMPLX(1, 1e-290);
			struct efficiencies q = q_of(x, index[k], NULL), p = q_of(x * host, relative_index(index[k], host), NULL);
			none = fmax(none, fmax(fmax(off(p.ext, q.ext), off(p.sca, q.sca)), fmax(fabs(p.g - q.g), off(p.back, q.back) / 100)) / scale);
			host = CMPLX(1, 1e-12);
			p = q_of(x * host, relative_index(index[k], host), NULL);
			if (x > 0.5 && x < 50 && cabs(index[k]) < 5)    /* elsewhere it tells: in small extinctions, on resonances */
				little = fmax(little, fmax(fmax(off(p.ext, q.ext), off(p.sca, q.sca)), fabs(p.g - q.g)) * fmin(1, norm2(index[k] - 1)));
		}
	ok(none <= 1, "Im host = 1e-290: as a clear host, at any size (%.2g of what is allowed)", none);
	ok(little <= 1e-10, "Im host = 1e-12: in agreement with a clear one (%.2g)", little);
}

/* p by eq 30: its integral, its mean cosine, and backscatter. */
static void phase_function(void)
{
	static const struct { double complex x, m; } at[] = {
		{ 1e-3 + 1e-5 * I, 1.5 - 0.01 * I }, { 3 + 0.1 * I, 1.33 }, { 30 + 0.6 * I, 0.75 - 0.01 * I }, { 100 + 20 * I, 1.2 - 0.2 * I },
		{ 20 + 149 * I, 0.1 - 0.7 * I }, { 200 + 1e-6 * I, 1.0001 },
	};
	double worst = 0;
	for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
		struct waves w = waves(at[k].x, at[k].m);
		int n = 4 * w.n + 2;
		double *theta = malloc(3 * (size_t)n * sizeof *theta), *p = theta + n, *cosine = p + n;
		double complex *s = malloc(2 * (size_t)n * sizeof *s);
		if (!theta || !s)
			exit(2);
		angle_grid_equal(n, theta);
		mie_amplitudes(w.n, w.a, w.b, n, theta, s, s + n);
		struct efficiencies q = mie_host_efficiencies(at[k].x, w.n, w.a, w.b, NULL);
		for (int i = 0; i < n; i++) {
			p[i] = (norm2(s[i]) + norm2(s[n + i])) / (2 * mie_host_norm(at[k].x, q.sca));
			cosine[i] = p[i] * cos(M_PI * i / (n - 1));
		}
		worst = fmax(worst, fabs(2 * M_PI * clenshaw_curtis(n, p) - 1));
		worst = fmax(worst, fabs(2 * M_PI * clenshaw_curtis(n, cosine) - q.g));
		worst = fmax(worst, off(4 * M_PI * q.sca * p[n - 1], q.back) / 100);
		free(theta);
		free(s);
		drop(&w);
	}
	ok(worst <= 1e-12, "p integrates to 1, its mean cosine is g, and backscatter fits (%.2g)", worst);
}

/* Uniform in [0, 1); the same everywhere. */
static double uniform(void)
{
	static uint64_t s = 1;
	s = s * 6364136223846793005u + 1442695040888963407u;
	return (double)(s >> 11) * 0x1p-53;
}

static void everywhere(void)
{
	int bad = 0, n = 0;
	for (int i = 0; i < 6000; i++) {
		double re = pow(10, -8 + 11.5 * uniform()), im = uniform() < 0.3 ? re * pow(10, -20 * uniform()) : 150 * pow(10, -12 * uniform());
		if (i % 10 == 0)
			im = 150;
		if (i % 7 == 0)
			re = M_PI * floor(1 + 300 * uniform());
		double complex x = CMPLX(re, fmin(im, 150)), p = CMPLX(pow(10, -2 + 3.3 * uniform()), uniform() < 0.3 ? 0 : pow(10, -20 + 21.5 * uniform()));
		double complex m = relative_index(p, x / re);
		if (i % 50 == 0)
			m = CMPLX(1 + pow(10, -15 * uniform()), -cimag(x) / cabs(x) * pow(10, -15 * uniform()));
		if (cabs(m * x) > 1e4 || cabs(m) < 1e-3 || cabs(m) > 2e3)
			continue;
		n++;
		struct waves w = waves(x, m);
		double error;
		struct efficiencies q = mie_host_efficiencies(x, w.n, w.a, w.b, &error);
		double complex s1[3], s2[3];
		mie_amplitudes(w.n, w.a, w.b, 3, (double[]){ 0, 180 * uniform(), 180 }, s1, s2);
		double norm = mie_host_norm(x, q.sca);
		int good = isfinite(q.ext) && isfinite(q.sca) && q.sca >= 0 && isfinite(q.abs) && fabs(q.g) <= 1 && isfinite(q.back) && error > 0;
		for (int k = 0; k < 3; k++)
			good &= isfinite((norm2(s1[k]) + norm2(s2[k])) / (2 * norm));
		if (!good) {
			printf("# x = %.17g+%.17gi, m = %.17g%+.17gi: Q %g %g g %g back %g error %g norm %g\n", creal(x), cimag(x), creal(m), cimag(m), q.ext,
			       q.sca, q.g, q.back, error, norm);
			bad++;
		}
		drop(&w);
	}
	ok(n > 3000 && !bad, "%d random spheres: %d not finite or not possible", n, bad);
}

int main(void)
{
	cross_sections();
	reference();
	gamma_factor();
	clear_limit();
	phase_function();
	everywhere();
	return done_testing();
}

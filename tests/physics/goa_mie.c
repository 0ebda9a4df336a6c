/* GOA against Lorenz-Mie: phase functions in L1, efficiencies, and the error that goa_efficiencies claims. */
#include "optics/goa/goa.h"

#include "support/sphere.h"
#include "support/tap.h"

/* Half the integral over the sphere of |p_goa - p_mie|, on n equal angles. Mie is normalised by its coefficients. */
static double l1(double x, double complex m, int order, int n)
{
	int terms = sphere_terms(x);
	double complex *a = calloc((size_t)terms + 1, sizeof *a), *b = calloc((size_t)terms + 1, sizeof *b);
	double complex *s1 = calloc((size_t)n, sizeof *s1), *s2 = calloc((size_t)n, sizeof *s2);
	double *theta = calloc((size_t)n, sizeof *theta), ext, sca, g, sum = 0;
	sphere_mie(x, m, terms, a, b);
	sphere_q(x, terms, a, b, &ext, &sca, &g);
	for (int k = 0; k < n; k++)
		theta[k] = 180.0 * k / (n - 1);
	double norm = goa_norm(x, m, order);
	goa_amplitudes(x, m, order, n, theta, s1, s2);
	for (int k = 0; k < n; k++) {
		double complex t1, t2;
		double t = theta[k] * (M_PI / 180);
		sphere_sum(terms, a, b, t, &t1, &t2);
		double goa = (creal(s1[k] * conj(s1[k])) + creal(s2[k] * conj(s2[k]))) / (2 * norm);
		double mie = (creal(t1 * conj(t1)) + creal(t2 * conj(t2))) / (2 * M_PI * x * x * sca);
		sum += fabs(goa - mie) * sin(t);
	}
	free(a), free(b), free(s1), free(s2), free(theta);
	return sum * M_PI / (n - 1) * M_PI;
}

int main(void)
{
	static const struct { double complex m; double x, l1; } row[] = {
		{ 1.33, 100.49, 7.8e-2 }, { 1.33, 300.49, 4.9e-2 }, { 1.33, 1000.49, 3.3e-2 }, { 1.49, 1000.55, 3.4e-2 },
		{ 1.33 + 0.001 * I, 1000.49, 1.8e-2 }, { 1.5 + 0.1 * I, 100.55, 5.4e-2 }, { 1.5 + 0.1 * I, 1000.55, 1.8e-2 },
		{ 0.75, 1000.28, 3.0e-2 },
	};
	enum { ROWS = sizeof row / sizeof *row };
	static const double complex index[] = { 1.1, 1.33, 1.49, 1.56, 1.9, 2.4, 0.75, 0.5, 1.33 + 1e-4 * I, 1.33 + 1e-2 * I, 1.5 + 0.1 * I, 1.7 + 1 * I };
	enum { INDICES = sizeof index / sizeof *index };
	static const double size[] = { 1.3, 3.1, 10.2, 31, 100.4, 301.3, 1000.7 };
	enum { SIZES = sizeof size / sizeof *size };

	for (int k = 0; k < ROWS; k++) {
		double got = l1(row[k].x, row[k].m, 3, 7201);
		ok(fabs(got / row[k].l1 - 1) < 0.15, "L1 of m = %g%+gi at x = %g is %.2e, wanted %.1e", creal(row[k].m), cimag(row[k].m), row[k].x, got, row[k].l1);
	}

	for (int k = 0; k < INDICES; k++) {
		double complex m = index[k];
		double worst = 0, at = 0, far = 0;
		for (int i = 0; i < SIZES; i++) {
			double x = size[i], ext, sca, g, claimed;
			int n = sphere_terms(fmax(x, cabs(m) * x < 400 ? cabs(m) * x : x));
			double complex *a = calloc((size_t)n + 1, sizeof *a), *b = calloc((size_t)n + 1, sizeof *b);
			sphere_mie(x, m, n, a, b);
			sphere_q(x, n, a, b, &ext, &sca, &g);
			struct efficiencies q = goa_efficiencies(x, m, 1, &claimed), q3 = goa_efficiencies(x, m, 3, &claimed);
			double error = fmax(fmax(fabs(q3.ext / ext - 1), fabs(q3.sca / sca - 1)), fabs(q3.g - g));
			if (getenv("VERBOSE"))
				printf("# m %g%+gi x %g ext %.3f/%.3f sca %.3f/%.3f g %.4f/%.4f err %.2e claimed %.2e\n", creal(m), cimag(m), x, q3.ext, ext, q3.sca, sca, q3.g, g, error, claimed);
			if (claimed < 1 && error / claimed > worst) {
				worst = error / claimed;
				at = x;
			}
			if (x > 1000)
				far = fmax(fabs(q.ext / ext - 1), fabs(q.sca / sca - 1));
			free(a), free(b);
		}
		ok(worst < 1.5, "m = %g%+gi: true error at most %.2f of the claimed one (x = %g)", creal(m), cimag(m), worst, at);
		ok(far < 0.025, "m = %g%+gi: efficiencies at x = 1000.7 within %.1e", creal(m), cimag(m), far);
	}

	double error, x = 2 * M_PI * 0.1 / 0.6;
	struct efficiencies q = goa_efficiencies(x, 1.49, 1, &error);
	ok(fabs(q.ext + 2.7752) < 5e-5, "the negative extinction of eq 14: %.4f", q.ext);
	ok(error >= 1, "and its error is %g", error);
	ok(q.sca == q.ext && q.abs == 0, "a real index does not absorb");
	q = goa_efficiencies(x, 1.56, 1, &error);
	ok(fabs(q.ext + 2.6699) < 5e-5, "and for m = 1.56: %.4f", q.ext);
	q = goa_efficiencies(1000, 1.33 + 1e-12 * I, 3, &error);
	/* weak absorption: Q_abs = (8/3) k x [n^3 - (n^2-1)^(3/2)]/n, which is the volume times what a ray bundle concentrates */
	double n = 1.33, weak = 8.0 / 3 * 1e-12 * 1000 * (n * n * n - pow(n * n - 1, 1.5)) / n;
	ok(fabs(q.abs / weak - 1) < 1e-3, "weak absorption %.5g, wanted %.5g", q.abs, weak);
	double least = 1, most = 0;
	for (double k = 1e-9; k < 10; k *= 3)
		for (double r = 0.4; r < 3; r += 0.13) {
			q = goa_efficiencies(400, r + k * I, 3, &error);
			least = fmin(least, q.abs);
			most = fmax(most, q.abs / q.ext);
		}
	ok(least >= 0 && most <= 1, "absorption between 0 and extinction: %g, %g", least, most);
	q = goa_efficiencies(1000, 1.5 + 5 * I, 3, &error);
	ok(q.abs > 0.2 && q.abs < 0.4, "a metal absorbs what it does not reflect: %.3f", q.abs);
	return done_testing();
}

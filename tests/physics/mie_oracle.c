/* Lorenz-Mie against reference values, published tables, and the limits of physics. */
#include "base/cpu.h"
#include "support/csv.h"
#include "support/tap.h"
#include "support/waves.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct worst {
	double error, x;
	double complex m;
};

static void note(struct worst *w, double error, double x, double complex m)
{
	if (!(error <= w->error))
		*w = (struct worst){ error, x, m };
}

static void bound(const struct worst *w, double limit, const char *what)
{
	ok(w->error <= limit, "%s: %.2g at x = %.17g, m = %.9g+%.9gi", what, w->error, w->x, creal(w->m), cimag(w->m));
}

/* What rounding leaves of a value: 20 times that of x, by the value's own condition number, and of m, by 2 |m| / |m - 1|, which is about
 * its condition against m; where the former was not computed, 1e-11, for Q_back 1e-6. */
static double allowed(double complex m, const char *condition, int back)
{
	double of_m = 20 * 2.2e-16 * 2 * cabs(m) / cabs(m - 1);
	return *condition ? fmax(2e-13, 20 * 2.2e-16 * atof(condition) + of_m) : fmax(back ? 1e-6 : 1e-11, of_m);
}

#define ROWS 512

/* All rows, each alone, and from its coefficients, which differs by no more than rounding; and all together, in every build that this processor
 * can run, to the same bits as alone. */
static void reference(void)
{
	static const char *const names[4] = { "Q_ext", "Q_sca", "g", "Q_back" };
	static double x[ROWS], error[ROWS];
	static double complex m[ROWS];
	static struct efficiencies q[ROWS], many[ROWS];
	double streamed = 0;
	FILE *f = open_data("mie_efficiencies.csv");
	char line[4096], *v[16];
	struct worst worst[4] = { { 0 } }, all = { 0 }, estimate = { 0 };
	int rows = 0;
	for (; rows < ROWS && fields(f, line, sizeof line, v, 16) == 12; rows++) {
		x[rows] = atof(v[0]);
		m[rows] = CMPLX(atof(v[1]), atof(v[2]));
		struct efficiencies c = q_of(x[rows], m[rows]);
		if (mie_many(1, &x[rows], &m[rows], &q[rows], &error[rows]))
			exit(2);
		streamed = fmax(streamed, fmax(fmax(off(c.ext, q[rows].ext), off(c.sca, q[rows].sca)), fabs(c.g - q[rows].g)));
		const double got[4] = { q[rows].ext, q[rows].sca, q[rows].g, q[rows].back };
		for (int i = 0; i < 4; i++) {
			double e = off(got[i], atof(v[3 + i]));
			if (getenv("MIE_ROWS"))
				fprintf(stderr, "%s %s %s %s %s %.1e of %.1e\n", v[0], v[1], v[2], v[7], names[i], e, allowed(m[rows], v[8 + i], i == 3));
			note(&worst[i], e / allowed(m[rows], v[8 + i], i == 3), x[rows], m[rows]);
			if (i < 3)
				note(&all, e, x[rows], m[rows]);
		}
		if (strncmp(v[7], "res", 3) && cabs(m[rows] - 1) > 1e-5)
			note(&estimate, fmax(fmax(off(got[0], atof(v[3])), off(got[1], atof(v[4]))), fabs(got[2] - atof(v[5]))) / error[rows],
			     x[rows], m[rows]);
	}
	fclose(f);
	ok(rows == 348, "%d rows of reference efficiencies", rows);
	for (int i = 0; i < 4; i++)
		ok(worst[i].error <= 1, "%s: error at most %.2g of what is allowed, at x = %.17g, m = %.9g+%.9gi", names[i], worst[i].error, worst[i].x,
		   creal(worst[i].m), cimag(worst[i].m));
	bound(&estimate, 10, "error over estimate");
	ok(streamed <= 1e-13, "from coefficients the same within 1e-13 (%.2g)", streamed);
	printf("# over all rows, resonances included: %.2g at x = %.17g, m = %.9g+%.9gi\n", all.error, all.x, creal(all.m), cimag(all.m));
	for (int i = 0; i < CPU_LEVELS; i++) {
		if (!cpu_has(i)) {
			ok(1, "%s # SKIP not here", cpu_name(i));
			continue;
		}
		static double error_of_many[ROWS];
		setenv("MOTES_CPU", cpu_name(i), 1);
		int bad = mie_many(rows, x, m, many, error_of_many);
		ok(!bad && !memcmp(many, q, (size_t)rows * sizeof *q) && !memcmp(error_of_many, error, (size_t)rows * sizeof *error),
		   "%s: all at once are the same to the last bit", cpu_name(i));
	}
	unsetenv("MOTES_CPU");
}

/* An amplitude's error is taken against the forward one: 1e-13 of it, 1e-12 beyond x = 1000, or 20 roundings of m. */
static void amplitudes(void)
{
	FILE *f = open_data("mie_amplitudes.csv");
	char line[4096], *v[16];
	struct worst worst = { 0 };
	struct waves w = { 0, NULL, NULL };
	double x = 0, forward = 1;
	double complex m = 0;
	int rows = 0;
	for (; fields(f, line, sizeof line, v, 16) == 8; rows++) {
		double theta = atof(v[3]);
		double complex want1 = CMPLX(atof(v[4]), atof(v[5])), want2 = CMPLX(atof(v[6]), atof(v[7])), s1, s2;
		if (x != atof(v[0]) || m != CMPLX(atof(v[1]), atof(v[2]))) {
			drop(&w);
			x = atof(v[0]);
			m = CMPLX(atof(v[1]), atof(v[2]));
			w = waves(x, m);
			mie_amplitudes(w.n, w.a, w.b, 1, &(double){ 0 }, &s1, &s2);
			forward = cabs(s1);
		}
		mie_amplitudes(w.n, w.a, w.b, 1, &theta, &s1, &s2);
		double e = fmax(cabs(s1 - want1), cabs(s2 - want2)) / forward;
		if (getenv("MIE_ROWS"))
			fprintf(stderr, "S %s %s %s %s %.1e\n", v[0], v[1], v[2], v[3], e);
		note(&worst, e / fmax(x <= 1000 ? 1e-13 : 1e-12, 20 * 2.2e-16 * 2 * cabs(m) / cabs(m - 1)), x, m);
	}
	fclose(f);
	drop(&w);
	ok(rows == 533, "%d rows of reference amplitudes", rows);
	ok(worst.error <= 1, "S1, S2: error at most %.2g of what is allowed, at x = %.17g, m = %.9g+%.9gi", worst.error, worst.x, creal(worst.m),
	   cimag(worst.m));
}

/* Half a unit of the last digit printed. */
static double half_digit(const char *text)
{
	const char *dot = strchr(text, '.'), *e = strpbrk(text, "eE");
	int decimals = dot ? (int)(e ? e - dot : (long)strlen(dot)) - 1 : 0;
	return 0.500001 * pow(10, (e ? atoi(e + 1) : 0) - decimals);
}

static void published(void)
{
	FILE *f = open_data("published_efficiencies.csv");
	char line[4096], *v[16];
	int rows = 0, bad = 0;
	for (; fields(f, line, sizeof line, v, 8) == 8; rows++) {
		struct efficiencies q = q_of(atof(v[0]), CMPLX(atof(v[1]), atof(v[2])));
		const double got[4] = { q.ext, q.sca, q.g, q.back };
		for (int i = 0; i < 4; i++)
			if (*v[3 + i] && !(fabs(got[i] - atof(v[3 + i])) <= half_digit(v[3 + i]))) {
				printf("# x = %s, m = %s+%si: wanted %s, got %.10g (%s)\n", v[0], v[1], v[2], v[3 + i], got[i], v[7]);
				bad++;
			}
	}
	fclose(f);
	ok(rows == 30 && !bad, "%d published rows to their printed digits, %d values differ", rows, bad);
}

int main(void)
{
	reference();
	amplitudes();
	published();
	return done_testing();
}

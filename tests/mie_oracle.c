/* Lorenz-Mie against reference values, published tables, and the limits of physics. */
#include "tap.h"
#include "waves.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double off(double got, double want)
{
	double e = fabs(got - want) / fabs(want);
	return got == want ? 0 : isnan(e) ? INFINITY : e;
}

/* A row of a CSV file beside the test: fields split in place. Returns their number, 0 at the end. */
static int fields(FILE *f, char *line, size_t size, char **field, int max)
{
	if (!fgets(line, (int)size, f))
		return 0;
	line[strcspn(line, "\n")] = 0;
	int n = 0;
	for (char *c = line; c && n < max; n++) {
		field[n] = c;
		c = strchr(c, ',');
		if (c)
			*c++ = 0;
	}
	return n;
}

static FILE *open_data(const char *name)
{
	char path[256], line[4096];
	snprintf(path, sizeof path, "tests/data/%s", name);
	FILE *f = fopen(path, "r");
	if (!f || !fgets(line, sizeof line, f)) {
		printf("Bail out! cannot read %s\n", path);
		exit(2);
	}
	return f;
}

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

/* Rows that must be met now, and all rows against what conditioning alone would allow, to be seen in the output. */
static void reference(void)
{
	FILE *f = open_data("mie_efficiencies.csv");
	char line[4096], *v[16];
	struct worst ext = { 0 }, sca = { 0 }, g = { 0 }, back = { 0 }, small = { 0 }, all = { 0 }, estimate = { 0 };
	int rows = 0;
	while (fields(f, line, sizeof line, v, 16) == 12) {
		double x = atof(v[0]);
		double complex m = CMPLX(atof(v[1]), atof(v[2]));
		struct waves w = waves(x, m);
		struct efficiencies q = mie_efficiencies(x, cimag(m) == 0, w.n, w.a, w.b);
		double e[4] = { off(q.ext, atof(v[3])), off(q.sca, atof(v[4])), off(q.g, atof(v[5])), off(q.back, atof(v[6])) };
		double top = fmax(fmax(e[0], e[1]), fabs(q.g - atof(v[5])));
		int easy = strncmp(v[7], "res", 3) && cabs(m - 1) > 1e-5;
		if (getenv("MIE_ROWS"))
			fprintf(stderr, "%s %s %s %s  %.1e %.1e %.1e %.1e  est %.1e\n", v[0], v[1], v[2], v[7], e[0], e[1], e[2], e[3],
			        mie_error(x, w.n, w.a, w.b));
		note(&all, top, x, m);
		if (easy) {
			note(x < 0.1 ? &small : &ext, e[0], x, m);
			note(x < 0.1 ? &small : &sca, e[1], x, m);
			note(x < 0.1 ? &small : &g, e[2], x, m);
			note(&back, x < 1e5 ? e[3] : 0, x, m);
			note(&estimate, top / mie_error(x, w.n, w.a, w.b), x, m);
		}
		rows++;
		drop(&w);
	}
	fclose(f);
	ok(rows == 348, "%d rows of reference efficiencies", rows);
	bound(&ext, 1e-8, "Q_ext");
	bound(&sca, 1e-8, "Q_sca");
	bound(&g, 1e-8, "g");
	bound(&back, 1e-6, "Q_back");
	bound(&small, 1e-8, "efficiencies of x < 0.1");
	bound(&estimate, 10, "error over estimate");
	printf("# over all rows, resonances included: %.2g at x = %.17g, m = %.9g+%.9gi\n", all.error, all.x, creal(all.m), cimag(all.m));
}

/* An amplitude's error is taken against the larger of |S1|, |S2| there, or 1e-5 of the forward one: zeros have no relative error.
 * m = 1.000001 has a condition number of 2e6, and as much less is asked of it. */
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
		double scale = fmax(fmax(cabs(want1), cabs(want2)), 1e-5 * forward);
		double e = fmax(cabs(s1 - want1), cabs(s2 - want2)) / scale;
		if (getenv("MIE_ROWS"))
			fprintf(stderr, "S %s %s %s %s %.1e\n", v[0], v[1], v[2], v[3], e);
		note(&worst, cabs(m - 1) > 1e-5 ? e : e / 1e4, x, m);
	}
	fclose(f);
	drop(&w);
	ok(rows == 533, "%d rows of reference amplitudes", rows);
	bound(&worst, 1e-8, "S1, S2");
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
	plan(10);
	reference();
	amplitudes();
	published();
	return 0;
}

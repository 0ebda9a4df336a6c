/* Sums over sizes by the tools against brute sums of 10^5 sizes over the laws' closed forms, of tests/data/law_sums.csv: cross sections by
 * classes and averaged, and mean phase functions. Then figures computed elsewhere, for laws that are wide.
 * law_sums --brute: makes the file. */
#include "optics/mie/mie.h"
#include "support/csv.h"
#include "support/tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIZES 100000
#define ANGLES 181
#define WAVELENGTH 0.55
#define TOLERANCE 2e-4       /* of mean phase functions */

enum { LOGNORMAL, GAMMA, NORMAL, POWER };

/* A law as psd is told, and its closed form between two radii, beyond which 1e-12 of the scattering lies at most. */
static const struct law {
	const char *psd, *particle;
	double complex m;
	int kind;
	double a, b, lo, hi;
} laws[] = {
	{ "gamma --effective-radius 1um --effective-variance 0.1", "1.33", 1.33, GAMMA, 1, 0.1, 1e-3, 8 },
	{ "gamma --effective-radius 0.5um --effective-variance 0.25", "1.5+0.01i", 1.5 + 0.01 * I, GAMMA, 0.5, 0.25, 1e-4, 8 },
	{ "gamma --effective-radius 2um --effective-variance 0.02", "1.5", 1.5, GAMMA, 2, 0.02, 0.2, 6 },
	{ "lognormal --median 0.3um --gsd 1.5", "1.33", 1.33, LOGNORMAL, 0.3, 1.5, 1e-2, 9 },
	{ "lognormal --median 1um --gsd 1.1", "1.5", 1.5, LOGNORMAL, 1, 1.1, 0.4, 3 },
	{ "lognormal --median 0.05um --gsd 1.8", "1.53+0.1i", 1.53 + 0.1 * I, LOGNORMAL, 0.05, 1.8, 1e-4, 6 },
	{ "lognormal --median 0.5um --gsd 1.6 --min 0.4um --max 1.2um", "1.4", 1.4, LOGNORMAL, 0.5, 1.6, 0.4, 1.2 },
	{ "normal --mean 1.5um --stddev 0.3um", "1.33+1e-4i", 1.33 + 1e-4 * I, NORMAL, 1.5, 0.3, 1e-3, 4 },
	{ "normal --mean 1um --stddev 0.02um", "0.75", 0.75, NORMAL, 1, 0.02, 0.8, 1.2 },
	{ "uniform --min 1um --max 2um", "1.33", 1.33, POWER, 0, 0, 1, 2 },
	{ "power --exponent 3.5 --min 0.05um --max 3um", "1.5+0.02i", 1.5 + 0.02 * I, POWER, 3.5, 0, 0.05, 3 },
	{ "power --exponent 2 --min 0.2um --max 2um", "1.45", 1.45, POWER, 2, 0, 0.2, 2 },
};
#define LAWS (sizeof laws / sizeof *laws)

static double number(const struct law *l, double r)    /* n(r), up to a factor */
{
	double t;
	switch (l->kind) {
	case LOGNORMAL:
		t = log(r / l->a) / log(l->b);
		return exp(-t * t / 2) / r;
	case GAMMA:
		return exp((1 - 3 * l->b) / l->b * log(r / l->a) - r / (l->a * l->b) + 1 / l->b);
	case NORMAL:
		t = (r - l->a) / l->b;
		return exp(-t * t / 2);
	default:
		return pow(r / l->hi, -l->a);
	}
}

/* Means by the rule of midpoints in r^(1/3): ext, sca, g, back, and p at whole degrees. */
static void brute(const struct law *l, double sums[4], double p[ANGLES])
{
	double from = cbrt(l->lo), h = (cbrt(l->hi) - from) / SIZES, all = 0, k = 2 * M_PI / WAVELENGTH, theta[ANGLES];
	memset(sums, 0, 4 * sizeof *sums);
	memset(p, 0, ANGLES * sizeof *p);
	for (int i = 0; i < ANGLES; i++)
		theta[i] = i;
	for (int i = 0; i < SIZES; i++) {
		double t = from + (i + 0.5) * h, r = t * t * t, w = number(l, r) * 3 * t * t * h, x = k * r, area = M_PI * r * r;
		all += w;
		if (w * area < 1e-16 * all)
			continue;
		int n = mie_terms(x, l->m);
		double complex a[n + 1], b[n + 1], s1[ANGLES], s2[ANGLES];
		if (mie_coefficients(x, l->m, n, a, b) || mie_amplitudes(n, a, b, ANGLES, theta, s1, s2))
			exit(2);
		struct efficiencies q = mie_efficiencies(x, cimag(l->m) == 0, n, a, b, NULL);
		sums[0] += w * area * q.ext;
		sums[1] += w * area * q.sca;
		sums[2] += w * area * q.sca * q.g;
		sums[3] += w * r * r / 4 * q.back;
		for (int j = 0; j < ANGLES; j++)
			p[j] += w * (creal(s1[j] * conj(s1[j])) + creal(s2[j] * conj(s2[j]))) / (2 * k * k);
	}
	for (int j = 0; j < ANGLES; j++)
		p[j] /= sums[1];
	sums[2] /= sums[1];
	for (int j = 0; j < 4; j++)
		sums[j] /= j == 2 ? 1 : all;
}

static int make_data(void)
{
	printf("law,particle,c_ext,c_sca,g,c_back,p at 0 to 180 degrees\n");
	for (size_t i = 0; i < LAWS; i++) {
		double sums[4], p[ANGLES];
		brute(&laws[i], sums, p);
		printf("%s,%s", laws[i].psd, laws[i].particle);
		for (int j = 0; j < 4; j++)
			printf(",%.10g", sums[j]);
		for (int j = 0; j < ANGLES; j++)
			printf(",%.8g", p[j]);
		printf("\n");
	}
	return 0;
}

/* The next row of the file, which must be the law's. */
static void read_data(FILE *f, const struct law *l, double sums[4], double p[ANGLES])
{
	char line[8192], *field[6 + ANGLES];
	if (fields(f, line, sizeof line, field, 6 + ANGLES) != 6 + ANGLES || strcmp(field[0], l->psd) || strcmp(field[1], l->particle)) {
		printf("Bail out! law_sums.csv lacks %s of %s\n", l->psd, l->particle);
		exit(2);
	}
	for (int j = 0; j < 4; j++)
		sums[j] = atof(field[2 + j]);
	for (int j = 0; j < ANGLES; j++)
		p[j] = atof(field[6 + j]);
}

/* The rows of a pipeline of tools, columns numbers each; returns how many. */
static int rows_of(const char *bin, const char *command, int columns, int most, double *out)
{
	char line[2048];
	snprintf(line, sizeof line, "PATH='%s':$PATH; %s | sed 1d", bin, command);
	FILE *f = popen(line, "r");
	int n = 0;
	while (f && n < most * columns && fscanf(f, "%lf", &out[n]) == 1)
		n++;
	return f && !pclose(f) ? n / columns : 0;
}

/* ext, sca and g, summed over rows of weight c_ext c_sca g error; the largest error. */
static int by_rows(const char *bin, const char *psd, const char *optics, int classes, double v[3], double *error)
{
	char command[512];
	double row[64 * 5];
	snprintf(command, sizeof command, "psd %s --classes %d | xsect %s | tabtxt --columns weight,c_ext,c_sca,g,error", psd, classes, optics);
	int n = rows_of(bin, command, 5, 64, row);
	v[0] = v[1] = v[2] = *error = 0;
	for (int i = 0; i < n; i++) {
		const double *r = row + 5 * i;
		v[0] += r[0] * r[1];
		v[1] += r[0] * r[2];
		v[2] += r[0] * r[2] * r[3];
		*error = fmax(*error, r[4]);
	}
	v[2] /= v[1];
	return n == classes;
}

static double apart(const double v[3], const double want[3])
{
	return fmax(fmax(fabs(v[0] / want[0] - 1), fabs(v[1] / want[1] - 1)), fabs(v[2] - want[2]));
}

static void check(const char *bin, const struct law *l, const double want[4], const double p[ANGLES])
{
	double v[5], error, q[ANGLES], half = 0;
	char optics[128], command[512];
	snprintf(optics, sizeof optics, "--particle %s --wavelength 550nm", l->particle);
	for (int classes = 16; classes > 1; classes /= 4) {
		int there = by_rows(bin, l->psd, optics, classes, v, &error);
		ok(there && apart(v, want) <= error && error < 1e-4, "%s, %s: %d classes off by %.1e (said: %.1e)", l->psd, l->particle, classes, apart(v, want), error);
	}
	snprintf(command, sizeof command, "psd %s | xsect %s --average --tolerance 1e-4 | tabtxt --columns c_ext,c_sca,g,c_back,error", l->psd, optics);
	int n = rows_of(bin, command, 5, 1, v);
	ok(n == 1 && apart(v, want) <= v[4] && v[4] < 1e-4 && fabs(v[3] / want[3] - 1) < 0.02, "averaged: off by %.1e (said: %.1e), c_back by %.1e", apart(v, want),
	   v[4], v[3] / want[3] - 1);
	snprintf(command, sizeof command, "psd %s | mie-phase %s --average --tolerance %g --theta 0:180:1 | tabtxt --columns p", l->psd, optics, TOLERANCE);
	n = rows_of(bin, command, 1, ANGLES, q);
	for (int j = 0; j < ANGLES; j++)
		half += fabs(p[j] - q[j]) * sin(j * M_PI / 180) * M_PI * M_PI / 180;
	ok(n == ANGLES && half < TOLERANCE, "mean phase function: half the integral of |dp| %.1e", half);
}

/* Sums of 10^6 sizes and more, by another program. */
static const struct {
	const char *psd, *optics;
	double want[3];
} known[] = {
	{ "gamma --effective-radius 8um --effective-variance 0.1", "--particle water --wavelength 650nm", { 306.504, 306.503, 0.85720 } },
	{ "lognormal --median 0.5um --gsd 2.2", "--particle 1.53+0.003i --wavelength 532nm", { 6.339486, 5.583084, 0.766870 } },
	{ "power --exponent 3.5 --min 0.1um --max 1mm", "--particle 2.2992+0.022752i --wavelength 1mm", { 8.75058e-3, 7.694244e-3, 0.403317 } },
	{ "lognormal --median 35nm --gsd 1.95", "--particle 1.5+1e-7i --wavelength 550nm", { 6.317802e-3, 6.317798e-3, 0.603528 } },
};

int main(int argc, char **argv)
{
	if (argc == 2 && !strcmp(argv[1], "--brute"))
		return make_data();
	const char *build = getenv("MOTES_BUILD");
	char bin[600];
	if (!build)
		return 2;
	snprintf(bin, sizeof bin, "%s/bin", build);
	FILE *data = open_data("law_sums.csv");
	for (size_t i = 0; i < LAWS; i++) {
		double want[4], p[ANGLES];
		read_data(data, &laws[i], want, p);
		check(bin, &laws[i], want, p);
	}
	fclose(data);
	for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
		double v[3], error;
		for (int classes = 16; classes > 1; classes /= 4) {
			int there = by_rows(bin, known[i].psd, known[i].optics, classes, v, &error);
			ok(there && apart(v, known[i].want) < 1e-4, "%s, %d classes: off by %.1e", known[i].psd, classes, apart(v, known[i].want));
		}
		char command[512];
		snprintf(command, sizeof command, "psd %s | xsect %s --average --tolerance 1e-4 | tabtxt --columns c_ext,c_sca,g", known[i].psd, known[i].optics);
		int n = rows_of(bin, command, 3, 1, v);
		ok(n == 1 && apart(v, known[i].want) < 1e-4, "averaged: off by %.1e", apart(v, known[i].want));
	}
	return done_testing();
}

/* Interference of rays as a mean over sizes has it: all, none, and that of a range of sizes by a few of them. */
#include "optics/goa/goa.h"
#include "support/tap.h"

#include <math.h>
#include <stdlib.h>

enum { ANGLES = 1801 };

static double theta[ANGLES], i1[ANGLES], i2[ANGLES], p1[ANGLES], p2[ANGLES];
static double complex s1[ANGLES], s2[ANGLES];

static void need(int failed)
{
	if (failed)
		exit(2);
}

/* All of it, and, apart from the axes, where the reflected ray keeps to diffraction, next to none. */
static void ends(double complex m, int order, double x)
{
	struct goa *g = goa_new(m, order);
	double all = 0, most = 0, norm;
	int some = 0;
	need(!g || goa_aim(g, ANGLES, theta) || goa_blurred(g, x, 1e6, i1, i2));
	goa_at(g, x, s1, s2);
	for (int k = 0; k < ANGLES; k++) {
		double one = norm2(s1[k]), two = norm2(s2[k]);
		all = fmax(all, fmax(fabs(i1[k] - one), fabs(i2[k] - two)) / (one + two + x));
	}
	need(goa_blurred(g, x, 1e-5, i1, i2) || goa_incoherent(g, x, p1, p2, &norm));
	for (int k = 0; k < ANGLES; k++)
		if (theta[k] > 5 && theta[k] < 175) {
			some += fmax(fabs(i1[k] - p1[k]), fabs(i2[k] - p2[k])) > 1e-9 * (p1[k] + p2[k]);
			most = fmax(most, fabs(norm2(s1[k]) / p1[k] - 1));
		}
	ok(all < 1e-9 && some < ANGLES / 20 && most > 0.5,
	   "m = %g%+gi, order %d, x = %g: all interference within %.1e, none but where two rays are as long (%d of %d angles)",
	   creal(m), cimag(m), order, x, all, some, ANGLES);
	goa_free(g);
}

/* p over sizes from x to twice that, all alike, by so many; fastest: 0, all interferes. */
static void mean(struct goa *g, double x, int sizes, double fastest, double *p)
{
	for (int k = 0; k < ANGLES; k++)
		p[k] = 0;
	for (int i = 0; i < sizes; i++) {
		double at = x * (1 + (i + 0.5) / sizes), norm, error;
		struct efficiencies q;
		need(goa_measure(g, at, &q, &norm, &error) || (fastest > 0 && goa_blurred(g, at, fastest, i1, i2)));
		goa_at(g, at, s1, s2);
		for (int k = 0; k < ANGLES; k++)
			p[k] += (fastest > 0 ? i1[k] + i2[k] : norm2(s1[k]) + norm2(s2[k])) / (2 * norm * sizes);
	}
}

static double distance(const double *p, const double *q)
{
	double sum = 0;
	for (int k = 0; k < ANGLES; k++)
		sum += fabs(p[k] - q[k]) * sin(theta[k] * (M_PI / 180)) * (M_PI * M_PI / (ANGLES - 1));
	return sum;
}

static void of_range(double complex m, double x, double turns)
{
	static double truth[ANGLES], few[ANGLES], blurred[ANGLES];
	struct goa *g = goa_new(m, 3);
	need(!g || goa_aim(g, ANGLES, theta));
	mean(g, x, (int)(6 * x), 0, truth);
	mean(g, x, 128, 0, few);
	mean(g, x, 128, turns / x, blurred);
	double want = 0.15 / x + (creal(m) < 1 ? 0.1 : 0.01) / turns, got = distance(truth, blurred), bare = distance(truth, few);
	ok(got < 2 * want && got < bare / 2, "m = %g%+gi, x = %g to %g: 128 sizes are off by %.1e, 128 blurred ones by %.1e, expected %.1e",
	   creal(m), cimag(m), x, 2 * x, bare, got, want);
	goa_free(g);
}

int main(void)
{
	for (int k = 0; k < ANGLES; k++)
		theta[k] = 180.0 * k / (ANGLES - 1);
	ends(1.33, 3, 1000.3);
	ends(1.5 + 0.001 * I, 5, 77.7);
	ends(0.75, 3, 5000.1);
	of_range(1.33, 500, 60);
	of_range(1.33, 2000, 60);
	of_range(1.5 + 0.001 * I, 500, 60);
	of_range(0.75, 1000, 200);
	return done_testing();
}

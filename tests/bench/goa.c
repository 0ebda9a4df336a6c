/* L1 and time of GOA, GOA+ and Mie's direct sum, as lines for goa.sh. */
#include "support/goa_compare.h"

#include <math.h>
#include <stdio.h>
#include <time.h>

static double seconds(void)
{
	struct timespec t;
	clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

enum { GOA, PLUS, MIE, MODELS };

/* Time of a size near x, at 1801 angles: rays found before, norm and all. */
static void model_at(int model, struct goa *goa, struct goa_plus *plus, double x, double complex m, int n, const double *theta,
                     double complex *s1, double complex *s2)
{
	struct efficiencies q;
	double norm, error;
	if (model == GOA) {
		goa_measure(goa, x, &q, &norm, &error);
		goa_at(goa, x, s1, s2);
	} else if (model == PLUS) {
		goa_plus_at(plus, x, s1, s2, &q);
	} else {
		mie(x, m, n, theta, s1, s2);
	}
}

/* Lines m, x, model, L1, ns a size and angle, that over Mie's, us to find the rays of an angle. Models in turn, the best of
 * several. */
int main(void)
{
	enum { N = 1801 };
	static const char *const name[MODELS] = { "goa", "goa+", "mie" };
	static const double complex index[] = { 1.33, 1.5 + 0.1 * I, 0.75 };
	static const double size[] = { 30.49, 100.49, 300.49, 1000.49, 3000.49, 10000.49, 30000.49 };
	static double theta[N];
	static double complex s1[N], s2[N];
	for (int k = 0; k < N; k++)
		theta[k] = 180.0 * k / (N - 1);
	printf("# m\tx\tmodel\tL1\tns\tratio\taim\n");
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 7; j++) {
			double complex m = index[i];
			double x = size[j], best[MODELS] = { INFINITY, INFINITY, INFINITY };
			double aim[MODELS] = { INFINITY, INFINITY, 0 };
			struct compared apart[MODELS] = { { 0 } };
			for (int round = 0; round < 5; round++) {
				double t0 = seconds();
				struct goa *goa = goa_new(m, 3);
				goa_aim(goa, N, theta);
				double t1 = seconds();
				struct goa_plus *plus = goa_plus_new(m);
				goa_plus_aim(plus, N, theta);
				aim[PLUS] = fmin(aim[PLUS], seconds() - t1);
				aim[GOA] = fmin(aim[GOA], t1 - t0);
				for (int model = 0; model < MODELS; model++) {
					int sizes = model == MIE ? 1 : 64;
					model_at(model, goa, plus, x, m, N, theta, s1, s2);
					double from = seconds();
					for (int k = 0; k < sizes; k++)
						model_at(model, goa, plus, x * (1 + 1e-3 * k), m, N, theta, s1, s2);
					best[model] = fmin(best[model], (seconds() - from) / sizes);
				}
				goa_free(goa);
				goa_plus_free(plus);
			}
			if (x < 2e4) {
				apart[GOA] = compare(x, m, 3);
				apart[PLUS] = compare(x, m, -1);
			}
			for (int model = 0; model < MODELS; model++)
				printf("%g%+gi\t%g\t%s\t%.3g\t%.3g\t%.3g\t%.3g\n", creal(m), cimag(m), x, name[model],
				       apart[model].l1, best[model] / N * 1e9, best[model] / best[MIE], aim[model] / N * 1e6);
		}
	return 0;
}

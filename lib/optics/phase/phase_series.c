#include "optics/phase/phase_series.h"

#include "optics/numerics/legendre_series.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK 1024

/* Two series: of p, and of p sin^4(theta/2), whose rounding is not that of the forward peak. */
struct phase_series {
	int n;
	double (*c)[LEGENDRE_SERIES_SUMS];     /* [n] */
	double most[2];                        /* of either: a bound */
	struct legendre_series *ready;
};

/* sin^4(theta/2) takes two orders. */
int phase_series_steps(int terms) { return legendre_series_steps(2 * terms + 3); }

/* Symmetric as doubles: a sum over partial waves serves an angle in front and its like behind. */
double phase_series_theta(int steps, int j)
{
	int front = 2 * j < steps ? j : steps - 1 - j;
	double behind = 180 - 180 * (front + 0.5) / steps;
	return front == j ? 180 - behind : behind;
}

static double flat(double theta)
{
	double s = sin(theta * (M_PI / 360));
	return s * s * s * s;
}

struct phase_series *phase_series_new(void) { return calloc(1, sizeof(struct phase_series)); }

int phase_series_add(struct phase_series *s, int steps, const double *value)
{
	double *v = malloc(2 * (size_t)steps * sizeof *v), *c = v + steps, most[2] = { 0, 0 };
	int failed = !v;
	if (!failed && steps > s->n) {
		double (*more)[LEGENDRE_SERIES_SUMS] = realloc(s->c, (size_t)steps * sizeof *more);
		failed = !more;
		if (!failed) {
			memset(more + s->n, 0, (size_t)(steps - s->n) * sizeof *more);
			s->c = more;
			s->n = steps;
		}
	}
	for (int sum = 0; !failed && sum < 2; sum++) {
		for (int j = 0; j < steps; j++) {
			v[j] = value[j] * (sum ? flat(phase_series_theta(steps, j)) : 1);
			most[sum] = fmax(most[sum], fabs(v[j]));
		}
		failed = legendre_series_cosines(steps, v, c);
		for (int k = 0; !failed && k < steps; k++)
			s->c[k][sum] += c[k];
		s->most[sum] += most[sum];
	}
	free(v);
	return failed ? -1 : 0;
}

int phase_series_ready(struct phase_series *s)
{
	s->ready = legendre_series_of_cosines(s->n - 1, (const double (*)[LEGENDRE_SERIES_SUMS])s->c);
	return s->ready ? 0 : -1;
}

void phase_series_at(const struct phase_series *s, long n, const double *theta, double *value)
{
	double sums[BLOCK][LEGENDRE_SERIES_SUMS];
	for (long from = 0; from < n; from += BLOCK) {
		int count = n - from < BLOCK ? (int)(n - from) : BLOCK;
		legendre_series_at(s->ready, count, theta + from, sums);
		for (int i = 0; i < count; i++) {
			double f = flat(theta[from + i]);
			value[from + i] = fmax(f * s->most[0] > s->most[1] ? sums[i][1] / f : sums[i][0], 0);
		}
	}
}

void phase_series_free(struct phase_series *s)
{
	if (!s)
		return;
	legendre_series_free(s->ready);
	free(s->c);
	free(s);
}

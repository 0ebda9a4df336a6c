#include "optics/numerics/legendre_series_lanes.h"

#include <stdlib.h>

const struct legendre_series_lanes *legendre_series_lanes(void)
{
	const struct legendre_series_lanes *const build[CPU_LEVELS] = CPU_BUILDS(&legendre_series_lanes);
	return build[cpu_level()];
}

/* The shortest grid with a length that the transform likes: 16 2^a or 16 3 2^a, at least twice the highest order. */
static int steps_for(int n)
{
	int two = 32, three = 48;
	while (two < 2 * n)
		two *= 2;
	while (three < 2 * n)
		three *= 2;
	return two < three ? two : three;
}

struct legendre_series *legendre_series_new(int n, double (*c)[LEGENDRE_SERIES_SUMS])
{
	struct legendre_series *s = malloc(sizeof *s);
	if (!s)
		return NULL;
	s->lanes = legendre_series_lanes();
	s->steps = steps_for(n);
	s->grid = malloc(((size_t)s->steps + 2 * LEGENDRE_SERIES_PAD) * LEGENDRE_SERIES_SUMS * sizeof *s->grid);
	if (!s->grid || s->lanes->prepare(s, n, c)) {
		legendre_series_free(s);
		return NULL;
	}
	return s;
}

void legendre_series_at(const struct legendre_series *s, int count, const double *theta, double (*values)[LEGENDRE_SERIES_SUMS])
{
	s->lanes->at(s, count, theta, values);
}

void legendre_series_free(struct legendre_series *s)
{
	if (s)
		free(s->grid);
	free(s);
}

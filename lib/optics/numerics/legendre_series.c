#include "optics/numerics/legendre_series_kernels.h"

#include <stdlib.h>

const struct series_kernels *legendre_series_lanes(void)
{
	const struct series_kernels *const build[CPU_LEVELS] = CPU_BUILDS(&legendre_series_lanes);
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

struct series *series_new(int n, double (*c)[SERIES])
{
	struct series *s = malloc(sizeof *s);
	if (!s)
		return NULL;
	s->kernels = legendre_series_lanes();
	s->steps = steps_for(n);
	s->grid = malloc(((size_t)s->steps + 2 * SERIES_PAD) * SERIES * sizeof *s->grid);
	if (!s->grid || s->kernels->prepare(s, n, c)) {
		series_free(s);
		return NULL;
	}
	return s;
}

void series_at(const struct series *s, int count, const double *theta, double (*values)[SERIES])
{
	s->kernels->at(s, count, theta, values);
}

void series_free(struct series *s)
{
	if (s)
		free(s->grid);
	free(s);
}

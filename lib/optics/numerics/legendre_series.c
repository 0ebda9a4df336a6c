#include "optics/numerics/legendre_series_lanes.h"

#include <math.h>
#include <stdlib.h>

const struct legendre_series_lanes *legendre_series_lanes(void)
{
	const struct legendre_series_lanes *const build[CPU_LEVELS] = CPU_BUILDS(&legendre_series_lanes);
	return build[cpu_level()];
}

int legendre_series_steps(int least)
{
	int two = 32, three = 48;
	while (two < least)
		two *= 2;
	while (three < least)
		three *= 2;
	return two < three ? two : three;
}

static struct legendre_series *begin(int n)
{
	struct legendre_series *s = malloc(sizeof *s);
	if (!s)
		return NULL;
	s->lanes = legendre_series_lanes();
	s->steps = legendre_series_steps(2 * n);
	s->grid = malloc(((size_t)s->steps + 2 * LEGENDRE_SERIES_PAD) * LEGENDRE_SERIES_SUMS * sizeof *s->grid);
	if (s->grid)
		return s;
	free(s);
	return NULL;
}

struct legendre_series *legendre_series_new(int n, double (*c)[LEGENDRE_SERIES_SUMS])
{
	struct legendre_series *s = begin(n);
	if (!s || !s->lanes->prepare(s, n, c))
		return s;
	legendre_series_free(s);
	return NULL;
}

struct legendre_series *legendre_series_of_cosines(int n, const double (*c)[LEGENDRE_SERIES_SUMS])
{
	struct legendre_series *s = begin(n);
	if (!s || !s->lanes->cosines(s, n, c))
		return s;
	legendre_series_free(s);
	return NULL;
}

/* Makhoul 1980, as in legendre_series_lanes.c, the other way. */
int legendre_series_cosines(int steps, const double *value, double *c)
{
	const struct legendre_series_lanes *lanes = legendre_series_lanes();
	size_t room = 2 * (size_t)steps;
	double *fft = calloc(5 * room, sizeof *fft);
	if (!fft)
		return -1;
	double *re[2] = { fft, fft + room }, *im[2] = { fft + 2 * room, fft + 3 * room }, *wave = fft + 4 * room;
	lanes->waves(steps, wave);
	for (int j = 0; j < steps; j++)
		re[0][2 * (j % 2 ? steps - 1 - j / 2 : j / 2)] = value[j];
	int at = lanes->fourier(steps, wave, re, im);
	for (int k = 0; k < steps; k++) {
		double a = M_PI * k / (2.0 * steps);
		c[k] = (re[at][2 * k] * cos(a) - im[at][2 * k] * sin(a)) * (k ? 2.0 : 1.0) / steps;
	}
	free(fft);
	return 0;
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

#include "toolkit/angle_refinement.h"

#include "optics/phase/angle_grid.h"

#include <math.h>
#include <stdlib.h>

#define BLOCK 4096      /* angles whose amplitudes are held at a time */

void adapt_power(double norm, long n, const double complex *s1, const double complex *s2, double *p)
{
	for (long i = 0; i < n; i++) {
		double re1 = creal(s1[i]), im1 = cimag(s1[i]), re2 = creal(s2[i]), im2 = cimag(s2[i]);
		p[i] = (re1 * re1 + im1 * im1 + re2 * re2 + im2 * im2) / (2 * norm);
	}
}

int adapt_p(const struct phase_profile *profile, const struct phase_state *s, long n, const double *theta, double *p)
{
	double complex *s1 = malloc(2 * BLOCK * sizeof *s1), *s2 = s1 + BLOCK;
	int failed = !s1;
	for (long from = 0; !failed && from < n; from += BLOCK) {
		int count = n - from < BLOCK ? (int)(n - from) : BLOCK;
		failed = profile->at(s, count, theta + from, s1, s2);
		if (!failed)
			adapt_power(s->norm, count, s1, s2, p + from);
	}
	free(s1);
	return failed ? -1 : 0;
}

int adapt(const struct phase_profile *profile, const void *context, double tolerance, struct adapted *a)
{
	double x = 0;
	for (size_t i = 0; i < a->nwaves; i++)
		x = fmax(x, size_extent(&a->w[i].size));
	long n = angle_grid_fine(x, tolerance, NULL), *keep = malloc((size_t)n * sizeof *keep);
	double *values = malloc(a->nwaves * (size_t)n * sizeof *values), **p = malloc(a->nwaves * sizeof *p);
	a->theta = malloc((size_t)n * sizeof *a->theta);
	a->state = calloc(a->nwaves, sizeof *a->state);
	int failed = !keep || !values || !p || !a->theta || !a->state;
	if (!failed)
		angle_grid_fine(x, tolerance, a->theta);
	for (size_t i = 0; !failed && i < a->nwaves; i++) {
		p[i] = values + i * (size_t)n;
		a->state[i] = profile->open(context, &a->w[i], (size_t)n);
		failed = !a->state[i] || adapt_p(profile, a->state[i], n, a->theta, p[i]);
	}
	if (!failed) {
		a->n = angle_grid_thin(n, a->theta, (int)a->nwaves, p, tolerance, keep);
		failed = a->n < 0;
		for (long i = 0; i < a->n; i++)
			a->theta[i] = a->theta[keep[i]];
	}
	free(keep);
	free(values);
	free(p);
	return failed ? -1 : 0;
}

void adapt_free(const struct phase_profile *profile, struct adapted *a)
{
	for (size_t i = 0; a->state && i < a->nwaves; i++)
		if (a->state[i])
			profile->close(a->state[i]);
	free(a->state);
	free(a->theta);
}

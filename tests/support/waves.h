/* Coefficients and efficiencies of a sphere, for the tests of Lorenz-Mie theory. */
#ifndef SUPPORT_WAVES_H
#define SUPPORT_WAVES_H

#include "optics/mie/mie.h"

#include <stdlib.h>

struct waves {
	int n;
	double complex *a, *b;
};

static inline struct waves waves(double x, double complex m)
{
	struct waves w = { mie_terms(x, m), NULL, NULL };
	w.a = malloc(((size_t)w.n + 1) * sizeof *w.a);
	w.b = malloc(((size_t)w.n + 1) * sizeof *w.b);
	if (!w.a || !w.b || mie_coefficients(x, m, w.n, w.a, w.b))
		exit(2);
	return w;
}

static inline void drop(struct waves *w)
{
	free(w->a);
	free(w->b);
}

static inline struct efficiencies q_of(double x, double complex m)
{
	struct waves w = waves(x, m);
	struct efficiencies q = mie_efficiencies(x, cimag(m) == 0, w.n, w.a, w.b, NULL);
	drop(&w);
	return q;
}

#endif

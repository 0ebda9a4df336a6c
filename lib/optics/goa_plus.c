#include "optics/goa_plus.h"

#include "optics/plus_rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct goa_plus {
	double complex m;
	struct plus_rays axes, asked;
};

struct goa_plus *goa_plus_new(double complex m)
{
	struct goa_plus *g = calloc(1, sizeof *g);
	if (!g)
		return NULL;
	g->m = m;
	if (plus_rays_find(m, 2, (double[]){ 0, 180 }, &g->axes)) {
		free(g);
		return NULL;
	}
	return g;
}

void goa_plus_free(struct goa_plus *g)
{
	if (!g)
		return;
	plus_rays_free(&g->axes);
	plus_rays_free(&g->asked);
	free(g);
}

int goa_plus_aim(struct goa_plus *g, int n, const double *theta)
{
	if (n && n == g->asked.n && !memcmp(theta, g->asked.theta, (size_t)n * sizeof *theta))
		return 0;
	plus_rays_free(&g->asked);
	return plus_rays_find(g->m, n, theta, &g->asked);
}

static int amplitudes(const struct plus_rays *r, const struct edge *e, double complex *s1, double complex *s2)
{
	for (int k = 0; k < r->n; k++)
		s1[k] = s2[k] = 0;
	if (edge_add(e, r->n, r->theta, s1, s2))
		return -1;
	plus_rays_add(r, e, s1, s2);
	return 0;
}

int goa_plus_at(struct goa_plus *g, double x, double complex *s1, double complex *s2, struct efficiencies *q)
{
	double complex axis1[2], axis2[2];
	struct edge e;
	*q = (struct efficiencies){ 0 };
	if (edge_new(&e, x, g->m))
		return -1;
	int failed = amplitudes(&g->asked, &e, s1, s2) || amplitudes(&g->axes, &e, axis1, axis2);
	if (!failed) {
		q->ext = 4 * creal(axis1[0]) / (x * x);
		q->abs = edge_absorption(&e);
		q->sca = q->ext - q->abs;
		q->back = 4 * creal(axis1[1] * conj(axis1[1])) / (x * x);
		if (!(q->sca > 0))      /* far from where this holds */
			q->sca = 1;
	}
	edge_free(&e);
	return failed ? -1 : 0;
}

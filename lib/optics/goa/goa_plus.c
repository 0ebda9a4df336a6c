#include "optics/goa/goa_plus.h"

#include "optics/goa/goa_plus_lanes.h"

#include <math.h>
#include <stdlib.h>

struct goa_plus {
	double complex m;
	const struct goa_plus_lanes *lanes;
	struct goa_plus_rays axes, asked;
};

struct goa_plus *goa_plus_new(double complex m)
{
	struct goa_plus *g = calloc(1, sizeof *g);
	if (!g)
		return NULL;
	g->m = m;
	g->lanes = goa_plus_lanes();
	if (goa_plus_rays_find(m, 2, (double[]){ 0, 180 }, &g->axes)) {
		free(g);
		return NULL;
	}
	return g;
}

void goa_plus_free(struct goa_plus *g)
{
	if (!g)
		return;
	goa_plus_rays_free(&g->axes);
	goa_plus_rays_free(&g->asked);
	free(g);
}

int goa_plus_aim(struct goa_plus *g, int n, const double *theta)
{
	if (angle_blocks_are(&g->asked.blocks, n, theta))
		return 0;
	goa_plus_rays_free(&g->asked);
	return goa_plus_rays_find(g->m, n, theta, &g->asked);
}

static void amplitudes(const struct goa_plus_lanes *lanes, const struct goa_plus_rays *r, const struct goa_plus_edge *e,
                       double complex *s1, double complex *s2)
{
	for (int b = 0, from = 0; from < r->blocks.n; b++, from += GOA_WIDTH) {
		double s[4][GOA_WIDTH] = { { 0 } };
		lanes->waves(e, &r->edge[b], s);
		if (!e->windows.whole)
			lanes->rays(&r->packet[r->blocks.first[b]], r->blocks.first[b + 1] - r->blocks.first[b], e, s);
		for (int i = 0; i < GOA_WIDTH && from + i < r->blocks.n; i++) {
			s1[from + i] = CMPLX(s[0][i], s[1][i]);
			s2[from + i] = CMPLX(s[2][i], s[3][i]);
		}
	}
	if (!e->windows.whole)
		goa_plus_caustics_add(&r->caustics, e, s1, s2);
}

int goa_plus_at(const struct goa_plus *g, double x, double complex *s1, double complex *s2, struct efficiencies *q)
{
	double complex axis1[2], axis2[2];
	struct goa_plus_edge e = { 0 };
	*q = (struct efficiencies){ 0 };
	if (goa_plus_edge_set(g->lanes, &e, x, g->m)) {
		goa_plus_edge_free(&e);
		return -1;
	}
	amplitudes(g->lanes, &g->asked, &e, s1, s2);
	amplitudes(g->lanes, &g->axes, &e, axis1, axis2);
	q->ext = 4 * creal(axis1[0]) / (x * x);
	q->abs = g->lanes->absorption(&e);
	goa_plus_edge_free(&e);
	q->sca = q->ext - q->abs;
	q->back = 4 * creal(axis1[1] * conj(axis1[1])) / (x * x);
	if (!(q->sca > 0))      /* far from where this holds */
		q->sca = 1;
	return 0;
}

double goa_plus_error(double x, double complex m)
{
	double n = creal(m);
	/* where an index near 1 leaves rays that are not distinct, beyond what is summed as waves */
	if (x > GOA_PLUS_SOFT_MAX && x * fabs(n - 1) < GOA_PLUS_SOFT)
		return 1;
	/* resonances of a small sphere of high index, a little beside their places; what orders left out hold between strong mirrors */
	return fmin(1, 0.005 + (0.1 + 2 * fmax(n - 1, 0)) / x + 0.0035 * fmax(n - 2.5, 0));
}

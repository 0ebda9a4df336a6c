#include "optics/goa/goa_plus_rays.h"

#include "optics/numerics/airy.h"

#include <math.h>

/* What the window leaves to rays. */
static double left(const struct goa_plus_edge *e, int p, double u)
{
	return 1 - goa_plus_window_at(&e->windows.order[p], u);
}

static void add_rainbow(const struct goa_plus_rainbow *r, const struct goa_plus_edge *e, double complex *s1, double complex *s2)
{
	double x = e->x, third = cbrt(x), wa = left(e, r->p, r->ua), wb = left(e, r->p, r->ub);
	if ((wa == 0 && wb == 0) || fmax(creal(r->fade_a), creal(r->fade_b)) * x < -GOA_PLUS_ABSORBED)
		return;
	struct airy airy = airy_real(-third * third * r->zeta);
	double complex fa = wa, fb = wb, common = cexp(I * x * r->path);
	if (r->fade_a != 0 || r->fade_b != 0) {
		fa *= cexp(x * r->fade_a);
		fb *= cexp(x * r->fade_b);
	}
	common *= x * sqrt(third) / sqrt(fmax(r->sine, 0.5 / (x * r->u)));
	double complex over = r->over_rho / third;
	*s1 += common * ((r->a[0] * fa + r->b[0] * fb) * airy.ai + over * (r->b[0] * fb - r->a[0] * fa) * airy.aip);
	*s2 += common * ((r->a[1] * fa + r->b[1] * fb) * airy.ai + over * (r->b[1] * fb - r->a[1] * fa) * airy.aip);
}

static void add_glory(const struct goa_plus_glory *g, const struct goa_plus_edge *e, double complex *s1, double complex *s2)
{
	double x = e->x, w = left(e, g->p, g->u), z = x * g->z;
	if (w == 0 || g->fade * x > GOA_PLUS_ABSORBED)
		return;
	double b0 = j0(z), b1 = j1(z), b2 = z > 1e-3 ? 2 * b1 / z - b0 : z * z / 8, slope = z > 1e-3 ? b1 - 2 * b2 / z : z / 4;
	double complex common = w * x * sqrt(x) * exp(-x * g->fade) * cexp(I * x * g->path);
	int even = g->back;      /* forward S1 + S2 goes with J0, behind S1 - S2 */
	double complex zero = common * (g->even[even] * b0 + I * g->odd[even] * b1);
	double complex two = common * (-g->even[!even] * b2 + I * g->odd[!even] * slope);
	*s1 += zero + two;
	*s2 += even ? two - zero : zero - two;
}

void goa_plus_caustics_add(const struct goa_plus_rays *r, const struct goa_plus_edge *e, double complex *s1, double complex *s2)
{
	for (int k = 0; k < r->rainbows; k++)
		if (e->x < r->rainbow[k].below)
			add_rainbow(&r->rainbow[k], e, &s1[r->rainbow[k].angle], &s2[r->rainbow[k].angle]);
	for (int k = 0; k < r->glories; k++)
		if (e->x < r->glory[k].below)
			add_glory(&r->glory[k], e, &s1[r->glory[k].angle], &s2[r->glory[k].angle]);
}

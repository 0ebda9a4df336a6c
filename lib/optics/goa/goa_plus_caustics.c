#include "optics/goa/goa_plus_caustics.h"

#include "optics/goa/debye_order.h"
#include "optics/numerics/airy.h"

#include <math.h>
#include <stdlib.h>

#define ZETA_BRIGHT 5      /* Airy pairs as long as zeta is below; the rays' second order is then good to 1e-3 */
#define ZETA_DARK 6        /* on the dark side nothing is left beyond */
#define Z_GLORY 20         /* Bessel pairs below */
#define LEAST_SIZE 100     /* below, all is waves (goa_plus_windows.c): pairs that serve no larger size are left out */
#define NEAR 0.5           /* rad from an axis within which glories are looked for */

static double complex eighth(int k)
{
	static const double complex root[8] = { 1, CMPLX(M_SQRT1_2, M_SQRT1_2), I, CMPLX(-M_SQRT1_2, M_SQRT1_2),
		-1, CMPLX(-M_SQRT1_2, -M_SQRT1_2), -I, CMPLX(M_SQRT1_2, -M_SQRT1_2) };
	return root[(k % 8 + 8) % 8];
}

static int grow(void *list, int n, size_t size)
{
	void **at = list;
	if (n & (n - 1))           /* doubled at powers of 2 */
		return 0;
	void *more = realloc(*at, (n ? 2 * (size_t)n : 1) * size);
	if (!more)
		return -1;
	*at = more;
	return 0;
}

/* The complex angle of incidence with tau, near the rainbow. */
static double complex incidence(double n, int p, double complex i, double tau)
{
	for (int k = 0; k < 40; k++) {
		double complex s = csin(i), c = ccos(i);
		double complex step = (2 * i - 2 * p * casin(s / n) - tau) / (2 - 2 * p * c / csqrt((n - 1) * (n + 1) + c * c));
		if (cabs(step) > 0.3)
			step *= 0.3 / cabs(step);
		i -= step;
		if (cabs(step) < 1e-15)
			break;
	}
	return i;
}

/* Chester-Friedman-Ursell: S = sqrt(pi) e^(iX) { (G_A h_A + G_B h_B) Ai(-zeta) + i [(G_B h_B - G_A h_A)/rho] Ai'(-zeta) }.
 * eighths: of the ray inside the rainbow's, whose Theta' < 0. Returns the size from which on rays do without. */
static double rainbow(const struct goa_plus_direction *d, double tau, int eighths, struct goa_plus_rainbow *out)
{
	double n = creal(d->m), c = d->caustic.incidence, bend = d->caustic.bend, beside = tau - d->caustic.tau;
	if (fabs(beside) < 5e-7 * bend)
		beside = 5e-7 * bend;
	tau = d->caustic.tau + beside;
	double complex part = csqrt(2 * beside / bend);
	double complex at[2] = { incidence(n, d->p, c - part, tau), incidence(n, d->p, c + part, tau) };
	double complex slope[2], path[2], g[2][2], u[2];
	for (int k = 0; k < 2; k++) {
		double complex f[2], ci = ccos(at[k]);
		u[k] = csin(at[k]);
		slope[k] = 2 - 2 * d->p * ci / csqrt((n - 1) * (n + 1) + ci * ci);
		path[k] = debye_order_path(d->p, n, u[k]);
		debye_order_amplitude(d->p, d->m, u[k], 0, f);
		for (int j = 0; j < 2; j++)
			g[k][j] = -f[j] * csqrt(u[k] * ci) * sqrt(M_PI) * eighth(eighths - 1);
	}
	double complex rho = slope[1] * cpow(0.75 * (path[1] - path[0]) / (slope[1] * slope[1] * slope[1]), 1.0 / 3);
	double complex ha = csqrt(-rho / slope[0]), hb = csqrt(rho / slope[1]);
	*out = (struct goa_plus_rainbow){ .angle = d->angle, .p = d->p, .sine = d->sine, .u = sin(c),
		.path = creal(path[0] + path[1]) / 2, .zeta = creal(rho * rho), .over_rho = I / rho,
		.ua = beside > 0 ? creal(u[0]) : sin(c), .ub = beside > 0 ? creal(u[1]) : sin(c) };
	for (int j = 0; j < 2; j++) {
		out->a[j] = g[0][j] * ha;
		out->b[j] = g[1][j] * hb;
	}
	if (cimag(d->m) != 0) {
		out->fade_a = I * (debye_order_path(d->p, d->m, u[0]) - path[0]);
		out->fade_b = I * (debye_order_path(d->p, d->m, u[1]) - path[1]);
		if (creal(out->fade_a) > 0 || creal(out->fade_b) > 0) /* a wave absorbed far too much to be near the real ray */
			out->fade_a = out->fade_b = -INFINITY;
	}
	double most = out->zeta > 0 ? ZETA_BRIGHT : ZETA_DARK;
	return out->below = out->zeta ? pow(most / fabs(out->zeta), 1.5) : INFINITY;
}

/* Two rays that meet on an axis off-centre; plus is the one whose phase grows with the distance from it. */
static double glory(const struct goa_plus_direction *d, int back, const struct ray *plus, const struct ray *minus,
                    struct goa_plus_glory *out)
{
	double complex path = debye_order_path(d->p, d->m, plus->sin_i), other = debye_order_path(d->p, d->m, minus->sin_i);
	double z = fmax(creal(path - other) / 2, 0), ratio = d->sine > 0 ? z / d->sine : plus->sin_i;
	double complex half[2][2];      /* [plus, minus][(S1+S2)/2, (S1-S2)/2] */
	*out = (struct goa_plus_glory){ .angle = d->angle, .p = d->p, .back = back, .path = creal(path + other) / 2, .z = z,
		.u = (plus->sin_i + minus->sin_i) / 2, .fade = cimag(path + other) / 2 };
	for (int k = 0; k < 2; k++) {
		const struct ray *r = k ? minus : plus;
		double complex f[2];
		debye_order_amplitude(d->p, d->m, r->sin_i, 0, f);
		double complex scale =
		    -sqrt(r->sin_i * r->cos_i / r->slope * M_PI_2 * ratio) * eighth(k ? r->eighths - 1 : r->eighths + 1);
		half[k][0] = scale * (f[0] + f[1]) / 2;
		half[k][1] = scale * (f[0] - f[1]) / 2;
	}
	for (int j = 0; j < 2; j++) {
		out->even[j] = half[0][j] + half[1][j];
		out->odd[j] = half[0][j] - half[1][j];
	}
	return out->below = z > 0 ? Z_GLORY / z : INFINITY;
}

double goa_plus_caustics_reach(const struct caustic *c)
{
	/* zeta x^(2/3) is about |tau - tau_R| over the width of the Airy function, which is off by 2 at most */
	double narrow = LEAST_SIZE * cos(c->incidence);
	return 2 * ZETA_DARK * cbrt(c->bend / (2 * narrow * narrow));
}

int goa_plus_caustics_rainbow(struct goa_plus_caustics *c, const struct goa_plus_direction *d, double tau, int eighths, double *from)
{
	if (grow(&c->rainbow, c->rainbows, sizeof *c->rainbow))
		return -1;
	*from = rainbow(d, tau, eighths, &c->rainbow[c->rainbows]);
	if (*from < LEAST_SIZE)
		*from = 0;
	else
		c->rainbows++;
	return 0;
}

int goa_plus_caustics_glory(struct goa_plus_caustics *c, const struct goa_plus_direction *d, const struct branch *b, int side, int turns,
                            const struct ray *r, double *from)
{
	double rest = 180 - d->theta, front = d->theta < 90, near = fmin(d->theta, rest) * (M_PI / 180);
	int own = front == d->p % 2;    /* the axis of the central ray */
	struct ray other;
	*from = 0;
	if (near > NEAR || !rays_at(creal(d->m), d->p, &d->caustic, b, d->theta, -side, own ? turns : turns + side, &other))
		return 0;
	if (own && turns == 0 && b->central)
		return 0;
	int plus = front ? r->sigma > 0 : r->sigma < 0;
	struct goa_plus_glory g;
	double size = plus ? glory(d, !front, r, &other, &g) : glory(d, !front, &other, r, &g);
	if (size < LEAST_SIZE)
		return 0;
	*from = size;
	if (plus) {
		if (grow(&c->glory, c->glories, sizeof *c->glory))
			return -1;
		c->glory[c->glories++] = g;
	}
	return 0;
}

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

void goa_plus_caustics_add(const struct goa_plus_caustics *c, const struct goa_plus_edge *e, double complex *s1, double complex *s2)
{
	for (int k = 0; k < c->rainbows; k++)
		if (e->x < c->rainbow[k].below)
			add_rainbow(&c->rainbow[k], e, &s1[c->rainbow[k].angle], &s2[c->rainbow[k].angle]);
	for (int k = 0; k < c->glories; k++)
		if (e->x < c->glory[k].below)
			add_glory(&c->glory[k], e, &s1[c->glory[k].angle], &s2[c->glory[k].angle]);
}

void goa_plus_caustics_free(struct goa_plus_caustics *c)
{
	free(c->rainbow);
	free(c->glory);
	*c = (struct goa_plus_caustics){ 0 };
}

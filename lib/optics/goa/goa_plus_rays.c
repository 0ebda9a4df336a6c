#include "optics/goa/goa_plus_rays.h"

#include "optics/goa/debye_order.h"
#include "optics/goa/rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NOTHING 1e-5       /* rays fainter than this part of x are left out */
#define ZETA_BRIGHT 5      /* Airy pairs as long as zeta is below; the rays' second order is then good to 1e-3 */
#define ZETA_DARK 6        /* on the dark side nothing is left beyond */
#define Z_GLORY 20         /* Bessel pairs below */
#define LEAST_SIZE 100     /* below, all is waves (goa_plus_edge.c): pairs that serve no larger size are left out */
#define NEAR 0.5           /* rad from an axis within which glories are looked for */
#define RAYS 64            /* most rays of one order in one direction, with room */

/* One direction of one order, while its rays are gathered. */
struct direction {
	double complex m;
	double theta, sine;        /* degrees */
	int angle, p;
	struct caustic caustic;
	int n;
	struct {
		struct ray ray;
		struct debye_order_terms terms;
		double from;
	} found[RAYS];
};

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
static double rainbow(const struct direction *d, double tau, int eighths, struct goa_plus_rainbow *out)
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
static double glory(const struct direction *d, int back, const struct ray *plus, const struct ray *minus,
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

/* sqrt(D). */
static double spread(const struct ray *r)
{
	return r->p ? sqrt(r->ratio * r->cos_i / r->slope) : 0.5;
}

/* Whether a ray is nothing, whatever the size; or at the end of a family where it has no amplitude. */
static int faint(const struct direction *d, const struct ray *r)
{
	double complex f[2];
	debye_order_amplitude(d->p, d->m, r->sin_i, 0, f);
	return !((cabs(f[0]) + cabs(f[1])) * spread(r) >= NOTHING);
}

static void keep(struct direction *d, const struct ray *r, double from)
{
	if (!(from < INFINITY))
		return;
	int k = d->n++;
	d->found[k].ray = *r;
	d->found[k].from = from;
	debye_order_terms(d->p, d->m, r->sin_i, d->theta * (M_PI / 180), r->sigma, r->axial, &d->found[k].terms);
}

/* The other ray of a glory, if this direction is near an axis and there is one. Returns the size from which rays do without. */
static double find_glory(struct direction *d, const struct branch *b, int side, int turns, const struct ray *r,
			 struct goa_plus_rays *out, int *failed)
{
	double rest = 180 - d->theta, front = d->theta < 90, near = fmin(d->theta, rest) * (M_PI / 180);
	int own = front == d->p % 2;    /* the axis of the central ray */
	struct ray other;
	if (near > NEAR || !rays_at(creal(d->m), d->p, &d->caustic, b, d->theta, -side, own ? turns : turns + side, &other))
		return 0;
	if (own && turns == 0 && b->central)
		return 0;
	int plus = front ? r->sigma > 0 : r->sigma < 0;
	struct goa_plus_glory g;
	double from = plus ? glory(d, !front, r, &other, &g) : glory(d, !front, &other, r, &g);
	if (from < LEAST_SIZE)
		return 0;
	if (plus) {
		if (grow(&out->glory, out->glories, sizeof *out->glory))
			*failed = 1;
		else
			out->glory[out->glories++] = g;
	}
	return from;
}

/* All of one order in one direction. Returns 0, or -1 when memory ran out. */
static int gather(struct direction *d, struct goa_plus_rays *out)
{
	double n = creal(d->m);
	struct branch branch[2];
	struct ray r;
	d->n = 0;
	d->caustic = rays_caustic(n, d->p);
	if (d->p < 2) {
		if (rays_find(n, d->p, &d->caustic, d->theta, &r) && !faint(d, &r))
			keep(d, &r, 0);
		return 0;
	}
	int branches = rays_branches(n, d->p, &d->caustic, branch), failed = 0;
	double axis = (d->p % 2 ? d->theta : 180 - d->theta) * (M_PI / 180), least = fmin(branch[0].from, branch[0].to);
	double most = fmax(fmax(branch[0].from, branch[0].to), branches > 1 ? branch[1].to : branch[0].to);
	double paired = branches > 1 ? fmin(branch[0].from, branch[1].to) : least;    /* two rays up to here */
	double dark = branches > 1 ? 0.6 : 0, narrow = LEAST_SIZE * cos(d->caustic.incidence);
	double wide = 2 * ZETA_DARK * cbrt(d->caustic.bend / (2 * narrow * narrow));
	for (int side = -1; side <= 1; side += 2)
		for (int turns = (int)ceil((least - dark - side * axis) / (2 * M_PI) - 1e-9);; turns++) {
			double tau = side * axis + 2 * M_PI * turns, from = 0;
			if (tau > most)
				break;
			if (tau < least - dark)
				continue;
			/* zeta x^(2/3) is about |tau - tau_R| over the width of the Airy function, which is off by 2 at most */
			if (branches > 1 && tau < paired && fabs(tau - d->caustic.tau) < wide) {
				/* the phase is that of the inner ray without its sgn term, here as on the bright side */
				int sigma = d->p % 2 ? side : -side;
				int whole = d->p % 2 ? turns + (d->p - 1) / 2 : turns - (sigma - d->p + 1) / 2;
				if (grow(&out->rainbow, out->rainbows, sizeof *out->rainbow))
					return -1;
				struct goa_plus_rainbow *pair = &out->rainbow[out->rainbows++];
				from = rainbow(d, tau, 4 * whole - 2 * (d->p - 1) - sigma + 1, pair);
				if (from < LEAST_SIZE) {
					from = 0;
					out->rainbows--;
				}
			}
			for (int b = 0; b < branches; b++)
				if (rays_at(n, d->p, &d->caustic, &branch[b], d->theta, side, turns, &r) && !faint(d, &r))
					keep(d, &r, fmax(from, find_glory(d, &branch[b], side, turns, &r, out, &failed)));
		}
	return failed ? -1 : 0;
}

static void put(struct goa_plus_packet *k, int lane, const struct direction *d, int i)
{
	const struct ray *r = &d->found[i].ray;
	const struct debye_order_terms *t = &d->found[i].terms;
	k->u[lane] = r->sin_i;
	k->path[lane] = creal(t->path) * M_2_PI;
	k->fade[lane] = cimag(t->path);
	k->fades |= k->fade[lane] != 0;
	k->quarters[lane] = r->eighths / 2.0;
	k->from[lane] = d->found[i].from;
	k->spread[lane] = fmin(spread(r), 1e15);
	k->e[lane] = fmax(fmin(t->e, 1e15), -1e15);
	double f2 = 0, g2 = 0;
	for (int j = 0; j < 2; j++) {
		f2 += creal(t->f[j] * conj(t->f[j]));
		g2 += creal(t->g[j] * conj(t->g[j]));
	}
	int settled = g2 < 1e15 * f2;      /* finite, and no matter of a caustic itself */
	k->hold[lane] = settled ? 4 * g2 / f2 : 0;
	for (int j = 0; j < 2; j++) {
		k->f[2 * j][lane] = -creal(t->f[j]);
		k->f[2 * j + 1][lane] = -cimag(t->f[j]);
		if (!settled || !(cabs(t->h[j]) < 1e15))
			continue;
		k->g[2 * j][lane] = -creal(t->g[j]);
		k->g[2 * j + 1][lane] = -cimag(t->g[j]);
		k->h[2 * j][lane] = -creal(t->h[j]);
		k->h[2 * j + 1][lane] = -cimag(t->h[j]);
	}
}

int goa_plus_rays_find(double complex m, int n, const double *theta, struct goa_plus_rays *out)
{
	int blocks = (n + GOA_WIDTH - 1) / GOA_WIDTH;
	size_t used = 0, room = 0;
	struct direction *d = malloc(GOA_WIDTH * sizeof *d);
	memset(out, 0, sizeof *out);
	out->n = n;
	out->theta = malloc((size_t)(n ? n : 1) * sizeof *out->theta);
	out->first = malloc(((size_t)blocks + 1) * sizeof *out->first);
	out->edge = malloc((size_t)(blocks ? blocks : 1) * sizeof *out->edge);
	if (!d || !out->theta || !out->first || !out->edge)
		goto no_memory;
	goa_plus_edge_aim(n, theta, out->edge);
	memcpy(out->theta, theta, (size_t)n * sizeof *theta);
	for (int b = 0; b < blocks; b++) {
		int lanes = n - b * GOA_WIDTH < GOA_WIDTH ? n - b * GOA_WIDTH : GOA_WIDTH;
		out->first[b] = used;
		for (int p = 0; p <= GOA_PLUS_ORDERS; p++) {
			int most = 0;
			for (int k = 0; k < lanes; k++) {
				int angle = b * GOA_WIDTH + k;
				d[k].m = m;
				d[k].angle = angle;
				d[k].p = p;
				d[k].theta = theta[angle];
				d[k].sine = sin(fmin(theta[angle], 180 - theta[angle]) * (M_PI / 180));
				if (gather(&d[k], out))
					goto no_memory;
				most = d[k].n > most ? d[k].n : most;
			}
			if (used + (size_t)most > room) {
				room = 2 * room + (size_t)most;
				struct goa_plus_packet *more = realloc(out->packet, room * sizeof *more);
				if (!more)
					goto no_memory;
				out->packet = more;
			}
			for (int i = 0; i < most; i++) {
				struct goa_plus_packet *k = &out->packet[used++];
				memset(k, 0, sizeof *k);
				k->p = p;
				k->least = k->clearest = INFINITY;
				for (int lane = 0; lane < lanes; lane++)
					if (i < d[lane].n) {
						put(k, lane, &d[lane], i);
						k->least = fmin(k->least, k->u[lane]);
						k->most = fmax(k->most, k->u[lane]);
						k->clearest = fmin(k->clearest, k->fade[lane]);
					}
			}
		}
	}
	out->first[blocks] = used;
	free(d);
	return 0;
no_memory:
	free(d);
	goa_plus_rays_free(out);
	return -1;
}

void goa_plus_rays_free(struct goa_plus_rays *r)
{
	free(r->theta);
	free(r->first);
	free(r->packet);
	free(r->edge);
	free(r->rainbow);
	free(r->glory);
	memset(r, 0, sizeof *r);
}

#include "optics/goa/goa_plus_rays.h"

#include "optics/goa/debye_order.h"
#include "optics/goa/rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NOTHING 1e-5       /* rays fainter than this part of x are left out */
#define RAYS 64            /* most rays of one order in one direction, with room */

/* One direction of one order, while its rays are gathered. */
struct gathered {
	struct goa_plus_direction d;
	int n;
	struct {
		struct ray ray;
		struct debye_order_terms terms;
		double from;
	} found[RAYS];
};

/* Whether a ray is nothing, whatever the size; or at the end of a family where it has no amplitude. */
static int faint(const struct goa_plus_direction *d, const struct ray *r)
{
	double complex f[2];
	debye_order_amplitude(d->p, d->m, r->sin_i, 0, f);
	return !((cabs(f[0]) + cabs(f[1])) * rays_spread(r) >= NOTHING);
}

static void keep(struct gathered *g, const struct ray *r, double from)
{
	const struct goa_plus_direction *d = &g->d;
	if (!(from < INFINITY))
		return;
	int k = g->n++;
	g->found[k].ray = *r;
	g->found[k].from = from;
	debye_order_terms(d->p, d->m, r->sin_i, d->theta * (M_PI / 180), r->sigma, r->axial, &g->found[k].terms);
}

/* All of one order in one direction. Returns 0, or -1 when memory ran out. */
static int gather(struct gathered *g, struct goa_plus_caustics *pairs)
{
	struct goa_plus_direction *d = &g->d;
	double n = creal(d->m);
	struct branch branch[2];
	struct ray r;
	g->n = 0;
	d->caustic = rays_caustic(n, d->p);
	if (d->p < 2) {
		if (rays_find(n, d->p, &d->caustic, d->theta, &r) && !faint(d, &r))
			keep(g, &r, 0);
		return 0;
	}
	int branches = rays_branches(n, d->p, &d->caustic, branch);
	double axis = (d->p % 2 ? d->theta : 180 - d->theta) * (M_PI / 180), least = fmin(branch[0].from, branch[0].to);
	double most = fmax(fmax(branch[0].from, branch[0].to), branches > 1 ? branch[1].to : branch[0].to);
	double paired = branches > 1 ? fmin(branch[0].from, branch[1].to) : least;    /* two rays up to here */
	double dark = branches > 1 ? 0.6 : 0, wide = goa_plus_caustics_reach(&d->caustic);
	for (int side = -1; side <= 1; side += 2)
		for (int turns = (int)ceil((least - dark - side * axis) / (2 * M_PI) - 1e-9);; turns++) {
			double tau = side * axis + 2 * M_PI * turns, from = 0, other;
			if (tau > most)
				break;
			if (tau < least - dark)
				continue;
			if (branches > 1 && tau < paired && fabs(tau - d->caustic.tau) < wide) {
				int sigma = d->p % 2 ? side : -side;
				int whole = d->p % 2 ? turns + (d->p - 1) / 2 : turns - (sigma - d->p + 1) / 2;
				if (goa_plus_caustics_rainbow(pairs, d, tau, 4 * whole - 2 * (d->p - 1) - sigma + 1, &from))
					return -1;
			}
			for (int b = 0; b < branches; b++) {
				if (!rays_at(n, d->p, &d->caustic, &branch[b], d->theta, side, turns, &r) || faint(d, &r))
					continue;
				if (goa_plus_caustics_glory(pairs, d, &branch[b], side, turns, &r, &other))
					return -1;
				keep(g, &r, fmax(from, other));
			}
		}
	return 0;
}

static void put(struct goa_plus_packet *k, int lane, const struct gathered *g, int i)
{
	const struct ray *r = &g->found[i].ray;
	const struct debye_order_terms *t = &g->found[i].terms;
	k->u[lane] = r->sin_i;
	k->path[lane] = creal(t->path) * M_2_PI;
	k->fade[lane] = cimag(t->path);
	k->fades |= k->fade[lane] != 0;
	k->quarters[lane] = r->eighths / 2.0;
	k->from[lane] = g->found[i].from;
	k->spread[lane] = fmin(rays_spread(r), 1e15);
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
	int blocks = angle_blocks_count(n);
	size_t used = 0, room = 0;
	struct gathered *g = malloc(GOA_WIDTH * sizeof *g);
	memset(out, 0, sizeof *out);
	out->edge = malloc((size_t)(blocks ? blocks : 1) * sizeof *out->edge);
	if (!g || !out->edge || angle_blocks_new(n, theta, &out->blocks))
		goto no_memory;
	goa_plus_edge_aim(n, theta, out->edge);
	for (int b = 0; b < blocks; b++) {
		int lanes = n - b * GOA_WIDTH < GOA_WIDTH ? n - b * GOA_WIDTH : GOA_WIDTH;
		out->blocks.first[b] = used;
		for (int p = 0; p <= GOA_PLUS_ORDERS; p++) {
			int most = 0;
			for (int k = 0; k < lanes; k++) {
				int angle = b * GOA_WIDTH + k;
				g[k].d = (struct goa_plus_direction){ .m = m, .theta = theta[angle], .angle = angle, .p = p,
					.sine = sin(fmin(theta[angle], 180 - theta[angle]) * (M_PI / 180)) };
				if (gather(&g[k], &out->caustics))
					goto no_memory;
				most = g[k].n > most ? g[k].n : most;
			}
			if (angle_blocks_room(&out->packet, &room, used, (size_t)most, sizeof *out->packet))
				goto no_memory;
			for (int i = 0; i < most; i++) {
				struct goa_plus_packet *k = &out->packet[used++];
				memset(k, 0, sizeof *k);
				k->p = p;
				k->least = k->clearest = INFINITY;
				for (int lane = 0; lane < lanes; lane++)
					if (i < g[lane].n) {
						put(k, lane, &g[lane], i);
						k->least = fmin(k->least, k->u[lane]);
						k->most = fmax(k->most, k->u[lane]);
						k->clearest = fmin(k->clearest, k->fade[lane]);
					}
			}
		}
	}
	out->blocks.first[blocks] = used;
	free(g);
	return 0;
no_memory:
	free(g);
	goa_plus_rays_free(out);
	return -1;
}

void goa_plus_rays_free(struct goa_plus_rays *r)
{
	angle_blocks_free(&r->blocks);
	free(r->packet);
	free(r->edge);
	goa_plus_caustics_free(&r->caustics);
	memset(r, 0, sizeof *r);
}

#include "optics/select/method.h"

#include "optics/cam/cam.h"
#include "optics/closed_form/evans_fournier.h"
#include "optics/goa/goa.h"
#include "optics/closed_form/rayleigh.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define GOA_ORDER 3          /* rays of the phase function, as published; extinction has the ray of one chord only */

/* Costs, in terms of Lorenz-Mie series. */
#define COST_FIT 100         /* of a sphere by the fit */
#define COST_CAM 500         /* by asymptotics */
#define COST_INDEX 100000    /* of asymptotics for an index, before the first sphere */
#define COST_ABSORBING 300000

#define CAMS 256             /* so many indices' asymptotics are kept from call to call */

/* An index: the sizes up to, or from, which each method is good enough. */
struct rung {
	double complex m;
	double small, large, fit;
	double spent;            /* on Lorenz-Mie terms of sizes from large on */
	struct cam *cam;
	int used;
};

struct ladder {
	enum method method;
	double tolerance;
	struct rung *rung;       /* a hash table, its size a power of two */
	size_t room, n;
	int cams;
};

struct ladder *ladder_new(enum method method, double tolerance)
{
	struct ladder *l = calloc(1, sizeof *l);
	if (!l)
		return NULL;
	*l = (struct ladder){ method, tolerance, calloc(64, sizeof *l->rung), 64, 0, 0 };
	if (l->rung)
		return l;
	free(l);
	return NULL;
}

static void drop_cams(struct ladder *l)
{
	for (size_t k = 0; k < l->room; k++) {
		cam_free(l->rung[k].cam);
		l->rung[k].cam = NULL;
	}
	l->cams = 0;
}

void ladder_free(struct ladder *l)
{
	if (!l)
		return;
	drop_cams(l);
	free(l->rung);
	free(l);
}

static struct rung *slot(struct rung *table, size_t room, double complex m)
{
	uint64_t bits[2], h;
	memcpy(bits, &m, sizeof bits);
	h = (bits[0] ^ (bits[1] * 0x9e3779b97f4a7c15u)) * 0xbf58476d1ce4e5b9u;
	size_t k = (size_t)(h >> 32) & (room - 1);
	while (table[k].used && table[k].m != m)
		k = (k + 1) & (room - 1);
	return &table[k];
}

/* How far from good, where error(x, m) is below the tolerance, it stays so on the way to bad. */
static double reach(double (*error)(double, double complex), double complex m, double tolerance, double good, double bad)
{
	if (error(bad, m) < tolerance)
		return bad;
	for (int i = 0; i < 30; i++) {
		double middle = sqrt(good * bad);
		if (error(middle, m) < tolerance)
			good = middle;
		else
			bad = middle;
	}
	return good;
}

static int grow(struct ladder *l)
{
	struct rung *table = calloc(2 * l->room, sizeof *table);
	if (!table)
		return -1;
	for (size_t k = 0; k < l->room; k++)
		if (l->rung[k].used)
			*slot(table, 2 * l->room, l->rung[k].m) = l->rung[k];
	free(l->rung);
	l->rung = table;
	l->room *= 2;
	return 0;
}

/* Have the rung of every index in the table. */
static int climb(struct ladder *l, int n, const double complex *m)
{
	for (int i = 0; i < n; i++) {
		struct rung *r = slot(l->rung, l->room, m[i]);
		if (r->used)
			continue;
		*r = (struct rung){ .m = m[i], .used = 1 };
		if (l->method == METHOD_AUTO) {
			r->small = reach(rayleigh_error, m[i], l->tolerance, 1e-8, 1);
			r->large = fmax(reach(cam_error, m[i], l->tolerance, 2 * MIE_X_MAX, 10), COST_CAM);
			r->fit = fmax(reach(evans_fournier_error, m[i], l->tolerance, 2 * MIE_X_MAX, 10), COST_FIT);
		}
		if (2 * ++l->n > l->room && grow(l))
			return -1;
	}
	return 0;
}

/* Where what Lorenz-Mie theory costs outweighs it, asymptotics for an index; or where they are asked for. */
static int prepare(struct ladder *l, int n, const double *x, const double complex *m)
{
	if (l->method != METHOD_AUTO && l->method != METHOD_CAM)
		return 0;
	for (int pass = 0; pass < 2; pass++)
		for (int i = 0; i < n; i++) {
			struct rung *r = slot(l->rung, l->room, m[i]);
			if (l->method == METHOD_AUTO && x[i] < r->large)
				continue;
			if (pass == 0) {
				r->spent += x[i];
				continue;
			}
			if (!r->cam && (l->method == METHOD_CAM || r->spent > (cimag(r->m) > 0 ? COST_ABSORBING : COST_INDEX))) {
				r->cam = cam_new(r->m);
				if (!r->cam)
					return -1;
				l->cams++;
			}
			if (r->cam)
				cam_reach(r->cam, x[i]);
		}
	return 0;
}

static enum method choose(const struct rung *r, double x)
{
	if (x <= r->small)
		return METHOD_RAYLEIGH;
	if (r->cam && x >= r->large)
		return METHOD_CAM;
	return x >= r->fit ? METHOD_EVANS_FOURNIER : METHOD_MIE;
}

static struct efficiencies geometrical(double x, double complex m, double *error)
{
	double memory;             /* infinite, as *error is, where that ran out */
	struct efficiencies rays = goa_efficiencies(x, m, GOA_ORDER, &memory), q = goa_efficiencies(x, m, 1, error);
	q.g = rays.g;
	q.back = rays.back;
	if (isinf(memory))
		*error = memory;
	*error = 1.2 * *error + 0.01 * fmax(1, creal(m) / 2) * exp(-8 * x * cimag(m));    /* g lacks the light of four and more chords */
	return q;
}

static struct efficiencies one(const struct rung *r, enum method method, int ripple, double x, double *error)
{
	switch (method) {
	case METHOD_RAYLEIGH:
		*error = rayleigh_error(x, r->m);
		return rayleigh_efficiencies(x, r->m);
	case METHOD_EVANS_FOURNIER:
		*error = evans_fournier_error(x, r->m);
		return evans_fournier_efficiencies(x, r->m);
	case METHOD_CAM:
		*error = cam_error(x, r->m);
		return cam_at(r->cam, x, ripple);
	default:
		return geometrical(x, r->m, error);
	}
}

/* The spheres left to Lorenz-Mie theory, side by side. */
static int by_mie(int n, const double *x, const double complex *m, struct efficiencies *q, double *error, const enum method *used)
{
	int waves = 0, failed;
	for (int i = 0; i < n; i++)
		waves += used[i] == METHOD_MIE;
	if (waves == n || waves == 0)
		return waves ? mie_many(n, x, m, q, error) : 0;
	double *some_x = malloc((size_t)waves * (2 * sizeof *x + sizeof *m + sizeof *q));
	if (!some_x)
		return -1;
	double *some_error = some_x + waves;
	double complex *some_m = (double complex *)(some_error + waves);
	struct efficiencies *some_q = (struct efficiencies *)(some_m + waves);
	for (int i = 0, k = 0; i < n; i++)
		if (used[i] == METHOD_MIE) {
			some_x[k] = x[i];
			some_m[k++] = m[i];
		}
	failed = mie_many(waves, some_x, some_m, some_q, some_error);
	for (int i = 0, k = 0; i < n && !failed; i++)
		if (used[i] == METHOD_MIE) {
			q[i] = some_q[k];
			error[i] = some_error[k++];
		}
	free(some_x);
	return failed;
}

int ladder_many(struct ladder *l, int n, const double *x, const double complex *m, struct efficiencies *q, double *error,
                enum method *used)
{
	int failed = 0;
	for (int i = 0; i < n; i++)
		used[i] = l->method;
	if (l->method == METHOD_MIE)
		return mie_many(n, x, m, q, error);
	if (l->cams > CAMS)
		drop_cams(l);
	if (climb(l, n, m) || prepare(l, n, x, m))
		return -1;
	for (int i = 0; i < n && l->method == METHOD_AUTO; i++)
		used[i] = choose(slot(l->rung, l->room, m[i]), x[i]);
#pragma omp parallel for schedule(dynamic, 16) reduction(|:failed) if (n > 1)
	for (int i = 0; i < n; i++)
		if (used[i] != METHOD_MIE) {
			q[i] = one(slot(l->rung, l->room, m[i]), used[i], l->method == METHOD_CAM, x[i], &error[i]);
			failed |= isinf(error[i]) != 0;
		}
	return failed ? -1 : by_mie(n, x, m, q, error, used);
}

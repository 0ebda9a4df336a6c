#include "medium/placement.h"

#include "base/die.h"
#include "format/columns.h"
#include "medium/density.h"
#include "medium/rng.h"
#include "toolkit/law.h"

#include <math.h>
#include <stdlib.h>

#define TRIAL 10000000           /* points after which it is told whether it ends: */
#define SPARSE 1e-5              /* a share of them that is kept */

enum { PLACES, CLASSES, NUMBER };        /* streams of random numbers */

struct sizes {
	size_t n;
	double *radius, *below;  /* below: weights of the classes up to and with this one */
};

struct placement {
	struct placement_request asked;
	struct sizes sizes;
	const char *density;         /* its file; NULL: none */
	struct npy_grid grid;
	double top;                  /* its largest value */
	double tries, count;         /* points to try, particles to keep: at most */
	uint64_t tried, kept;
};

static struct sizes read_sizes(struct tab *t)
{
	struct sizes s = { 0, NULL, NULL };
	int radius = tab_need(t, &column_radius), weight = tab_need(t, &column_weight);
	struct law_check *law = law_check_begin(t);
	double row[TAB_COLS], sum = 0;
	for (size_t room = 0; tab_next(t, row); s.n++) {
		if (s.n == room) {
			room = 2 * room + 16;
			s.radius = xgrow(s.radius, room, sizeof(double));
			s.below = xgrow(s.below, room, sizeof(double));
		}
		if (!(row[radius] > 0 && isfinite(row[radius])))
			die(tab_path(t), "row %llu: a radius is greater than 0, not %g", (unsigned long long)tab_row(t), row[radius]);
		if (!(row[weight] >= 0 && isfinite(row[weight])))
			die(tab_path(t), "row %llu: a weight is at least 0, not %g", (unsigned long long)tab_row(t), row[weight]);
		law_check_row(law, row);
		s.radius[s.n] = row[radius];
		s.below[s.n] = sum += row[weight];
	}
	law_check_end(law);
	if (!(sum > 0 && isfinite(sum)))
		die(tab_path(t), "has no class with a weight");
	return s;
}

/* The class in which the share u of all weights lies; one without weight is never drawn. */
static size_t draw(const struct sizes *s, double u)
{
	size_t lo = 0, hi = s->n - 1;
	double want = u * s->below[hi];
	while (lo < hi) {
		size_t mid = lo + (hi - lo) / 2;
		if (s->below[mid] > want)
			hi = mid;
		else
			lo = mid + 1;
	}
	return lo;
}

/* A coordinate as the f32 column holds it, not rounded out of the box. */
static double inside(double v, double half)
{
	float f = (float)v;
	return fabs((double)f) <= half ? f : nextafterf(f, 0);
}

/* How far from 0 the part of [-1, 1] begins in which voxel i of n counts, being interpolated. */
static double nearest(size_t i, size_t n)
{
	double low = (2 * (double)i - 1) / (double)n - 1, high = (2 * (double)i + 3) / (double)n - 1;
	return fmax(fmax(low, -high), 0);
}

/* The largest density that can be met in the box, or in the sphere in it: densities over that are the chance that a point is kept. */
static double scale(const struct npy_grid *g, const char *name, int round)
{
	double top = 0, sum = 0, n = 0;
	for (size_t z = 0, i = 0; z < g->nz; z++)
		for (size_t y = 0; y < g->ny; y++)
			for (size_t x = 0; x < g->nx; x++, i++) {
				if (round && pow(nearest(x, g->nx), 2) + pow(nearest(y, g->ny), 2) + pow(nearest(z, g->nz), 2) > 1)
					continue;
				top = fmax(top, g->v[i]);
				sum += g->v[i];
				n++;
			}
	const char *where = round ? "in the sphere" : "everywhere";
	if (!(top > 0))
		die(name, "is 0 %s", where);
	if (sum / n < 1e-4 * top)
		die(name, "has a mean less than 1e-4 of its maximum%s; crop it, or raise the rest", round ? " in the sphere" : "");
	return top;
}

struct placement *placement_new(const struct placement_request *r, struct tab *sizes, const char *density)
{
	struct placement *p = xalloc(1, sizeof *p);
	p->asked = *r;
	p->sizes = read_sizes(sizes);
	p->density = density;
	p->top = 1;
	if (density) {
		p->grid = npy_density(density, NULL);
		p->top = scale(&p->grid, density, r->round);
	}
	p->tries = INFINITY;
	p->count = r->count;
	/* Points uniform in the box, of which some are kept, are a Poisson process if their own number is Poisson's: no volume
	 * and no mean density need to be known. */
	if (isnan(r->count)) {
		double mean = r->concentration * r->box[0] * r->box[1] * r->box[2] * p->top;
		if (!(mean <= PLACEMENT_MOST))
			die("--concentration", "makes more than %g particles", PLACEMENT_MOST);
		p->tries = rng_poisson(mean, r->seed, NUMBER);
		p->count = INFINITY;
	}
	return p;
}

int placement_next(struct placement *p, struct placed *out)
{
	const double *box = p->asked.box, tries = p->tries;
	const uint64_t seed = p->asked.seed;
	const int round = p->asked.round;
	if (!((double)p->kept < p->count))
		return 0;
	for (uint64_t i = p->tried; (double)i < tries; i++) {
		uint32_t w[4];
		double u[4];
		if (i == TRIAL && (double)p->kept < SPARSE * TRIAL && p->density)
			die(p->density, "keeps fewer than %g of all points%s; crop it, or raise the rest", SPARSE, round ? " in the sphere" : "");
		rng_block(seed, i, PLACES, w);
		for (int j = 0; j < 4; j++)
			u[j] = rng_unit32(w[j]);
		double x = 2 * u[0] - 1, y = 2 * u[1] - 1, z = 2 * u[2] - 1;
		if (round && x * x + y * y + z * z > 1)
			continue;
		if (p->density && u[3] * p->top >= density_at(&p->grid, u[0], u[1], u[2]))
			continue;
		rng_block(seed, i, CLASSES, w);
		size_t class = draw(&p->sizes, rng_unit53(w[0], w[1]));
		*out = (struct placed){ { inside(x * box[0] / 2, box[0] / 2), inside(y * box[1] / 2, box[1] / 2),
		    inside(z * box[2] / 2, box[2] / 2) }, p->sizes.radius[class], class };
		p->tried = i + 1;
		p->kept++;
		return 1;
	}
	return 0;
}

void placement_free(struct placement *p)
{
	free(p->sizes.radius);
	free(p->sizes.below);
	free(p->grid.v);
	free(p);
}

#include "toolkit/size_integral.h"

#include "base/die.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define OCTAVES_FROM 8         /* size parameter from which ranges are parted */
#define CHUNK 4096             /* sizes handed over together */
#define LEAST_X 100            /* what a small sphere counts as, in work */
#define FIRST_LEVEL 2          /* that is judged */
#define LAST_LEVEL 20
#define FIRST_STEP 4.0         /* largest step in x that is judged, where there are resonances */

static void append(struct size_integral *s, struct size_range r, size_t group)
{
	s->part = xgrow(s->part, s->n + 1, sizeof *s->part);
	struct size_part *p = &s->part[s->n++];
	*p = (struct size_part){ .range = r, .group = group, .level = -1, .error = INFINITY };
	p->values = s->integrand.values(s->integrand.context, r.hi * s->integrand.x_of_um);
	for (int way = 0; way < SIZE_WAYS; way++)
		p->sum[way] = xalloc(p->values, sizeof(double));
	for (; s->groups <= group; s->groups++) {
		s->total = xgrow(s->total, s->groups + 1, sizeof *s->total);
		s->error = xgrow(s->error, s->groups + 1, sizeof *s->error);
		memset(s->total[s->groups], 0, sizeof *s->total);
	}
}

void size_integral_add(struct size_integral *s, struct size_range r, size_t group)
{
	double x = OCTAVES_FROM / s->integrand.x_of_um;
	while (x < r.lo * 1.4)
		x *= 2;
	for (; x < r.hi / 1.4; x *= 2) {
		struct size_range below = r;
		below.hi = r.lo = x;
		below.cut_hi = r.cut_lo = 1;
		append(s, below, group);
	}
	append(s, r, group);
}

/* Step in x, at its largest. */
static double step(const struct size_integral *s, const struct size_part *p)
{
	return 2 * s->integrand.x_of_um * size_range_length(&p->range) / ldexp(SIZE_STEPS, p->level);
}

static double narrowest(const struct size_integral *s, const struct size_part *p)
{
	if (!s->integrand.resonates)
		return INFINITY;
	double n = fabs(creal(s->integrand.m)), damping = fabs(cimag(s->integrand.m)) / n;
	double fall = n > 1 ? 2 * (n * acosh(n) - sqrt(n * n - 1)) : 0, x = p->range.hi * s->integrand.x_of_um;
	if (damping > 0 && fall > 0)    /* where the sum of both widths is least */
		x = fmin(x, fmax(log(fall / damping) / fall, p->range.lo * s->integrand.x_of_um));
	return exp(-fall * x) + damping * x;
}

static void add_level(struct size_integral *s, struct size_part *p, int level)
{
	double radius[CHUNK], weight[SIZE_WAYS][CHUNK];
	const double *const both[SIZE_WAYS] = { weight[0], weight[1] };
	long count = size_range_count(&p->range, level);
	int ways = size_density_ways(s->density);
	for (int way = 0; way < ways; way++)
		for (size_t i = 0; i < p->values; i++)
			p->sum[way][i] /= 2;
	for (long from = 0; from < count; from += CHUNK) {
		size_t n = 0;
		for (long k = from; k < count && k < from + CHUNK; k++) {
			double w[SIZE_WAYS] = { 0 };
			size_range_at(&p->range, s->density, level, k, &radius[n], w);
			for (int way = 0; way < ways; way++)
				weight[way][n] = w[way];
			n += w[0] > 0 || w[1] > 0;
		}
		for (size_t i = 0; i < n; i++)
			s->work += fmax(radius[i] * s->integrand.x_of_um, LEAST_X);
		s->sizes += (long)n;
		if (n)
			s->integrand.add(s->integrand.context, p, ways, n, radius, both, p->sum);
	}
	p->level = level;
}

static void totals(struct size_integral *s)
{
	memset(s->total, 0, s->groups * sizeof *s->total);
	for (size_t i = 0; i < s->n; i++)
		for (size_t k = 0; k < s->integrand.heads; k++)
			s->total[s->part[i].group][k] += s->part[i].sum[0][k];
}

/* What a step is expected to cost. */
static double cost(const struct size_integral *s, const struct size_part *p)
{
	double x = (p->range.lo + p->range.hi) / 2 * s->integrand.x_of_um;
	return (double)size_range_count(&p->range, p->level + 1) * fmax(x, LEAST_X);
}

/* Refine part p; its error is judged when the groups' sums are known again. */
static void refine(struct size_integral *s, struct size_part *p, double *before)
{
	memcpy(before, p->sum[0], p->values * sizeof *before);
	add_level(s, p, p->level + 1);
	for (size_t k = 0; k < p->values; k++)
		before[k] = p->sum[0][k] - before[k];
}

static void judge(const struct size_integral *s, struct size_part *p, const double *change)
{
	double now = s->integrand.error(s->integrand.context, p, change, s->total[p->group]);
	if (p->level < FIRST_LEVEL || (s->integrand.resonates && step(s, p) > FIRST_STEP))
		p->error = INFINITY;
	else
		p->error = fmax(now, isinf(p->error) ? 0 : p->error / (step(s, p) > narrowest(s, p) ? 2 : 32));
}

/* Parts are independent, so that the squares of their errors add up. Returns the largest of a group. */
static double errors(struct size_integral *s)
{
	double worst = 0;
	memset(s->error, 0, s->groups * sizeof *s->error);
	for (size_t i = 0; i < s->n; i++)
		s->error[s->part[i].group] += s->part[i].error * s->part[i].error;
	for (size_t g = 0; g < s->groups; g++)
		worst = fmax(worst, s->error[g] = sqrt(s->error[g]));
	return worst;
}

/* Of each group above the tolerance the part that gains most for its cost, and all that are not judged yet; returns how many. */
static size_t mark(const struct size_integral *s, double tolerance, double most, size_t *best, int *marked)
{
	double work = s->work;
	size_t n = 0;
	for (size_t g = 0; g < s->groups; g++)
		best[g] = s->n;
	memset(marked, 0, s->n * sizeof *marked);
	for (size_t i = 0; i < s->n; i++) {
		const struct size_part *p = &s->part[i], *b = best[p->group] < s->n ? &s->part[best[p->group]] : NULL;
		if (!(s->error[p->group] > tolerance) || p->level >= LAST_LEVEL)
			continue;
		if (isinf(p->error))
			marked[i] = 1;
		else if (!b || p->error * p->error / cost(s, p) > b->error * b->error / cost(s, b))
			best[p->group] = i;
	}
	for (size_t g = 0; g < s->groups; g++)
		if (best[g] < s->n)
			marked[best[g]] = 1;
	for (size_t i = 0; i < s->n; i++) {
		if (marked[i] && (work += cost(s, &s->part[i])) > most)
			marked[i] = 0;
		n += (size_t)marked[i];
	}
	return n;
}

double size_integral_run(struct size_integral *s, double tolerance, double most)
{
	double **change = xalloc(s->n, sizeof *change);
	size_t *best = xalloc(s->groups, sizeof *best);
	int *marked = xalloc(s->n, sizeof *marked);
	for (size_t i = 0; i < s->n; i++)
		change[i] = xalloc(s->part[i].values, sizeof **change);
	while (errors(s), mark(s, tolerance, most, best, marked)) {
		for (size_t i = 0; i < s->n; i++)
			if (marked[i])
				refine(s, &s->part[i], change[i]);
		totals(s);
		for (size_t i = 0; i < s->n; i++)
			if (marked[i])
				judge(s, &s->part[i], change[i]);
	}
	for (size_t i = 0; i < s->n; i++)
		free(change[i]);
	free(change);
	free(best);
	free(marked);
	return errors(s);
}

void size_integral_free(struct size_integral *s)
{
	for (size_t i = 0; i < s->n; i++)
		for (int way = 0; way < SIZE_WAYS; way++)
			free(s->part[i].sum[way]);
	free(s->part);
	free(s->total);
	free(s->error);
}

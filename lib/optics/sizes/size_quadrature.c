#include "optics/sizes/size_quadrature.h"

#include <math.h>
#include <stdlib.h>

#define STEPS 64           /* of level 0 */
#define JOINED 1e-9        /* limits that differ by less are one */
#define LEAST 4            /* steps of a run of classes */

/* A class: density by t, 0 to 1 between ln lo and ln hi, is left + t (right - left + bulge (1 - t)), or, alone, exp(tilt t). */
struct cell {
	double lo, hi, weight;         /* ln um */
	double left, right, bulge, tilt;
	int alone;
};

/* Classes that join. */
struct run {
	int first, n;
	double v, length;              /* v at its lower end, and from there */
	long steps;                    /* of level 0 */
};

struct size_quadrature {
	int n, nruns;
	double scale;
	struct cell *cell;
	struct run *run;
};

static int by_limits(const void *a, const void *b)
{
	const struct psd_class *p = a, *q = b;
	return p->lo != q->lo ? (p->lo > q->lo) - (p->lo < q->lo) : (p->hi > q->hi) - (p->hi < q->hi);
}

/* ln of the mean of e^(s t) over [0, 1] */
static double log_mean(double s)
{
	if (fabs(s) < 1e-6)
		return s / 2;
	return s > 0 ? s + log(-expm1(-s) / s) : log(expm1(s) / s);
}

static void stand_alone(struct cell *c, double radius)
{
	double cube = 3 * (log(radius) - c->lo), span = 3 * (c->hi - c->lo), lo = -1e6, hi = 1e6;
	c->alone = 1;
	for (int i = 0; i < 100; i++) {
		c->tilt = (lo + hi) / 2;
		if (log_mean(span + c->tilt) - log_mean(c->tilt) < cube)
			lo = c->tilt;
		else
			hi = c->tilt;
	}
}

/* Slope, at the lower end of cell j (or the upper of cell j - 1), of the number below, by up to five limits around. */
static double slope(const struct cell *c, int n, int j)
{
	int first = j - 2, last = j + 2;
	if (first < 0) {
		last -= first;
		first = 0;
	}
	if (last > n) {
		first = first - (last - n) > 0 ? first - (last - n) : 0;
		last = n;
	}
	double y[5], below[5], b[5], sum = 0;
	int m = last - first + 1;
	for (int k = 0; k < m; k++) {
		y[k] = first + k < n ? c[first + k].lo : c[n - 1].hi;
		below[k] = k ? below[k - 1] + c[first + k - 1].weight : 0;
	}
	for (int k = 0; k < m; k++) {
		b[k] = 1;
		for (int i = 0; i < m; i++)
			if (i != k)
				b[k] /= y[k] - y[i];
	}
	j -= first;
	for (int k = 0; k < m; k++)
		if (k != j)
			sum += b[k] / b[j] * (below[k] - below[j]) / (y[j] - y[k]);
	return sum;
}

static void shape(struct cell *c, int n)
{
	for (int j = 0; j <= n; j++) {
		double before = j ? c[j - 1].weight / (c[j - 1].hi - c[j - 1].lo) : INFINITY;
		double after = j < n ? c[j].weight / (c[j].hi - c[j].lo) : INFINITY;
		double s = fmin(fmax(slope(c, n, j), 0), 3 * fmin(before, after));
		if (j)
			c[j - 1].right = s * (c[j - 1].hi - c[j - 1].lo);
		if (j < n)
			c[j].left = s * (c[j].hi - c[j].lo);
	}
	for (int j = 0; j < n; j++)
		c[j].bulge = 6 * c[j].weight - 3 * (c[j].left + c[j].right);
}

/* Number by ln r. */
static double density(const struct cell *c, double y)
{
	double width = c->hi - c->lo, t = fmin(fmax((y - c->lo) / width, 0), 1);
	if (c->alone)
		return c->weight * exp(c->tilt * t - log_mean(c->tilt)) / width;
	return fmax(c->left + t * (c->right - c->left + c->bulge * (1 - t)), 0) / width;
}

static double v_at(double scale, double r)
{
	return hypot(r, scale) - scale * asinh(scale / r);
}

/* v is convex in ln r: Newton's method from above stays there. */
static double radius_at(double scale, double v, double above)
{
	double y = log(above);
	for (int i = 0; i < 100; i++) {
		double r = exp(y), step = (v_at(scale, r) - v) / hypot(r, scale);
		y -= step;
		if (fabs(step) < 1e-14)
			break;
	}
	return exp(y);
}

struct size_quadrature *size_quadrature_new(int n, const struct psd_class *c, double scale)
{
	struct psd_class *sorted = malloc((size_t)n * sizeof *sorted);
	struct size_quadrature *s = calloc(1, sizeof *s);
	if (s) {
		s->cell = calloc((size_t)n, sizeof *s->cell);
		s->run = calloc((size_t)n, sizeof *s->run);
	}
	if (!sorted || !s || !s->cell || !s->run) {
		free(sorted);
		size_quadrature_free(s);
		return NULL;
	}
	for (int i = 0; i < n; i++)
		sorted[i] = c[i];
	qsort(sorted, (size_t)n, sizeof *sorted, by_limits);
	s->n = n;
	s->scale = scale;
	double length = 0, least = fmax(STEPS, 2.0 * n);
	for (int i = 0, to; i < n; i = to) {
		struct run *r = &s->run[s->nruns++];
		for (to = i; to < n && (to == i || fabs(sorted[to].lo / sorted[to - 1].hi - 1) < JOINED); to++)
			s->cell[to] = (struct cell){ .lo = to > i ? s->cell[to - 1].hi : log(sorted[to].lo), .hi = log(sorted[to].hi),
				.weight = sorted[to].weight };
		r->first = i;
		r->n = to - i;
		if (r->n == 1)
			stand_alone(&s->cell[i], sorted[i].radius);
		else
			shape(s->cell + i, r->n);
		r->v = v_at(scale, sorted[i].lo);
		r->length = v_at(scale, sorted[to - 1].hi) - r->v;
		length += r->length;
	}
	for (int i = 0; i < s->nruns; i++)
		s->run[i].steps = (long)fmax(LEAST, ceil(least * s->run[i].length / length));
	free(sorted);
	return s;
}

void size_quadrature_free(struct size_quadrature *s)
{
	if (!s)
		return;
	free(s->cell);
	free(s->run);
	free(s);
}

static long of_run(const struct run *r, int level)
{
	return level ? r->steps << (level - 1) : r->steps + 1;
}

long size_quadrature_count(const struct size_quadrature *s, int level)
{
	long n = 0;
	for (int i = 0; i < s->nruns; i++)
		n += of_run(&s->run[i], level);
	return n;
}

void size_quadrature_at(const struct size_quadrature *s, int level, long k, double *radius, double *weight)
{
	const struct run *r = s->run;
	for (; k >= of_run(r, level); r++)
		k -= of_run(r, level);
	const struct cell *c = s->cell + r->first, *end = c + r->n - 1;
	double h = r->length / (double)(r->steps << level), at = level ? 2.0 * (double)k + 1 : (double)k;
	*radius = radius_at(s->scale, r->v + at * h, exp(end->hi));
	double y = log(*radius);
	while (c < end) {       /* the last cell that begins at y or below */
		const struct cell *middle = c + (end - c + 1) / 2;
		if (middle->lo <= y)
			c = middle;
		else
			end = middle - 1;
	}
	*weight = density(c, y) / hypot(*radius, s->scale) * h;
	if (!level && (k == 0 || k == r->steps))
		*weight /= 2;
}

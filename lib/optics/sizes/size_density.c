#include "optics/sizes/size_density.h"

#include "optics/sizes/psd_law.h"

#include <math.h>
#include <stdlib.h>

#define FAR 1e4            /* e-folds, within which a law has come to nothing */
#define JOINED PSD_TOUCH   /* limits that differ by less are one */

/* A class: density by t, 0 to 1 between ln lo and ln hi, is left + t (right - left + bulge (1 - t)), or, alone, exp(tilt t). */
struct cell {
	double lo, hi, weight;         /* ln um */
	double left, right, bulge, tilt[SIZE_WAYS];
	int alone;
};

struct size_density {
	struct cell *cell;             /* NULL: the law */
	struct psd_law law;
	double scale, ref;             /* its density is exp(psd_law_log(y - ref) - scale) */
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

/* The tilt of a power law whose mean of r^k is that of the radius. */
static double tilt(const struct cell *c, double radius, int k)
{
	double want = k * (log(radius) - c->lo), span = k * (c->hi - c->lo), lo = -1e6, hi = 1e6;
	for (int i = 0; i < 100; i++) {
		double middle = (lo + hi) / 2;
		if (log_mean(span + middle) - log_mean(middle) < want)
			lo = middle;
		else
			hi = middle;
	}
	return (lo + hi) / 2;
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

struct size_density *size_density_of_classes(int n, struct psd_class *c)
{
	struct size_density *d = calloc(1, sizeof *d);
	if (!d || !(d->cell = calloc((size_t)n, sizeof *d->cell))) {
		free(d);
		return NULL;
	}
	qsort(c, (size_t)n, sizeof *c, by_limits);
	for (int i = 0, to; i < n; i = to) {
		for (to = i; to < n && (to == i || fabs(c[to].lo / c[to - 1].hi - 1) < JOINED); to++) {
			struct cell *k = &d->cell[to];
			*k = (struct cell){ .lo = to > i ? k[-1].hi : log(c[to].lo), .hi = log(c[to].hi), .weight = c[to].weight };
			k->tilt[0] = k->tilt[1] = tilt(k, c[to].radius, 3);
		}
		if (to - i == 1) {
			d->cell[i].alone = 1;
			d->cell[i].tilt[1] = tilt(&d->cell[i], c[i].radius, 2);
		} else {
			shape(d->cell + i, to - i);
		}
	}
	return d;
}

struct size_density *size_density_of_law(const struct psd *law)
{
	struct size_density *d = calloc(1, sizeof *d);
	double min, max;
	if (!d)
		return NULL;
	psd_law_limits(law, &d->law, &min, &max);
	d->ref = log(d->law.ref);
	double lo = isnan(law->min) ? -INFINITY : log(min) - d->ref, hi = isnan(law->max) ? INFINITY : log(max) - d->ref;
	double peak = psd_law_peak(&d->law, 0, lo, hi), top = psd_law_log(&d->law, peak);
	lo = fmax(lo, peak - FAR);
	hi = fmin(hi, peak + FAR);
	d->scale = top + log(psd_law_integral(&d->law, 0, top, lo, hi));
	return d;
}

void size_density_free(struct size_density *d)
{
	if (d)
		free(d->cell);
	free(d);
}

int size_density_ways(const struct size_density *d) { return d->cell ? SIZE_WAYS : 1; }

double size_density_at(const struct size_density *d, int k, int way, double y)
{
	if (!d->cell)
		return exp(psd_law_log(&d->law, y - d->ref) - d->scale);
	const struct cell *c = &d->cell[k];
	double width = c->hi - c->lo, t = fmin(fmax((y - c->lo) / width, 0), 1);
	if (way || c->alone)
		return c->weight * exp(c->tilt[way] * t - log_mean(c->tilt[way])) / width;
	return fmax(c->left + t * (c->right - c->left + c->bulge * (1 - t)), 0) / width;
}

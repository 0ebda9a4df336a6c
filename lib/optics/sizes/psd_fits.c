/* Whether classes are a distribution's. */
#include "optics/sizes/psd.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static int by_limits(const void *a, const void *b)
{
	const struct psd_class *p = a, *q = b;
	return p->lo != q->lo ? (p->lo > q->lo) - (p->lo < q->lo) : (p->hi > q->hi) - (p->hi < q->hi);
}

static int near(double a, double b) { return fabs(a / b - 1) <= PSD_TOUCH; }

const char *psd_fits(const struct psd *p, int *n, struct psd_class *c)
{
	double min, max;
	int kept = 0;
	const char *bad = psd_limits(p, &min, &max);
	if (bad)
		return bad;
	for (int i = 0; i < *n; i++)
		if (!(c[i].weight >= 0 && c[i].weight < INFINITY && c[i].lo > 0 && c[i].lo <= c[i].radius && c[i].radius <= c[i].hi && c[i].hi < INFINITY))
			return "a weight is below 0 or a radius outside its limits";
	qsort(c, (size_t)*n, sizeof *c, by_limits);
	for (int i = 0; i < *n; i++)
		if (!kept || memcmp(&c[kept - 1], &c[i], sizeof *c))
			c[kept++] = c[i];
	*n = kept;
	if (p->kind == PSD_MONO)
		return kept == 1 && near(c->lo, p->a) && near(c->hi, p->a) && fabs(c->weight - 1) <= PSD_FITS ? NULL : "its radius is another, or the weight is not 1";
	for (int i = 1; i < kept; i++)
		if (!near(c[i].lo, c[i - 1].hi))
			return "the limits of classes do not touch";
	if ((!isnan(p->min) && !near(c->lo, p->min)) || (!isnan(p->max) && !near(c[kept - 1].hi, p->max)))
		return "it is cut where the classes do not end";
	struct psd within = *p;
	within.min = c->lo;
	within.max = c[kept - 1].hi;
	for (int i = 0; i < kept; i++) {
		double share = psd_moment(&within, 0, c[i].lo, c[i].hi);
		if (!(fabs(c[i].weight - share) <= PSD_FITS * share + 1e-12))
			return "weights are not its fractions of the number between their limits";
	}
	return NULL;
}

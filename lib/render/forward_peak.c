#include "render/forward_peak.h"

#include "base/die.h"
#include "optics/phase/phase.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SHARE 0.5              /* of scattering above the truncation: as many chains go on as end */
#define HIGH 20                /* times as high as an even phase function is a peak */

/* One wavelength of a table: nodes [n], p with a stride. */
struct row {
	int n;
	const float *theta, *p;
	size_t stride;
};

/* The part [*from, *to] of it, in fractions, of the interval i where p is above the truncation. */
static int above(const struct row *r, int i, double truncation, double *from, double *to)
{
	double a = r->p[(size_t)i * r->stride] - truncation, b = r->p[(size_t)(i + 1) * r->stride] - truncation;
	*from = a < 0 ? a / (a - b) : 0;
	*to = b < 0 ? a / (a - b) : 1;
	return a > 0 || b > 0;
}

/* Integral over the sphere of what is above a truncation. */
static double integral_above(const struct row *r, double truncation)
{
	double sum = 0, from, to;
	for (int i = 0; i + 1 < r->n; i++)
		if (above(r, i, truncation, &from, &to)) {
			double h = (double)r->theta[i + 1] - r->theta[i], p0 = r->p[(size_t)i * r->stride], d = r->p[(size_t)(i + 1) * r->stride] - p0;
			sum += phase_interval(r->theta[i] + from * h, (to - from) * h, p0 + from * d - truncation, p0 + to * d - truncation);
		}
	return sum;
}

static double truncation_of(const struct row *r)
{
	double low = 0, high = 0, all = integral_above(r, 0);
	for (int i = 0; i < r->n; i++)
		high = fmax(high, r->p[(size_t)i * r->stride]);
	for (int k = 0; k < 100; k++) {
		double middle = 0.5 * (low + high);
		if (integral_above(r, middle) > SHARE * all)
			low = middle;
		else
			high = middle;
	}
	return high;
}

static int by_value(const void *a, const void *b)
{
	return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

/* The nodes of the peak: the table's, and where a wavelength crosses its truncation. Returns how many; theta may be NULL. */
static int nodes(const struct medium *m, int class, const float *truncation, float *theta)
{
	int n = 0, first = m->node[2 * class], count = m->node[2 * class + 1];
	double *cross = xalloc((size_t)m->n_waves, sizeof *cross);
	for (int i = 0; i < count; i++) {
		if (theta)
			theta[n] = m->theta[first + i];
		n++;
		int k = 0;
		for (int w = 0; w < m->n_waves && i + 1 < count; w++) {
			double a = (double)m->p[(size_t)(first + i) * (size_t)m->n_waves + (size_t)w] - truncation[w];
			double b = (double)m->p[(size_t)(first + i + 1) * (size_t)m->n_waves + (size_t)w] - truncation[w];
			if (a * b < 0)
				cross[k++] = m->theta[first + i] + a / (a - b) * ((double)m->theta[first + i + 1] - m->theta[first + i]);
		}
		qsort(cross, (size_t)k, sizeof *cross, by_value);
		for (int j = 0; j < k; j++) {
			float at = (float)cross[j];
			if (at > m->theta[first + i] && at < m->theta[first + i + 1] && (j == 0 || at > (float)cross[j - 1])) {
				if (theta)
					theta[n] = at;
				n++;
			}
		}
	}
	free(cross);
	return n;
}

void forward_peak_make(struct forward_peak *k, const struct medium *m, int class)
{
	size_t waves = (size_t)m->n_waves, old = m->n_nodes;
	int high = class >= 0;
	memset(k, 0, sizeof *k);
	k->truncation = xalloc(waves, sizeof *k->truncation);
	for (size_t w = 0; w < waves && class >= 0; w++) {
		struct row r = { m->node[2 * class + 1], m->theta + m->node[2 * class], m->p + (size_t)m->node[2 * class] * waves + w, waves };
		double most = 0;
		k->truncation[w] = (float)truncation_of(&r);
		for (int i = 0; i < r.n; i++)
			most = fmax(most, r.p[(size_t)i * waves]);
		high &= most * 4 * M_PI > HIGH;
	}
	k->share = high ? SHARE : 0;
	k->n_classes = m->n_classes + 1 + high;
	size_t n = high ? (size_t)nodes(m, class, k->truncation, NULL) : 0;
	k->range = xalloc((size_t)k->n_classes, 2 * sizeof *k->range);
	k->theta = xalloc(old + n, sizeof *k->theta);
	k->p = xalloc(old + n, waves * sizeof *k->p);
	memcpy(k->range, m->node, 2 * (size_t)(m->n_classes + 1) * sizeof *k->range);
	memcpy(k->theta, m->theta, old * sizeof *k->theta);
	memcpy(k->p, m->p, old * waves * sizeof *k->p);
	if (!high)
		return;
	k->range[2 * (m->n_classes + 1)] = (int32_t)old;
	k->range[2 * (m->n_classes + 1) + 1] = (int32_t)n;
	nodes(m, class, k->truncation, k->theta + old);
	for (size_t w = 0; w < waves; w++) {
		size_t at = (size_t)m->node[2 * class], last = at + (size_t)m->node[2 * class + 1] - 2;
		for (size_t i = 0; i < n; i++) {
			while (at < last && m->theta[at + 1] <= k->theta[old + i])
				at++;
			double p0 = m->p[at * waves + w], p1 = m->p[(at + 1) * waves + w];
			double along = ((double)k->theta[old + i] - m->theta[at]) / ((double)m->theta[at + 1] - m->theta[at]);
			k->p[(old + i) * waves + w] = (float)fmax(0, p0 + (p1 - p0) * along - k->truncation[w]);
		}
	}
}

void forward_peak_free(struct forward_peak *k)
{
	free(k->truncation);
	free(k->range);
	free(k->theta);
	free(k->p);
}

#include "render/phase_sampler.h"

#include "base/die.h"
#include "optics/phase/phase.h"
#include "render/kern/phase.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PARTS_MOST (1 << 17)   /* of a step: nodes nearer to each other than 1e-7 rad, the step of a float there, count as one */

/* 32 - log2 of the columns of n intervals: a power of two, at least 4, so that a column's share is below 2^31. */
static int shift_of(int n)
{
	int bits = 2;
	while (1 << bits < n)
		bits++;
	return 32 - bits;
}

/* Columns of 2^shift each, filled with the shares of n intervals, which sum to 2^32: of each the first `threshold` units are the
 * column's own interval, the rest is another's (Walker 1977; Vose 1991). All in integers, hence exact. */
static void fill_columns(int n, int stride, const uint64_t *shares, int shift, int32_t *out)
{
	int columns = (int)(1u << (32 - shift)), n_small = 0, n_large = 0;
	uint64_t room = (uint64_t)1 << shift, *share = xalloc((size_t)columns, sizeof *share);
	int *small = xalloc((size_t)columns, sizeof *small), *large = xalloc((size_t)columns, sizeof *large);
	for (int c = 0; c < columns; c++) {
		share[c] = c < n ? shares[(size_t)c * (size_t)stride] : 0;
		if (share[c] < room)
			small[n_small++] = c;
		else
			large[n_large++] = c;
	}
	while (n_small) {
		int c = small[--n_small], from = large[n_large - 1];    /* shares sum to all the room, so there is one */
		out[2 * (size_t)c * (size_t)stride] = (int32_t)share[c];
		out[2 * (size_t)c * (size_t)stride + 1] = from;
		share[from] -= room - share[c];
		if (share[from] < room) {
			n_large--;
			small[n_small++] = from;
		}
	}
	while (n_large) {
		int c = large[--n_large];
		out[2 * (size_t)c * (size_t)stride] = (int32_t)room;
		out[2 * (size_t)c * (size_t)stride + 1] = c;
	}
	free(share);
	free(small);
	free(large);
}

/* Parts of the step [low, low + 1) that keep the nodes in it, place[n], apart. */
static int parts_of(const double *place, int n, double low)
{
	double nearest = 1;
	for (int i = 0; i + 1 < n; i++)
		if (place[i + 1] >= low && place[i] < low + 1)
			nearest = fmin(nearest, place[i + 1] - place[i]);
	int parts = 1;
	while (parts < PARTS_MOST && 1.0 / parts > nearest)
		parts *= 2;
	return parts;
}

/* One phase function, its intervals divided as far as one Newton step needs. */
struct table {
	int n;                     /* nodes */
	float *theta, *p;          /* [node], [node][wave] */
	uint64_t *share;           /* [interval][wave] of 2^32 */
};

/* Into how many equal parts an interval goes: in each the density p sin is within 1/50 of linear. */
static int divisions(size_t waves, double a, double b, const float *p0, const float *p1)
{
	double worst = 0, s0 = sin(a), s1 = sin(b), s = sin((a + b) / 2);
	for (size_t w = 0; w < waves; w++) {
		double line = (p0[w] * s0 + p1[w] * s1) / 2, middle = (p0[w] + p1[w]) / 2.0 * s;
		if (middle > 0)
			worst = fmax(worst, fabs(line - middle) / fmax(line, middle));
	}
	return (int)fmin(16, ceil(sqrt(fmax(worst, 1e-9) / 0.02)));
}

/* [node][wave] the probability of a smaller angle, in units of 2^-32, rounded: it never falls, and ends at 2^32. */
static uint64_t *shares_below(int n, size_t waves, const float *theta, const float *p)
{
	uint64_t *below = xalloc((size_t)n, waves * sizeof *below);
	double *sum = xalloc((size_t)n, sizeof *sum);
	for (size_t w = 0; w < waves; w++) {
		for (int i = 0; i + 1 < n; i++) {
			const float *at = p + (size_t)i * waves + w;
			sum[i + 1] = sum[i] + fmax(0, phase_interval(theta[i], (double)theta[i + 1] - theta[i], at[0], at[waves]));
		}
		for (int i = 1; i < n; i++) {
			double share = sum[n - 1] > 0 ? sum[i] / sum[n - 1] : 1;
			below[(size_t)i * waves + w] = i + 1 < n ? (uint64_t)floor(share * 0x1p32 + 0.5) : (uint64_t)1 << 32;
		}
	}
	free(sum);
	return below;
}

static struct table divide(int n, size_t waves, const float *theta, const float *p)
{
	struct table t = { 1, NULL, NULL, NULL };
	uint64_t *below = shares_below(n, waves, theta, p), *given = xalloc(waves, sizeof *given);
	int room = 1;
	for (int i = 0; i + 1 < n; i++)
		room += divisions(waves, theta[i], theta[i + 1], p + (size_t)i * waves, p + (size_t)(i + 1) * waves);
	t.theta = xalloc((size_t)room, sizeof *t.theta);
	t.p = xalloc((size_t)room, waves * sizeof *t.p);
	t.share = xalloc((size_t)room, waves * sizeof *t.share);
	t.theta[0] = theta[0];
	memcpy(t.p, p, waves * sizeof *p);
	for (int i = 0; i + 1 < n; i++) {
		const float *p0 = p + (size_t)i * waves, *p1 = p0 + waves;
		int k = divisions(waves, theta[i], theta[i + 1], p0, p1);
		double h = (double)theta[i + 1] - theta[i];
		for (int d = 1; d <= k; d++, t.n++) {
			t.theta[t.n] = d < k ? (float)(theta[i] + h * d / k) : theta[i + 1];
			double f = (t.theta[t.n] - theta[i]) / h;
			for (size_t w = 0; w < waves; w++) {
				uint64_t *share = t.share + (size_t)(t.n - 1) * waves + w;
				uint64_t all = below[(size_t)(i + 1) * waves + w] - below[(size_t)i * waves + w], before = d > 1 ? given[w] : 0;
				double d0 = (double)p1[w] - p0[w], whole = phase_interval(theta[i], h, p0[w], p1[w]);
				double part = phase_interval(theta[i], f * h, p0[w], p0[w] + f * d0);
				double now = whole > 0 ? rint(part / whole * (double)all) : 0;
				given[w] = d < k ? (uint64_t)fmin(fmax(now, (double)before), (double)all) : all;
				*share = given[w] - before;
				t.p[(size_t)t.n * waves + w] = d < k ? (float)(p0[w] + f * d0) : p1[w];
			}
		}
	}
	free(below);
	free(given);
	return t;
}

/* The index of one class: rows of [first part, parts] from step on, parts appended to a->angle. */
static void index_angles(struct phase_sampler *a, const struct table *t, int first, size_t step)
{
	double *place = xalloc((size_t)t->n, sizeof *place);
	for (int i = 0; i < t->n; i++)
		place[i] = t->theta[i] * (double)((float)ANGLE_STEPS / PI);
	int at = 0;
	for (int b = 0; b < ANGLE_STEPS; b++) {
		int few = at;
		while (few < t->n && place[few] < b + 2)
			few++;
		int parts = parts_of(place + at, few - at, b);
		a->angle = xgrow(a->angle, a->n_angle + 2 * (size_t)parts, sizeof *a->angle);
		a->angle[step + 2 * (size_t)b] = (int32_t)a->n_angle;
		a->angle[step + 2 * (size_t)b + 1] = parts;
		for (int k = 0; k < parts; k++) {
			while (at + 2 < t->n && place[at + 1] <= b + (double)k / parts)
				at++;
			float next = at + 2 < t->n ? t->theta[at + 1] : INFINITY;
			a->angle[a->n_angle++] = first + at;
			memcpy(&a->angle[a->n_angle++], &next, sizeof next);
		}
	}
	free(place);
}

static void fill_intervals(const struct table *t, size_t waves, float *out)
{
	const float *p = t->p;
	for (int i = 0; i + 1 < t->n; i++, p += waves, out += INTERVAL_ROW(waves)) {
		float width = t->theta[i + 1] - t->theta[i];
		out[0] = (float)sin(t->theta[i]);
		out[1] = (float)cos(t->theta[i]);
		out[2] = t->theta[i];
		out[3] = width;
		for (size_t w = 0; w < waves; w++) {
			out[4 + 2 * w] = p[w];
			out[5 + 2 * w] = (p[waves + w] - p[w]) / width;
		}
	}
}

void phase_sampler_make(struct phase_sampler *a, int n_classes, int n_waves, const int32_t *range, const float *theta, const float *p)
{
	size_t waves = (size_t)n_waves, columns = 0, intervals = 0;
	*a = (struct phase_sampler){ .isotropic = 1, .n_phase = PHASE_ROW * (size_t)n_classes, .n_angle = 2 * ANGLE_STEPS * (size_t)n_classes };
	a->phase = xalloc(a->n_phase, sizeof *a->phase);
	a->angle = xalloc(a->n_angle, sizeof *a->angle);
	for (size_t k = 0; k < (size_t)n_classes; k++) {
		size_t first = (size_t)range[2 * k], nodes = (size_t)range[2 * k + 1];
		for (size_t i = 0; i < nodes * waves; i++)
			a->isotropic &= fabs(p[first * waves + i] * 4 * M_PI - 1) < 1e-6;
		struct table t = divide((int)nodes, waves, theta + first, p + first * waves);
		const int32_t row[PHASE_ROW] = { [PHASE_INTERVAL] = (int32_t)intervals, [PHASE_COLUMN] = (int32_t)columns,
			[PHASE_SHIFT] = shift_of(t.n - 1), [PHASE_STEP] = (int32_t)(2 * ANGLE_STEPS * k) };
		size_t from = columns;
		memcpy(a->phase + PHASE_ROW * k, row, sizeof row);
		intervals += (size_t)(t.n - 1);
		columns += (size_t)1 << (32 - row[PHASE_SHIFT]);
		if (2 * columns * waves > INT32_MAX || intervals * INTERVAL_ROW(waves) > INT32_MAX || a->n_angle > INT32_MAX / 2)
			die("medium", "its phase functions are too large to render: over %zu angles at %d wavelengths", intervals, n_waves);
		a->interval = xgrow(a->interval, intervals * INTERVAL_ROW(waves) + 4, sizeof *a->interval);
		a->alias = xgrow(a->alias, 2 * columns * waves, sizeof *a->alias);
		fill_intervals(&t, waves, a->interval + (size_t)row[PHASE_INTERVAL] * INTERVAL_ROW(waves));
		for (size_t w = 0; w < waves; w++)
			fill_columns(t.n - 1, n_waves, t.share + w, row[PHASE_SHIFT], a->alias + 2 * (from * waves + w));
		index_angles(a, &t, row[PHASE_INTERVAL], (size_t)row[PHASE_STEP]);
		free(t.theta);
		free(t.p);
		free(t.share);
	}
	a->n_alias = 2 * columns * waves;
	a->n_interval = intervals * INTERVAL_ROW(waves) + 4;
	memset(a->interval + a->n_interval - 4, 0, 4 * sizeof *a->interval);
}

void phase_sampler_free(struct phase_sampler *a)
{
	free(a->phase);
	free(a->interval);
	free(a->alias);
	free(a->angle);
}

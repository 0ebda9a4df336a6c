#include "toolkit/phase_means.h"

#include "base/die.h"
#include "optics/phase/phase_series.h"
#include "toolkit/phase_sums.h"
#include "toolkit/ranges.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TAILS 0.01         /* of the tolerance, more than ranges_add leaves out */
#define BLURRED 0.6        /* of the tolerance, what interference that is left out may make, at most */
#define BREADTH_LEVEL 2    /* of sizes that tell the breadth */
#define MOST_WORK 3e8      /* of size parameters together */

struct phase_mean {
	double sca;            /* sum of weight x c_sca */
	long n;                /* given angles; 0: any */
	double *value;         /* [PHASE_ELEMENTS][n] */
	struct phase_series *series[PHASE_ELEMENTS];
};

static void at(const struct phase_mean *mean, long n, const double *theta, double *value)
{
	for (int e = 0; e < PHASE_ELEMENTS; e++) {
		if (mean->n)
			memcpy(value + e * n, mean->value + e * n, (size_t)n * sizeof *value);
		else
			phase_series_at(mean->series[e], n, theta, value + e * n);
		for (long j = 0; j < n; j++)
			value[e * n + j] /= mean->sca;
	}
}

static void forget(struct phase_mean *mean)
{
	free(mean->value);
	for (int e = 0; e < PHASE_ELEMENTS; e++)
		phase_series_free(mean->series[e]);
}

/* Values of a part: weight x c_sca, and, at n angles, times the elements. */
struct integrand {
	const struct phase_means_request *r;
	size_t wave;
	double *ring;          /* half the solid angle about the given angles */
};

/* Enough for coefficients below 1e-8; the narrowest resonances, of higher orders, have no weight. */
static int steps_of(const struct phase_means_request *r, size_t wave, double x)
{
	const struct size *size = &r->table->wave[wave];
	x *= size_extent(size) / size->x;
	return phase_series_steps((int)ceil(x + 4.05 * cbrt(x) + 8));
}

static long angles_of(const struct phase_means_request *r, size_t values)
{
	return r->model->any_angles ? (long)(values - 1) / PHASE_ELEMENTS : r->n;
}

static size_t count_values(void *context, double x)
{
	const struct integrand *g = context;
	long n = g->r->model->any_angles ? steps_of(g->r, g->wave, x) : g->r->n;
	return 1 + PHASE_ELEMENTS * (size_t)n;
}

static double *angles(const struct phase_means_request *r, long n)
{
	double *theta = xalloc((size_t)n, sizeof *theta);
	for (long j = 0; j < n; j++)
		theta[j] = r->model->any_angles ? phase_series_theta((int)n, (int)j) : r->theta[j];
	return theta;
}

/* How far a part spreads, in size parameters, as its interference averages out: its breadth, were the density even, by the
 * variance, or by what the density is at ends that are cut. */
static double breadth(const struct integrand *g, const struct size_range *range)
{
	const struct size_density *density = g->r->table->density;
	const double x_of_um = g->r->table->wave[g->wave].x / g->r->table->wave[g->wave].radius;
	double sum[3] = { 0 }, ends = 0;
	for (int level = 0; level <= BREADTH_LEVEL; level++) {
		for (int i = 0; i < 3; i++)
			sum[i] /= 2;
		for (long k = 0, n = size_range_count(range, level); k < n; k++) {
			double radius, weight[SIZE_WAYS];
			size_range_at(range, density, level, k, &radius, weight);
			for (int i = 0; i < 3; i++)
				sum[i] += weight[0] * pow(radius, 2 + i);
		}
	}
	if (range->cut_lo)
		ends += size_density_at(density, range->class, 0, log(range->lo)) * range->lo;
	if (range->cut_hi)
		ends += size_density_at(density, range->class, 0, log(range->hi)) * range->hi;
	double mean = sum[1] / sum[0], variance = sum[2] / sum[0] - mean * mean;
	return x_of_um * fmin(sqrt(12 * fmax(variance, 0)), 2 * sum[0] / ends);
}

/* waves.blur of a part: what turns more often over its breadth than `turns' says is left out, if what that leaves is little;
 * *error: this, by comparison with means in which all interferes, for indices from 0.75 to 2. */
static double blur_of(const struct integrand *g, const struct size_range *range, double *error)
{
	const int bubble = creal(g->r->table->wave[g->wave].m) < 1;
	double tolerance = g->r->tolerance, turns = 30 + (bubble ? 0.3 : 0.1) / tolerance;
	double wide = g->r->model->blurs ? breadth(g, range) : 0;
	*error = 0.15 / wide + (bubble ? 0.1 : 0.01) / turns;
	if (*error <= BLURRED * tolerance)
		return turns / wide;
	*error = 0;
	return 0;
}

static void add(void *context, const struct size_part *part, int ways, size_t n, const double *radius,
                const double *const weight[SIZE_WAYS], double *const sum[SIZE_WAYS])
{
	const struct integrand *g = context;
	long count = angles_of(g->r, part->values);
	double *theta = angles(g->r, count);
	struct waves *w = xalloc(n, sizeof *w);
	double left, blur = blur_of(g, &part->range, &left);
	for (size_t i = 0; i < n; i++)
		w[i] = (struct waves){ .size = class_table_size(g->r->table, g->wave, radius[i]), .blur = blur };
	phase_sums_add(g->r->model, n, w, count, theta, ways, weight, sum);
	free(w);
	free(theta);
}

static double error_of(void *context, const struct size_part *part, const double *change, const double *total)
{
	const struct integrand *g = context;
	long n = angles_of(g->r, part->values);
	double most = 0;
	for (int e = 0; e < PHASE_ELEMENTS; e++) {
		const double *d = change + 1 + e * n;
		double sum = 0;
		if (g->r->model->any_angles)
			for (long j = 0; j < n; j++)
				sum += fabs(d[j]) * sin(phase_series_theta((int)n, (int)j) * (M_PI / 180)) * (M_PI * M_PI / (double)n);
		else
			for (long j = 0; j < n; j++)
				sum += fabs(d[j]) * g->ring[j];
		most = fmax(most, sum);
	}
	return most / total[0];
}

/* Sums at n angles join a mean. */
static void join(const struct phase_means_request *r, struct phase_mean *m, long n, const double *sum)
{
	m->sca += sum[0];
	m->n = r->model->any_angles ? 0 : n;
	if (m->n && !m->value)
		m->value = xalloc(PHASE_ELEMENTS * (size_t)n, sizeof *m->value);
	for (int e = 0; e < PHASE_ELEMENTS; e++) {
		const double *v = sum + 1 + e * n;
		for (long j = 0; j < m->n; j++)
			m->value[e * n + j] += v[j];
		if (m->n)
			continue;
		if (!m->series[e])
			m->series[e] = phase_series_new();
		if (!m->series[e] || phase_series_add(m->series[e], (int)n, v))
			die(NULL, "out of memory");
	}
}

/* The rows of a wavelength that are no classes, or one of them. */
static void join_rows(const struct phase_means_request *r, struct phase_means *m, size_t from, size_t to, size_t wave, int weighted)
{
	const struct class_table *t = r->table;
	int terms = 0;
	size_t n = 0;
	struct waves *w = xalloc(to - from, sizeof *w);
	double *weight = xalloc(to - from, sizeof *weight);
	for (size_t i = from; i < to; i++) {
		struct class_row *row = &t->row[i];
		if (row->class >= 0 || row->wave != wave)
			continue;
		w[n] = row->w;
		row->w.a = row->w.b = NULL;    /* coefficients read are used once */
		weight[n++] = weighted ? row->weight : 1;
		m->x = fmax(m->x, size_extent(&row->w.size));
		int own = waves_terms(&w[n - 1]);
		terms = own > terms ? own : terms;
	}
	if (n) {
		long count = r->model->any_angles ? phase_series_steps(terms) : r->n;
		double *theta = angles(r, count), *sum = xalloc(1 + PHASE_ELEMENTS * (size_t)count, sizeof *sum);
		phase_sums_add(r->model, n, w, count, theta, 1, (const double *const[SIZE_WAYS]){ weight, NULL }, (double *const[SIZE_WAYS]){ sum, NULL });
		join(r, &m->mean[0], count, sum);
		free(theta);
		free(sum);
	}
	free(w);
	free(weight);
}

static void finish(const struct phase_means_request *r, struct phase_mean *mean)
{
	if (!(mean->sca > 0 && mean->sca < INFINITY))
		die(class_table_path(r->table), mean->sca > 0 ? "the sum of weights is out of range" : "all weights are 0");
	for (int e = 0; e < PHASE_ELEMENTS; e++)
		if (mean->series[e] && phase_series_ready(mean->series[e]))
			die(NULL, "out of memory");
}

/* The sums of an integral in one way join the means of its groups. */
static void join_parts(const struct phase_means_request *r, const struct size_integral *s, int way, struct phase_mean *mean)
{
	for (size_t i = 0; i < s->n; i++)
		join(r, &mean[s->part[i].group], angles_of(r, s->part[i].values), s->part[i].sum[way]);
}

/* Half the integral of |dp| between two means. */
static double difference(const struct phase_means_request *r, const struct phase_mean *a, const struct phase_mean *b, double x)
{
	long n = r->model->any_angles ? phase_series_steps((int)x + 1) : r->n;
	double *theta = angles(r, n), *p = xalloc(2 * PHASE_ELEMENTS * (size_t)n, sizeof *p), *q = p + PHASE_ELEMENTS * n, most = 0;
	at(a, n, theta, p);
	at(b, n, theta, q);
	for (int e = 0; e < PHASE_ELEMENTS; e++) {
		double sum = 0;
		for (long j = 0; j < n; j++) {
			double width = theta[j + 1 < n ? j + 1 : j] - theta[j ? j - 1 : 0];
			sum += fabs(p[e * n + j] - q[e * n + j]) * sin(theta[j] * (M_PI / 180)) * width / 2;
		}
		most = fmax(most, sum * (M_PI * M_PI / 180));
	}
	free(theta);
	free(p);
	return most;
}

/* What the classes of each group leave open: by how much the ways to rebuild the density differ. */
static double open_of(const struct phase_means_request *r, const struct size_integral *s, const struct phase_means *m)
{
	double most = 0;
	if (size_density_ways(s->density) == 1)
		return 0;
	struct phase_mean *other = xalloc(m->groups, sizeof *other), *one = xalloc(m->groups, sizeof *one);
	join_parts(r, s, 0, one);
	join_parts(r, s, 1, other);
	for (size_t g = 0; g < m->groups; g++) {
		finish(r, &one[g]);
		finish(r, &other[g]);
		most = fmax(most, SIZE_OPEN * difference(r, &one[g], &other[g], m->x));
		forget(&one[g]);
		forget(&other[g]);
	}
	free(one);
	free(other);
	return most;
}

struct phase_means *phase_means_new(const struct phase_means_request *r, size_t wave)
{
	const struct class_table *t = r->table;
	const struct size *size = &t->wave[wave];
	struct phase_means *m = xalloc(1, sizeof *m);
	struct integrand g = { r, wave, NULL };
	struct size_integral s = { .density = t->density,
		.integrand = { &g, size->x / size->radius, size->m, r->model->any_angles, 1, count_values, add, error_of } };
	m->groups = r->together ? 1 : (size_t)t->classes;
	m->mean = xalloc(m->groups, sizeof *m->mean);
	if (!r->model->any_angles) {
		g.ring = xalloc((size_t)r->n, sizeof *g.ring);
		for (long j = 0; j < r->n; j++)
			g.ring[j] = sin(r->theta[j] * (M_PI / 180)) * (r->theta[j + 1 < r->n ? j + 1 : j] - r->theta[j ? j - 1 : 0]) / 2 * (M_PI * M_PI / 180);
	}
	if (t->classes) {
		double blurred = 0, own, left = ranges_add(&s, t, r->together, r->tolerance);
		for (size_t i = 0; i < s.n; i++) {
			blur_of(&g, &s.part[i].range, &own);
			blurred = fmax(blurred, own);
		}
		m->error = left + blurred + size_integral_run(&s, (1 - TAILS) * r->tolerance - blurred, MOST_WORK);
		m->sizes = s.sizes;
		for (size_t i = 0; i < s.n; i++)
			m->x = fmax(m->x, s.part[i].range.hi * size_extent(size) / size->radius);
		m->open = open_of(r, &s, m);
		join_parts(r, &s, 0, m->mean);
	}
	if (r->together)
		join_rows(r, m, 0, t->n, wave, 1);
	size_integral_free(&s);
	free(g.ring);
	for (size_t k = 0; k < m->groups; k++)
		finish(r, &m->mean[k]);
	return m;
}

struct phase_means *phase_means_of_row(const struct phase_means_request *r, size_t row)
{
	struct phase_means *m = xalloc(1, sizeof *m);
	m->groups = 1;
	m->mean = xalloc(1, sizeof *m->mean);
	join_rows(r, m, row, row + 1, r->table->row[row].wave, 0);
	finish(r, &m->mean[0]);
	return m;
}

void phase_means_at(const struct phase_means *m, size_t group, long n, const double *theta, double *value)
{
	at(&m->mean[group], n, theta, value);
}

void phase_means_free(struct phase_means *m)
{
	for (size_t g = 0; g < m->groups; g++)
		forget(&m->mean[g]);
	free(m->mean);
	free(m);
}

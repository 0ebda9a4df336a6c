#include "toolkit/ensemble.h"

#include "base/die.h"

#include <math.h>
#include <stdlib.h>

#define LEAST_X 100        /* what a small sphere counts as, in work */
#define CHUNK_X 20000      /* sizes at a time: sum of size parameters, at most, but for one particle's */
#define CHUNK_SIZES 256
#define CHUNK_VALUES 4000000    /* values at a time, but for one particle's */
#define BLOCK 4096         /* angles together */

/* value[n][PHASE_ELEMENTS][angles] and q_sca[n] by a model that is asked once. */
static int at_once(const struct ensemble *e, struct waves *w, size_t n, double *value, double *q_sca)
{
	int failed = 0;
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n > 1)
	for (size_t i = 0; i < n; i++) {
		struct phase_sphere *s = e->model->open(e->model->context, &w[i], (size_t)e->n, e->theta);
		if (!s) {
			failed = 1;
			continue;
		}
		failed |= phase_model_values(e->model, s, e->n, e->theta, (size_t)e->n, value + i * PHASE_ELEMENTS * (size_t)e->n);
		q_sca[i] = s->q_sca;
		e->model->close(s);
	}
	return failed;
}

/* The same by one that can be asked again and again. */
static int in_blocks(const struct ensemble *e, struct waves *w, size_t n, double *value, double *q_sca)
{
	struct phase_sphere **s = xalloc(n, sizeof *s);
	long blocks = (e->n + BLOCK - 1) / BLOCK;
	int failed = 0;
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n > 1)
	for (size_t i = 0; i < n; i++)
		failed |= !(s[i] = e->model->open(e->model->context, &w[i], (size_t)e->n, NULL));
#pragma omp parallel for schedule(dynamic) collapse(2) reduction(|:failed)
	for (size_t i = 0; i < n; i++)
		for (long b = 0; b < blocks; b++) {
			long from = b * BLOCK, count = e->n - from < BLOCK ? e->n - from : BLOCK;
			if (s[i])
				failed |= phase_model_values(e->model, s[i], count, e->theta + from, (size_t)e->n,
				                             value + i * PHASE_ELEMENTS * (size_t)e->n + from);
		}
	for (size_t i = 0; i < n; i++)
		if (s[i]) {
			q_sca[i] = s[i]->q_sca;
			e->model->close(s[i]);
		}
	free(s);
	return failed;
}

/* Add weight x c_sca x value of waves w[n] to sums of their wavelengths, in this order at every angle: integrals or points. */
static void add(struct ensemble *e, struct waves *w, const double *weight, size_t n, int points)
{
	const long values = PHASE_ELEMENTS * e->n;
	double *value = xalloc(n * (size_t)values, sizeof *value), *factor = xalloc(n, sizeof *factor), **sum = xalloc(n, sizeof *sum);
	if (e->model->any_angles ? in_blocks(e, w, n, value, factor) : at_once(e, w, n, value, factor))
		die(NULL, "out of memory");
	for (size_t i = 0; i < n; i++) {
		struct ensemble_mean *m = &e->mean[ensemble_mean_of(e, &w[i].size)];
		factor[i] *= weight[i] * w[i].size.radius * w[i].size.radius;
		*(points ? &m->points_weight : &m->weight) += factor[i];
		sum[i] = points ? m->points : m->sum;
	}
#pragma omp parallel for schedule(static)
	for (long from = 0; from < values; from += 256)
		for (size_t i = 0; i < n; i++)
			for (long k = from; k < values && k < from + 256; k++)
				sum[i][k] += factor[i] * value[i * (size_t)values + (size_t)k];
	free(value);
	free(factor);
	free(sum);
}

/* Whether one more of size x still fits with n that have x_sum. */
static int fits(const struct ensemble *e, size_t n, double x_sum, double x)
{
	return n == 0 || (n < CHUNK_SIZES && x_sum + x <= CHUNK_X && (n + 1) * PHASE_ELEMENTS * (size_t)e->n <= CHUNK_VALUES);
}

void ensemble_add_points(struct ensemble *e)
{
	double weight[CHUNK_SIZES], x = 0;
	size_t n = 0, from = 0;
	for (size_t i = 0; i <= e->nw; i++) {
		int own = i < e->nw && !ensemble_limited(e, &e->w[i]);
		if (n && (!own || !fits(e, n, x, e->w[i].size.x))) {
			add(e, e->w + from, weight, n, 1);
			n = 0;
			x = 0;
		}
		if (!own)
			continue;
		if (!n)
			from = i;
		weight[n++] = e->w[i].carried[e->weight_col];
		x += e->w[i].size.x;
	}
}

void ensemble_add_level(struct ensemble *e, int level)
{
	struct waves w[CHUNK_SIZES];
	double weight[CHUNK_SIZES], x = 0;
	size_t n = 0;
	long count = size_quadrature_count(e->sub, level);
	for (long k = 0; k < count; k++) {
		double radius, part;
		size_quadrature_at(e->sub, level, k, &radius, &part);
		for (size_t m = 0; m < e->nmean; m++) {
			struct waves one = { .size = e->mean[m].size };
			one.size.x *= radius / one.size.radius;
			one.size.radius = radius;
			one.size.x_im = size_x_im(&one.size);
			e->work += fmax(one.size.x, LEAST_X);
			if (!fits(e, n, x, one.size.x)) {
				add(e, w, weight, n, 0);
				n = 0;
				x = 0;
			}
			weight[n] = part;
			w[n++] = one;
			x += one.size.x;
		}
	}
	add(e, w, weight, n, 0);
}

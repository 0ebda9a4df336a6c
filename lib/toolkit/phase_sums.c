#include "toolkit/phase_sums.h"

#include "base/die.h"

#include <stdlib.h>

#define CHUNK_X 20000      /* sizes at a time: sum of size parameters, at most, but for one particle's */
#define CHUNK_SIZES 256
#define CHUNK_VALUES 4000000    /* values at a time, but for one particle's */
#define BLOCK 4096         /* angles together */
#define STRIP 256          /* values that a thread sums */

/* value[n][PHASE_ELEMENTS][angles] and q_sca[n] by a model that is asked once. */
static int at_once(const struct phase_model *model, struct waves *w, size_t n, long angles, const double *theta, double *value, double *q_sca)
{
	int failed = 0;
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n > 1)
	for (size_t i = 0; i < n; i++) {
		struct phase_sphere *s = model->open(model->context, &w[i], (size_t)angles, theta);
		if (!s) {
			failed = 1;
			continue;
		}
		failed |= phase_model_values(model, s, angles, theta, (size_t)angles, value + i * PHASE_ELEMENTS * (size_t)angles) != 0;
		q_sca[i] = s->q_sca;
		model->close(s);
	}
	return failed;
}

/* The same by one that can be asked again and again. */
static int in_blocks(const struct phase_model *model, struct waves *w, size_t n, long angles, const double *theta, double *value, double *q_sca)
{
	struct phase_sphere **s = xalloc(n, sizeof *s);
	long blocks = (angles + BLOCK - 1) / BLOCK;
	int failed = 0;
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n > 1)
	for (size_t i = 0; i < n; i++)
		failed |= !(s[i] = model->open(model->context, &w[i], (size_t)angles, NULL));
#pragma omp parallel for schedule(dynamic) collapse(2) reduction(|:failed)
	for (size_t i = 0; i < n; i++)
		for (long b = 0; b < blocks; b++) {
			long from = b * BLOCK, count = angles - from < BLOCK ? angles - from : BLOCK;
			if (s[i])
				failed |= phase_model_values(model, s[i], count, theta + from, (size_t)angles,
				                             value + i * PHASE_ELEMENTS * (size_t)angles + from) != 0;
		}
	for (size_t i = 0; i < n; i++)
		if (s[i]) {
			q_sca[i] = s[i]->q_sca;
			model->close(s[i]);
		}
	free(s);
	return failed;
}

static void add(const struct phase_model *model, size_t n, struct waves *w, long angles, const double *theta, const double *weight[SIZE_WAYS],
                int ways, double *const sum[SIZE_WAYS])
{
	const long values = PHASE_ELEMENTS * angles;
	double *value = xalloc(n * (size_t)values, sizeof *value), q_sca[CHUNK_SIZES], factor[SIZE_WAYS][CHUNK_SIZES];
	if ((model->any_angles ? in_blocks : at_once)(model, w, n, angles, theta, value, q_sca))
		die(NULL, "out of memory");
	for (int way = 0; way < ways; way++)
		for (size_t i = 0; i < n; i++) {
			factor[way][i] = q_sca[i] * weight[way][i] * w[i].size.radius * w[i].size.radius;
			sum[way][0] += factor[way][i];
		}
#pragma omp parallel for schedule(static)
	for (long from = 0; from < values; from += STRIP)
		for (int way = 0; way < ways; way++)
			for (size_t i = 0; i < n; i++)
				for (long k = from; k < values && k < from + STRIP; k++)
					sum[way][1 + k] += factor[way][i] * value[i * (size_t)values + (size_t)k];
	free(value);
}

void phase_sums_add(const struct phase_model *model, size_t n, struct waves *w, long angles, const double *theta, int ways,
                    const double *const weight[SIZE_WAYS], double *const sum[SIZE_WAYS])
{
	for (size_t from = 0, to; from < n; from = to) {
		double x = 0;
		for (to = from; to < n; to++) {
			x += w[to].size.x;
			if (to > from && (to - from == CHUNK_SIZES || x > CHUNK_X || (to - from + 1) * PHASE_ELEMENTS * (size_t)angles > CHUNK_VALUES))
				break;
		}
		const double *part[SIZE_WAYS] = { weight[0] + from, weight[1] ? weight[1] + from : NULL };
		add(model, to - from, w + from, angles, theta, part, ways, sum);
	}
}

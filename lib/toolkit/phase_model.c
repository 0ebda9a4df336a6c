#include "toolkit/phase_model.h"

#include <stdlib.h>

#define BLOCK 4096      /* angles whose amplitudes are held at a time, unless all have to be asked for at once */

void phase_model_elements(double norm, int n, const double complex *s1, const double complex *s2, size_t stride, double *value)
{
	double *p = value + PHASE_P * stride;
	for (int i = 0; i < n; i++) {
		double re1 = creal(s1[i]), im1 = cimag(s1[i]), re2 = creal(s2[i]), im2 = cimag(s2[i]);
		p[i] = (re1 * re1 + im1 * im1 + re2 * re2 + im2 * im2) / (2 * norm);
	}
}

int phase_model_values(const struct phase_model *model, struct phase_sphere *s, long n, const double *theta, size_t stride,
                       double *value)
{
	long block = model->any_angles && n > BLOCK ? BLOCK : n;
	double complex *s1 = malloc(2 * (size_t)block * sizeof *s1), *s2 = s1 + block;
	int failed = !s1;
	for (long from = 0; !failed && from < n; from += block) {
		int count = n - from < block ? (int)(n - from) : (int)block;
		failed = model->at(s, count, theta + from, s1, s2);
		if (!failed)
			phase_model_elements(s->norm, count, s1, s2, stride, value + from);
	}
	free(s1);
	return failed ? -1 : 0;
}

int phase_model_once(const struct phase_model *model, struct waves *w, int n, const double *theta, double complex *s1,
                     double complex *s2, struct phase_sphere *known)
{
	struct phase_sphere *s = model->open(model->context, w, (size_t)n, theta);
	if (!s)
		return -1;
	int failed = model->at(s, n, theta, s1, s2);
	*known = *s;
	model->close(s);
	return failed;
}

#include "toolkit/waves.h"

#include "optics/mie/mie_host.h"

#include <math.h>
#include <stdlib.h>

int waves_terms(const struct waves *w)
{
	return w->a ? w->n : w->size.x_im == 0 ? mie_terms(w->size.x, w->size.m) : mie_host_terms(size_x(&w->size), w->size.m);
}

int waves_solve(struct waves *w)
{
	if (w->a)
		return 0;
	int clear = w->size.x_im == 0;
	double complex x = size_x(&w->size);
	w->n = waves_terms(w);
	w->lossless = clear && cimag(w->size.m) == 0;
	w->a = malloc(((size_t)w->n + 1) * sizeof *w->a);
	w->b = malloc(((size_t)w->n + 1) * sizeof *w->b);
	if (!w->a || !w->b)
		return -1;
	return clear ? mie_coefficients(w->size.x, w->size.m, w->n, w->a, w->b) : mie_host_coefficients(x, w->size.m, w->n, w->a, w->b);
}

struct efficiencies waves_efficiencies(const struct waves *w, double *error)
{
	if (w->size.x_im > 0)
		return mie_host_efficiencies(size_x(&w->size), w->n, w->a, w->b, error);
	return mie_efficiencies(w->size.x, w->lossless, w->n, w->a, w->b, error);
}

double waves_norm(const struct waves *w, double q_sca)
{
	return w->size.x_im > 0 ? mie_host_norm(size_x(&w->size), q_sca) : M_PI * w->size.x * w->size.x * q_sca;
}

void waves_drop(struct waves *w)
{
	free(w->a);
	free(w->b);
	w->a = w->b = NULL;
}

void waves_free(struct waves *w)
{
	waves_drop(w);
	free(w->carried);
	w->carried = NULL;
}

#include "toolkit/angle_refinement.h"

#include "optics/phase/angle_grid.h"

#include <math.h>
#include <stdlib.h>

int angle_refinement_find(const struct phase_model *model, double tolerance, struct angle_refinement *a)
{
	double x = 0;
	for (size_t i = 0; i < a->nwaves; i++)
		x = fmax(x, size_extent(&a->w[i].size));
	long n = angle_grid_fine(x, tolerance, NULL);
	if (n < 0 || (double)n * (double)(a->nwaves + 2) > ANGLE_REFINEMENT_MOST)
		return 1;
	long *keep = malloc((size_t)n * sizeof *keep);
	size_t curves = a->nwaves * PHASE_ELEMENTS;
	double *values = malloc(curves * (size_t)n * sizeof *values), **curve = malloc(curves * sizeof *curve);
	a->theta = malloc((size_t)n * sizeof *a->theta);
	a->sphere = calloc(a->nwaves, sizeof *a->sphere);
	int failed = !keep || !values || !curve || !a->theta || !a->sphere;
	if (!failed)
		angle_grid_fine(x, tolerance, a->theta);
	for (size_t i = 0; !failed && i < curves; i++)
		curve[i] = values + i * (size_t)n;
	for (size_t i = 0; !failed && i < a->nwaves; i++) {
		a->sphere[i] = model->open(model->context, &a->w[i], (size_t)n, NULL);
		failed = !a->sphere[i] || phase_model_values(model, a->sphere[i], n, a->theta, (size_t)n, curve[i * PHASE_ELEMENTS]);
	}
	if (!failed) {
		a->n = angle_grid_thin(n, a->theta, (int)curves, curve, tolerance, keep);
		failed = a->n < 0;
		for (long i = 0; i < a->n; i++)
			a->theta[i] = a->theta[keep[i]];
	}
	free(keep);
	free(values);
	free(curve);
	return failed ? -1 : 0;
}

void angle_refinement_free(const struct phase_model *model, struct angle_refinement *a)
{
	for (size_t i = 0; a->sphere && i < a->nwaves; i++)
		if (a->sphere[i])
			model->close(a->sphere[i]);
	free(a->sphere);
	free(a->theta);
}

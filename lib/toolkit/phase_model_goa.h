/* phase_model_goa - geometrical optics as a phase model. */
#ifndef TOOLKIT_PHASE_MODEL_GOA_H
#define TOOLKIT_PHASE_MODEL_GOA_H

#include "toolkit/phase_model.h"

/* As published (goa.h); with what it lacks (goa_plus.h); or the first's powers, without interference. */
enum phase_model_goa { PHASE_GOA, PHASE_GOA_PLUS, PHASE_GOA_INCOHERENT };

/* phase_model_goa_new - order: the highest of rays, not for GOA+. Threads number below threads. Dies when memory ran out. */
struct phase_model phase_model_goa_new(enum phase_model_goa which, int order, int threads);
void phase_model_goa_free(struct phase_model *model);

/* phase_model_goa_worst - the largest estimated error of all spheres so far, at *x; 0 if there were none. From FAILS on the
 * model does not hold. */
#define PHASE_MODEL_GOA_FAILS 1
double phase_model_goa_worst(const struct phase_model *model, double *x);

#endif

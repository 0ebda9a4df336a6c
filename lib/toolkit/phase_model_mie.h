/* phase_model_mie - Lorenz-Mie theory as a phase model; where an error is allowed, GOA+ in its place for spheres large enough. */
#ifndef TOOLKIT_PHASE_MODEL_MIE_H
#define TOOLKIT_PHASE_MODEL_MIE_H

#include "toolkit/phase_model.h"

struct phase_model_mie {
	int direct;           /* sums angle by angle only */
	double tolerance;     /* of amplitudes, in L1 of p; 0: none */
	double rough;         /* error in L1 at which GOA+ may do, 0: never; all sizes are then asked for the same angles */
};

/* phase_model_mie_new - the request has to stay. Dies when memory ran out. */
struct phase_model phase_model_mie_new(const struct phase_model_mie *request);
void phase_model_mie_free(struct phase_model *model);

#endif

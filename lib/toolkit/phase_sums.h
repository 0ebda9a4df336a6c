/* phase_sums - sums of what spheres scatter at angles. */
#ifndef TOOLKIT_PHASE_SUMS_H
#define TOOLKIT_PHASE_SUMS_H

#include "optics/sizes/size_density.h"
#include "toolkit/phase_model.h"

/* phase_sums_add - over spheres w[n], which are solved and dropped again: sum[way][0] += weight[way][i] c_sca, um^2/pi, and
 * sum[way][1 + e angles + k] += that times element e at theta[k] (degrees); in this order at every angle, so that sums do not depend on
 * threads. Dies when memory ran out. */
void phase_sums_add(const struct phase_model *model, size_t n, struct waves *w, long angles, const double *theta, int ways,
                    const double *const weight[SIZE_WAYS], double *const sum[SIZE_WAYS]);

#endif

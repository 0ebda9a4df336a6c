/* phase_sampler - tables by which the kernels find and draw scattering angles at constant cost; kern/phase.h has their use. */
#ifndef RENDER_PHASE_SAMPLER_H
#define RENDER_PHASE_SAMPLER_H

#include <stddef.h>
#include <stdint.h>

struct phase_sampler {
	int32_t *phase;            /* [class][PHASE_ROW] */
	float *interval;           /* [interval][4 + 2 wave], and four more */
	int32_t *alias;            /* [column][wave][2] */
	int32_t *angle;            /* [class][ANGLE_STEPS][2], then [part][2] */
	int isotropic;             /* all are, within 1e-6 */
	size_t n_phase, n_interval, n_alias, n_angle;    /* numbers of elements */
};

/* phase_sampler_make - of the phase tables of n_classes classes, as in struct medium: range[class][2], theta[node] rad ascending from 0 to pi,
 * p[node][wave], of any norm. Dies where an index would pass 2^31. */
void phase_sampler_make(struct phase_sampler *a, int n_classes, int n_waves, const int32_t *range, const float *theta, const float *p);

void phase_sampler_free(struct phase_sampler *a);

#endif

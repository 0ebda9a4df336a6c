/* forward_peak - a phase function divided at a truncation: what is above is the peak; kern/forward_peak.h has its use. */
#ifndef RENDER_FORWARD_PEAK_H
#define RENDER_FORWARD_PEAK_H

#include "medium/medium.h"

/* The phase functions of a medium, as struct medium has them, and the peak of one of them as a further class. */
struct forward_peak {
	double share;              /* of its scattering, the same at all wavelengths; 0 where it has no high peak: there is then no class */
	float *truncation;         /* [wave] sr^-1 */
	int n_classes;
	int32_t *range;            /* [class][2] */
	float *theta, *p;          /* [node], [node][wave]; those of the peak are not normalised */
};

/* forward_peak_make - class: whose peak; -1 for none. */
void forward_peak_make(struct forward_peak *k, const struct medium *m, int class);

void forward_peak_free(struct forward_peak *k);

#endif

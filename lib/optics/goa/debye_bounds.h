/* debye_bounds - where the partial waves of a large sphere can be told apart into orders of the Debye series, and where their asymptotic
 * forms need Airy functions. lambda = l + 1/2. */
#ifndef OPTICS_DEBYE_BOUNDS_H
#define OPTICS_DEBYE_BOUNDS_H

#include "base/cmplx.h"

#define DEBYE_TURN 5        /* widths (z/2)^(1/3) about a turning point z where Airy functions are needed */
#define DEBYE_TOP 6         /* the same from the edge to where waves end */

/* Below these lambda a wave is so far inside the turning point x, or |m| x, that Debye's forms serve. */
struct debye_bounds {
	double outside, separable;
	int opaque;            /* nothing comes back from inside */
};

/* debye_bounds - for size x, index m. */
struct debye_bounds debye_bounds(double x, double complex m);

/* debye_separable - whether the orders p can be told apart at lambda: it lies inside the turning point |m| x of the wave within
 * the sphere by more than the width of that point, or absorption leaves nothing of those inside. */
int debye_separable(double x, double complex m, double lambda);

#endif

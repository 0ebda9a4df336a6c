/* smoothstep - a polynomial that rises from 0 to 1 with three derivatives that are 0 at either end. */
#ifndef OPTICS_SMOOTHSTEP_H
#define OPTICS_SMOOTHSTEP_H

#include "optics/numerics/lane_math.h"

/* smoothstep - value at u, 0 at u = zero and beyond, 1 at u = zero + 1/over and beyond (over of either sign); *first, *second: its
 * derivatives by u. */
static inline double smoothstep(double zero, double over, double u, double *first, double *second)
{
	double t = (u - zero) * over;
	t = lane_select(t, 0, 0, t);
	t = lane_select(t, 1, t, 1);
	double r = 1 - t, tr = t * r;
	*first = 140 * tr * tr * tr * over;
	*second = 420 * tr * tr * (r - t) * (over * over);
	return t * t * (t * t) * (35 - t * (84 - t * (70 - 20 * t)));
}

#endif

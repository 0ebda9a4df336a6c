/* impact_quadrature - a quadrature over the impact parameter of rays: how much of the light enters a sphere, and how it fades inside. */
#ifndef OPTICS_IMPACT_QUADRATURE_H
#define OPTICS_IMPACT_QUADRATURE_H

#include "optics/numerics/gauss.h"

#include "base/cmplx.h"

struct impact {
	double weight;                  /* 2 u du, u = sin i: all of them add up to 1 */
	double incidence;               /* i, rad */
	int enters;                     /* 0 beyond a bubble's critical angle */
	double reflected[2];            /* |R_j|^2 */
	double chord;                   /* attenuation along a chord over x, infinite where no light enters */
};

/* impact_quadrature - nodes in the angle of incidence, in panels even on either side of the critical angle.
 * Given: out  room for IMPACT_NODES(panels)
 * Returns how many: half as many where n >= 1 */
#define IMPACT_NODES(panels) (2 * (panels) * GAUSS)
int impact_quadrature(double complex m, int panels, struct impact *out);

#endif

#include "optics/goa/debye_bounds.h"

#include <math.h>

int debye_separable(double x, double complex m, double lambda)
{
	double complex y = m * x;
	if (lambda < creal(y) - DEBYE_TURN * cbrt(creal(y) / 2))
		return 1;
	if (cimag(y) < DEBYE_TURN * cbrt(creal(y) / 2))
		return 0;
	/* the phase of a Hankel function inside; it turns negative where waves are evanescent */
	return cimag(csqrt((y - lambda) * (y + lambda)) - lambda * cacos(lambda / y)) > 3;
}

struct debye_bounds debye_bounds(double x, double complex m)
{
	double y = creal(m) * x, top = x + DEBYE_TOP * cbrt(x / 2);
	double complex z = m * x;
	int separable = debye_separable(x, m, top);
	return (struct debye_bounds){ x - DEBYE_TURN * cbrt(x / 2), separable ? INFINITY : y - DEBYE_TURN * cbrt(y / 2),
		cimag(m) > 0 && separable && cimag(csqrt((z - top) * (z + top)) - top * cacos(top / z)) > 20 };
}

#include "toolkit/size.h"

#include <math.h>
#include <stdio.h>

double size_y_max(double complex m) { return cimag(m) > 1e-3 * cabs(m) ? 2e10 : 1e9; }

double size_parameter(double radius, double wavelength, double host)
{
	return 2 * M_PI * radius * host / wavelength;
}

double size_x_im(const struct size *s)
{
	if (cimag(s->host) == 0)
		return 0;
	return s->wavelength > 0 ? size_parameter(s->radius, s->wavelength, cimag(s->host)) : s->x * (cimag(s->host) / creal(s->host));
}

const char *size_name(const struct size *s, char out[SIZE_NAME])
{
	if (s->wavelength > 0)
		snprintf(out, SIZE_NAME, "radius %.9g um, wavelength %.9g um", s->radius, s->wavelength);
	else
		snprintf(out, SIZE_NAME, "x = %.9g", s->x);
	return out;
}

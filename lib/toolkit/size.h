/* size - one sphere at one wavelength: what theories are asked about. */
#ifndef TOOLKIT_SIZE_H
#define TOOLKIT_SIZE_H

#include "base/cmplx.h"

struct size {
	double x, x_im;              /* size parameter 2 pi r eta_m / lambda; x_im > 0 where the host absorbs */
	double complex m;            /* relative refractive index, particle over host */
	double wavelength, radius;   /* um; both 0 when asked by size parameter */
	double complex host;         /* refractive index of the host */
	int first;                   /* first wavelength of this size */
};

#define SIZE_X_MIN 1e-8
#define SIZE_X_MAX 1e7

/* size_y_max - the largest |m| x of relative index m; more would take minutes a size. */
double size_y_max(double complex m);

/* size_parameter - x of a radius at a vacuum wavelength (both um) in a host of the given index. */
double size_parameter(double radius, double wavelength, double host);

/* size_x_im - its imaginary part, of a size whose wavelength and radius, or x, and host are known. */
double size_x_im(const struct size *s);

/* size_name - "radius .. um, wavelength .. um" or "x = ..", for messages; returns out. */
#define SIZE_NAME 96
const char *size_name(const struct size *s, char out[SIZE_NAME]);

/* size_x, size_extent - the size parameter, and its modulus: partial waves count up to about there. */
static inline double complex size_x(const struct size *s) { return CMPLX(s->x, s->x_im); }
static inline double size_extent(const struct size *s) { return s->x_im > 0 ? cabs(size_x(s)) : s->x; }

#endif

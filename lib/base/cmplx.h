/* cmplx - complex.h, with CMPLX where the compiler (clang with glibc) leaves it out, and |z|^2. */
#ifndef BASE_CMPLX_H
#define BASE_CMPLX_H

#include <complex.h>

#ifndef CMPLX
#define CMPLX(re, im) __builtin_complex((double)(re), (double)(im))
#endif

/* |z|^2 without a root. */
static inline double norm2(double complex z) { return creal(z) * creal(z) + cimag(z) * cimag(z); }

#endif

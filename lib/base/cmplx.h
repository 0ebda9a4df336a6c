/* cmplx - complex.h, with CMPLX where the compiler (clang with glibc) leaves it out. */
#ifndef BASE_CMPLX_H
#define BASE_CMPLX_H

#include <complex.h>

#ifndef CMPLX
#define CMPLX(re, im) __builtin_complex((double)(re), (double)(im))
#endif

#endif

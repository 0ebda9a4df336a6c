/* compat - the qualifiers and casts in which C and OpenCL C 1.2 differ. The kernels are one source for both.
 *
 * They use + - * / and sqrt of floats, integer operations and in-range conversions alone: each is exact or correctly rounded,
 * nothing is contracted, and so every build gives the same bits. */
#ifndef KERN_COMPAT_H
#define KERN_COMPAT_H

#ifdef __OPENCL_VERSION__
#pragma OPENCL FP_CONTRACT OFF
#ifndef FN
#define FN static inline __attribute__((always_inline))
#endif
#define GLOBAL __global
typedef long int64;
typedef uint uint32;
typedef ulong uint64;
FN float bits_float(uint32 x) { return as_float(x); }
FN uint32 float_bits(float x) { return as_uint(x); }
FN float root(float x) { return sqrt(x); }
#else
#include <stdint.h>
#include <string.h>
#define FN static inline __attribute__((always_inline, unused))
#define GLOBAL
typedef int64_t int64;
typedef uint32_t uint32;
typedef uint64_t uint64;
FN float bits_float(uint32 x) { float f; memcpy(&f, &x, 4); return f; }
FN uint32 float_bits(float x) { uint32 u; memcpy(&u, &x, 4); return u; }
FN float root(float x) { return __builtin_sqrtf(x); }
#endif

#endif

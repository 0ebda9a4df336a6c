/* compat - the qualifiers and names of types in which C and OpenCL C 1.2 differ. */
#ifndef KERN_COMPAT_H
#define KERN_COMPAT_H

#ifdef __OPENCL_VERSION__
#pragma OPENCL FP_CONTRACT OFF
#ifndef FN
#define FN static inline __attribute__((always_inline))
#endif
#define FN_ONCE FN
#define GLOBAL __global
#define UNROLL _Pragma("unroll")    /* a loop that is kept keeps its arrays in memory */
typedef long int64;
typedef uint uint32;
typedef ulong uint64;
#else
#include <stdint.h>
#include <string.h>
#define FN static inline __attribute__((always_inline, unused))
#define FN_ONCE static __attribute__((noinline, unused))    /* so large and so rare that one copy will do */
#define GLOBAL
#define UNROLL                     /* done unasked */
typedef int64_t int64;
typedef uint32_t uint32;
typedef uint64_t uint64;
#endif

/* i from 0 to n - 1, a few and known beforehand. */
#define EACH(i, n) UNROLL for (int i = 0; i < (n); i++)

#endif

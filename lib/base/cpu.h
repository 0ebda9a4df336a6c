/* cpu - which of the builds for several processors of the same family is to run. */
#ifndef BASE_CPU_H
#define BASE_CPU_H

enum { CPU_SCALAR, CPU_V2, CPU_V3, CPU_V4 };    /* plain C; x86-64-v2 (SSE4), -v3 (AVX2), -v4 (AVX-512) */

/* cpu_level - the best that this processor has, or what MOTES_CPU in the environment names: scalar, v2, v3 or v4. Dies where that is
 * none of them, or more than the processor has: a tool asks once before anything is read, so that nothing in lib/ dies of it later. */
int cpu_level(void);

/* CPU_BUILDS - NAME_scalar, NAME_v2 .. in the order of these levels, to initialise an array; CPU_DECLARE - extern declarations of them. */
#ifdef __x86_64__
#define CPU_BUILDS(name) { name##_scalar, name##_v2, name##_v3, name##_v4 }
#define CPU_DECLARE(type, name) extern type name##_scalar, name##_v2, name##_v3, name##_v4
#else
#define CPU_BUILDS(name) { name##_scalar }
#define CPU_DECLARE(type, name) extern type name##_scalar
#endif

#endif

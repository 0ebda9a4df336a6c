/* cpu - which of the builds for several processors of the same family is to run. */
#ifndef BASE_CPU_H
#define BASE_CPU_H

enum { CPU_SCALAR, CPU_V2, CPU_V3, CPU_V4 };    /* plain C; x86-64-v2 (SSE4), -v3 (AVX2), -v4 (AVX-512) */

/* cpu_level - the best that this processor has, or what MOTES_CPU in the environment names: scalar, v2, v3 or v4. Dies where that is
 * none of them, or more than the processor has. */
int cpu_level(void);

#endif

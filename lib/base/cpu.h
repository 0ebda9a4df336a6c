/* cpu - which of the builds for several processors of the same family is to run. */
#ifndef BASE_CPU_H
#define BASE_CPU_H

/* Written by the Makefile, as its CPUS asks:
 * CPU_BUILT - the levels that there are builds for, a bit each;
 * CPU_BUILDS(name) - name_scalar, name_v2 .. by level, those that were built, to initialise an array;
 * CPU_DECLARE(type, name) - extern declarations of them. */
#include "gen/cpu_builds.h"

enum { CPU_SCALAR, CPU_V2, CPU_V3, CPU_V4, CPU_LEVELS };    /* plain C; x86-64-v2 (SSE4), -v3 (AVX2), -v4 (AVX-512) */

/* cpu_name - "scalar", "v2", "v3" or "v4". */
const char *cpu_name(int level);

/* cpu_has - whether the processor has a level and there is a build for it. MOTES_CPU_MAX in the environment, a level's name,
 * hides those above, so that any machine can stand for a lesser one. Dies where that is no level's name. */
int cpu_has(int level);

/* cpu_level - the best there is, or what MOTES_CPU in the environment names: scalar, v2, v3 or v4. Dies where that is none of
 * them, or is not there: a tool asks once before anything is read, so that nothing in lib/ dies of it later. */
int cpu_level(void);

#endif

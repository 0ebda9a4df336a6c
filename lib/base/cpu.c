#include "base/cpu.h"

#include "base/die.h"

#include <stdlib.h>
#include <string.h>

static const char *const names[CPU_LEVELS] = { "scalar", "v2", "v3", "v4" };

const char *cpu_name(int level)
{
	return names[level];
}

/* The level that a variable of the environment names; -1 where it is not set. */
static int named(const char *variable)
{
	const char *name = getenv(variable);
	if (!name || !*name)
		return -1;
	for (int i = 0; i < CPU_LEVELS; i++)
		if (!strcmp(name, names[i]))
			return i;
	die(variable, "'%s' is none of scalar, v2, v3, v4", name);
}

/* By features: clang does not know the levels by name. */
static int processor_has(int level)
{
#ifdef __x86_64__
#define HAS __builtin_cpu_supports
	switch (level) {
	case CPU_V4: return processor_has(CPU_V3) && HAS("avx512f") && HAS("avx512bw") && HAS("avx512cd") && HAS("avx512dq") && HAS("avx512vl");
	case CPU_V3: return processor_has(CPU_V2) && HAS("avx2") && HAS("fma") && HAS("bmi") && HAS("bmi2");
	case CPU_V2: return HAS("sse4.2") && HAS("ssse3") && HAS("popcnt");
	}
#endif
	return level == CPU_SCALAR;
}

int cpu_has(int level)
{
	int most = named("MOTES_CPU_MAX");
	return CPU_BUILT >> level & 1 && (most < 0 || level <= most) && processor_has(level);
}

int cpu_level(void)
{
	int asked = named("MOTES_CPU"), best = CPU_V4;
	while (!cpu_has(best))
		best--;
	if (asked >= 0 && !cpu_has(asked))
		die("MOTES_CPU", asked > best ? "this processor is no %s" : "there is no build for %s here: make CPUS=all", names[asked]);
	return asked < 0 ? best : asked;
}

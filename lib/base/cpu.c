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

static int processor_has(int level)
{
#ifdef __x86_64__
	switch (level) {
	case CPU_V4: return __builtin_cpu_supports("x86-64-v4");
	case CPU_V3: return __builtin_cpu_supports("x86-64-v3");
	case CPU_V2: return __builtin_cpu_supports("x86-64-v2");
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

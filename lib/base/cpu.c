#include "base/cpu.h"

#include "base/die.h"

#include <stdlib.h>
#include <string.h>

int cpu_level(void)
{
	static const char *const names[] = { "scalar", "v2", "v3", "v4" };
	int best = CPU_SCALAR;
#ifdef __x86_64__
	best = __builtin_cpu_supports("x86-64-v4") ? CPU_V4 : __builtin_cpu_supports("x86-64-v3") ? CPU_V3
	    : __builtin_cpu_supports("x86-64-v2") ? CPU_V2 : CPU_SCALAR;
#endif
	const char *asked = getenv("MOTES_CPU");
	if (!asked || !*asked)
		return best;
	for (int i = CPU_SCALAR; i <= CPU_V4; i++) {
		if (strcmp(asked, names[i]))
			continue;
		if (i > best)
			die("MOTES_CPU", "this processor is no %s", asked);
		return i;
	}
	die("MOTES_CPU", "'%s' is none of scalar, v2, v3, v4", asked);
}

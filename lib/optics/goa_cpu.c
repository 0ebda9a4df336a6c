#include "optics/goa_lanes.h"

#include <stdlib.h>
#include <string.h>

const struct goa_lanes *goa_lanes(void)
{
	const struct {
		const char *name;
		int here;
		const struct goa_lanes *lanes;
	} cpu[] = {
#ifdef __x86_64__
		{ "v4", __builtin_cpu_supports("x86-64-v4"), &goa_lanes_v4 },
		{ "v3", __builtin_cpu_supports("x86-64-v3"), &goa_lanes_v3 },
		{ "v2", __builtin_cpu_supports("x86-64-v2"), &goa_lanes_v2 },
#endif
		{ "scalar", 1, &goa_lanes_scalar },
	};
	const char *asked = getenv("MOTES_CPU");
	for (size_t i = 0; i < sizeof cpu / sizeof *cpu; i++)
		if (asked && *asked ? !strcmp(asked, cpu[i].name) : cpu[i].here)
			return cpu[i].here ? cpu[i].lanes : NULL;
	return NULL;
}

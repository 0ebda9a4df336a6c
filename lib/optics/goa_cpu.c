#include "base/cpu.h"
#include "optics/goa_lanes.h"

const struct goa_lanes *goa_lanes(void)
{
	const struct goa_lanes *const build[] = { &goa_lanes_scalar,
#ifdef __x86_64__
		&goa_lanes_v2, &goa_lanes_v3, &goa_lanes_v4
#endif
	};
	return build[cpu_level()];
}

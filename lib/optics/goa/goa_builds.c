#include "optics/goa/goa_lanes.h"

const struct goa_lanes *goa_lanes(void)
{
	const struct goa_lanes *const build[CPU_LEVELS] = CPU_BUILDS(&goa_lanes);
	return build[cpu_level()];
}

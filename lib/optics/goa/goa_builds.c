#include "optics/goa/goa_lanes.h"
#include "optics/goa/goa_plus_lanes.h"

const struct goa_lanes *goa_lanes(void)
{
	const struct goa_lanes *const build[CPU_LEVELS] = CPU_BUILDS(&goa_lanes);
	return build[cpu_level()];
}

const struct goa_plus_lanes *goa_plus_lanes(void)
{
	const struct goa_plus_lanes *const build[CPU_LEVELS] = CPU_BUILDS(&goa_plus_lanes);
	return build[cpu_level()];
}

#include "optics/mie/mie_lanes.h"

const struct mie_lanes *mie_lanes(void)
{
	const struct mie_lanes *const build[CPU_LEVELS] = CPU_BUILDS(&mie_lanes);
	return build[cpu_level()];
}

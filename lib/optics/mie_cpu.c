#include "base/cpu.h"
#include "optics/mie_lanes.h"

mie_block_fn *mie_block(void)
{
	mie_block_fn *const build[] = { mie_block_scalar,
#ifdef __x86_64__
		mie_block_v2, mie_block_v3, mie_block_v4
#endif
	};
	return build[cpu_level()];
}

mie_angles_fn *mie_angles(void)
{
	mie_angles_fn *const build[] = { mie_angles_scalar,
#ifdef __x86_64__
		mie_angles_v2, mie_angles_v3, mie_angles_v4
#endif
	};
	return build[cpu_level()];
}

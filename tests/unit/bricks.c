/* A grid of voxels: also one with nothing in it has a brick, which lanes that are out of it may read. */
#include "render/bricks.h"
#include "render/kern/voxels.h"
#include "support/tap.h"

int main(void)
{
	float density[27] = { 0 };
	struct medium m = { .kind = MEDIUM_DENSITY, .half = { 1, 1, 1 }, .n_waves = 1, .n_classes = 1, .voxels = { 3, 3, 3 }, .n_density = 27,
		.density = density };
	for (int some = 0; some < 2; some++) {
		struct bricks b;
		density[13] = some ? 2 : 0;
		bricks_make(&b, &m);
		float sum = 0;
		int kept = 0;
		for (size_t i = 0; i < b.n_voxel; i++)
			sum += b.voxel[i];
		for (size_t i = 0; i < b.n_brick; i++)
			kept += b.brick[i] >= 0;
		ok(b.n_voxel == BRICK_CORNERS && kept == some && (sum > 0) == some, "%s: %zu values, %d bricks kept", some ? "one voxel" : "empty",
		   b.n_voxel, kept);
		bricks_free(&b);
	}
	return done_testing();
}

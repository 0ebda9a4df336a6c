/* bricks - the voxels of a medium in the order in which the kernels read them; kern/voxels.h has their layout. */
#ifndef RENDER_BRICKS_H
#define RENDER_BRICKS_H

#include "medium/medium.h"

struct bricks {
	int32_t size[3];           /* bricks along x, y, z, with an empty layer all around */
	int32_t *brick;            /* [z][y][x] the number of its voxels among those that are kept, or minus the distance in bricks, as a
	                              king walks, to the nearest one that is kept */
	float *voxel;              /* those kept, one after the other */
	size_t n_brick, n_voxel;
};

/* bricks_make - of the cubes of particles of the finest level, or of the density. Dies where an index would pass 2^31. */
void bricks_make(struct bricks *b, const struct medium *m);

void bricks_free(struct bricks *b);

#endif

/* bricks - the voxels of a medium in the order in which the kernels read them; kern/voxels.h has their layout. */
#ifndef RENDER_BRICKS_H
#define RENDER_BRICKS_H

#include "medium/medium.h"

struct bricks {
	int32_t size[3];           /* bricks along x, y, z */
	int32_t *brick;            /* [z][y][x] the number of its voxels among those that are kept, or -1 */
	float *voxel;              /* those kept, one after the other */
	size_t n_brick, n_voxel;
};

/* bricks_make - of the cubes of particles of the finest level, or of the density. Dies where an index would pass 2^31. */
void bricks_make(struct bricks *b, const struct medium *m);

void bricks_free(struct bricks *b);

#endif

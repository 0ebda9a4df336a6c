/* density - a grid of densities over a box. */
#ifndef MEDIUM_DENSITY_H
#define MEDIUM_DENSITY_H

#include "format/npy.h"

/* density_at - the density at u, v, w, fractions [0, 1] of the box along x, y, z; voxel centres at (i + 1/2)/n, trilinear
 * between them, constant from the outer centres to the border. Its mean over the box is the mean of the voxels. */
double density_at(const struct npy_grid *g, double u, double v, double w);

#endif

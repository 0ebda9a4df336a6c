/* particle_grid - a uniform grid over the centres of a medium's particles. */
#ifndef MEDIUM_PARTICLE_GRID_H
#define MEDIUM_PARTICLE_GRID_H

#include "medium/medium.h"

#define PARTICLE_GRID_SIDE (1 << 24)    /* cells along an axis: floats count them exactly */

/* particle_grid_build - choose the cells so that a ray costs least, and sort the particles into their order. */
void particle_grid_build(struct medium *m);

#endif

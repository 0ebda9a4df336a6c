/* particle_grid - a uniform grid over the centres of a medium's particles. */
#ifndef MEDIUM_PARTICLE_GRID_H
#define MEDIUM_PARTICLE_GRID_H

#include "medium/medium.h"

/* particle_grid_build - choose the cells so that a ray costs least, and sort the particles into their order. */
void particle_grid_build(struct medium *m);

/* particle_grid_agrees - whether every particle lies in the cell that has it. */
int particle_grid_agrees(const struct medium *m);

/* particle_grid_around - how many particles, spheres of their class's radius, contain a point (m, in the medium's coordinates);
 * *one is one of them. */
size_t particle_grid_around(const struct medium *m, const double at[3], size_t *one);

#endif

/* particle_counts - a pyramid of cubes that count the particles of each class: the optics of any of them follow exactly from
 * its counts. */
#ifndef MEDIUM_PARTICLE_COUNTS_H
#define MEDIUM_PARTICLE_COUNTS_H

#include "medium/medium.h"

/* particle_counts_level - size of level l over a finest level n[3]: each level halves the one before, rounding up, down to one
 * cube. Returns the number of cubes before it in the pyramid. */
size_t particle_counts_level(const int32_t *n, int l, int32_t *size);

/* particle_counts_size - cubes of all levels. */
size_t particle_counts_size(const int32_t *n);

/* particle_counts_build - count the medium's particles; longest: cubes along its longest side, 0 to have about eight particles
 * in one. */
void particle_counts_build(struct medium *m, int longest);

/* particle_counts_agree - whether every level sums the one before, and the last, one cube, has the medium's counts by class. */
int particle_counts_agree(const struct medium *m);

#endif

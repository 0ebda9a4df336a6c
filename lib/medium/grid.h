/* grid - a uniform grid over the discs of a medium's particles. */
#ifndef MEDIUM_GRID_H
#define MEDIUM_GRID_H

#include "medium/medium.h"

/* grid_build - choose the cells so that a ray costs least, sort the particles into their order, and list for each cell the
 * particles whose disc (of the largest c_ext over the wavelengths, in any orientation) may reach into it. Dies when there are
 * more than 2^32 references. */
void grid_build(struct medium *m);

#endif

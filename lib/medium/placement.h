/* placement - particles of a size distribution at random places in a box or a sphere, by a density or evenly: the same ones for
 * a seed on every machine. */
#ifndef MEDIUM_PLACEMENT_H
#define MEDIUM_PLACEMENT_H

#include "format/npy.h"
#include "format/tab.h"

#include <stdint.h>

#define PLACEMENT_MOST 1e12      /* particles, and points tried */

/* What is asked for. */
struct placement_request {
	double box[3];               /* m, edges, around the origin */
	int round;                   /* the sphere in it, whose box is a cube */
	double count;                /* exactly so many; NaN: */
	double concentration;        /* m^-3, so many on average, where the density is 1 */
	uint64_t seed;
};

struct placement;

/* A particle: a position as an f32 holds it (m), radius (um), the class's number in the distribution. */
struct placed {
	double at[3], radius;
	size_t class;
};

/* placement_new - sizes from a table with radius and weight (which may be closed then); density: a file of relative density in
 * the box, or NULL. Dies on bad input, and where there are more than PLACEMENT_MOST particles on average. */
struct placement *placement_new(const struct placement_request *r, struct tab *sizes, const char *density);

/* placement_next - the next particle; 0 at the end. Dies where the density leaves almost no place. */
int placement_next(struct placement *p, struct placed *out);

void placement_free(struct placement *p);

#endif

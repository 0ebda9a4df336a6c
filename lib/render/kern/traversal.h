/* traversal - a ray on its way through a volume, whatever the model: either a free flight, which ends at a collision or passes, or a
 * shadow ray, whose transmittance is wanted. Lanes travel side by side, each along its own ray, and end at different times. */
#ifndef KERN_TRAVERSAL_H
#define KERN_TRAVERSAL_H

#include "render/kern/random.h"
#include "render/kern/ray.h"
#include "render/kern/waves.h"

/* Random numbers of a vertex. Even ones come first; an alias table tears apart what is even, so its numbers are not. */
enum { DRAW_FLIGHT, DRAW_AZIMUTH, DRAW_COSINE, DRAW_LIGHT, DRAW_LIGHT_1, DRAW_LIGHT_2,
       DRAW_CLASS, DRAW_SHADOW, DRAW_SHADOWED, DRAW_ANGLE, DRAW_PLACE, DRAW_ROULETTE, DRAW_CHAIN, DRAW_FORCED };

/* A flight of the camera through an optical depth between none and this, at every wavelength, ends in the medium: see path_force. */
#define FORCED_DEPTH 0.0625f

struct traversal {
	mv going;                  /* still to take steps */
	mv flight;                 /* else a shadow ray */
	mv forced;                 /* a flight that ends in the medium */
	struct vec entry, along;   /* where the ray comes to the volume: from afar, floats would be too coarse */
	fv t0;                     /* entry, along the ray */
};

/* How a flight ended. */
struct collision {
	mv happened;               /* else it reached the ray's end */
	struct vec point;          /* of the collision */
	fv t;                      /* how far away */
	iv class, id;              /* what scatters there; id NONE where it is no single particle */
	iv volume;                 /* of several, the one that has it */
};

#endif

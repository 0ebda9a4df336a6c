/* random - counter-based random numbers: a hash of seed, pixel, sample and dimension, so that a sample's numbers do not depend on
 * what was computed before it. */
#ifndef KERN_RANDOM_H
#define KERN_RANDOM_H

#include "render/kern/compat.h"

#define DIMENSIONS 8    /* drawn at a vertex, at most */

struct random {
	uint32 key, counter;
};

FN uint32 mix(uint32 x, uint32 key)
{
	x ^= x >> 16;
	x *= 0x7feb352du;
	x ^= key;
	x ^= x >> 15;
	x *= 0x846ca68bu;
	return x ^ x >> 16;
}

FN struct random random_of(uint32 seed, uint32 pixel, uint32 sample)
{
	struct random r;
	uint32 a = mix(pixel + 0x9e3779b9u, mix(seed, 0x85ebca6bu));
	r.key = mix(sample + 0x7f4a7c15u, a);
	r.counter = mix(sample ^ 0x2545f491u, mix(a, r.key));
	return r;
}

/* Dimension d of the vertex at hand: 32 random bits, or a number in [0, 1) of 24 bits. */
FN uint32 draw_bits(const struct random *r, int d) { return mix(r->counter + (uint32)d * 0x9e3779b9u, r->key); }
FN float draw(const struct random *r, int d) { return (float)(draw_bits(r, d) >> 8) * 0x1p-24f; }
FN void next_vertex(struct random *r) { r->counter += DIMENSIONS * 0x9e3779b9u; }

#endif

/* random - counter-based random numbers: a hash of seed, pixel, sample and dimension, so that a sample's numbers do not depend on
 * what was computed before it. */
#ifndef KERN_RANDOM_H
#define KERN_RANDOM_H

#include "render/kern/lane.h"

#define DIMENSIONS 16    /* drawn at a vertex, at most */

struct random {
	uv key, counter;
};

FN uv mix(uv x, uv key)
{
	x ^= x >> 16;
	x *= 0x7feb352du;
	x ^= key;
	x ^= x >> 15;
	x *= 0x846ca68bu;
	return x ^ x >> 16;
}

FN struct random random_of(uint32 seed, uv pixel, uv sample)
{
	struct random r;
	uv a = mix(pixel + 0x9e3779b9u, UV(seed * 0x9e3779b1u ^ 0x85ebca6bu));
	r.key = mix(sample + 0x7f4a7c15u, a);
	r.counter = mix(a ^ 0x2545f491u, r.key);
	return r;
}

/* Dimension d of the vertex at hand: 32 random bits, or a number in [0, 1) of 24 bits. */
FN uv draw_bits(const struct random *r, int d) { return mix(r->counter + (uint32)d * 0x9e3779b9u, r->key); }
FN fv unit_of(uv bits) { return to_float(signed_of(bits >> 8)) * 0x1p-24f; }
FN fv draw(const struct random *r, int d) { return unit_of(draw_bits(r, d)); }
FN void next_vertex(struct random *r, mv m) { r->counter = SEL(m, r->counter + DIMENSIONS * 0x9e3779b9u, r->counter); }

#endif

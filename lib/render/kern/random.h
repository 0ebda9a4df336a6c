/* random - counter-based random numbers: a hash of seed, pixel, sample and dimension, so that a sample's numbers do not depend on
 * what was computed before it.
 *
 * Where an integrand is smooth, numbers that fill space evenly do better than independent ones: the samples of a pixel are points of an
 * extensible Korobov lattice (Hickernell, Hong, L'Ecuyer and Lemieux 2000), in the order of their reversed bits, moved in every
 * dimension by a random shift (Cranley and Patterson 1976). Each sample is uniform, so that any of them give the right mean. The points
 * of one lattice are not independent, and their spread does not tell the variance of their mean. So the samples are two replicates of
 * the lattice, each with a shift of its own, whose means tell it. */
#ifndef KERN_RANDOM_H
#define KERN_RANDOM_H

#include "render/kern/lane.h"

#define DIMENSIONS 16    /* drawn at a vertex, at most */
#define EVEN 6           /* of them, the first ones, from the lattice */

struct random {
	uv key, shift;             /* of the sample, of the pixel's replicate */
	uv counter;                /* of the vertex */
	uv lattice;                /* the sample's point in the vertex's first dimension */
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

FN uv reversed(uv x)
{
	x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
	x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
	x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
	x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
	return x << 16 | x >> 16;
}

FN uv key_of(uv sample, uv shift) { return mix(sample + 0x7f4a7c15u, shift); }

/* Which of the two replicates a sample is of: one of each pair, but not in step with what recurs (the sequence of Thue and Morse). */
FN uv replicate_of(uv sample)
{
	sample ^= sample >> 16;
	sample ^= sample >> 8;
	sample ^= sample >> 4;
	sample ^= sample >> 2;
	return (sample ^ sample >> 1) & 1u;
}

FN struct random random_of(uint32 seed, uv pixel, uv sample)
{
	struct random r;
	r.shift = mix(pixel + 0x9e3779b9u, (seed * 0x9e3779b1u ^ 0x85ebca6bu) ^ replicate_of(sample) * 0xc2b2ae35u);
	r.key = key_of(sample, r.shift);
	r.counter = mix(r.shift ^ 0x2545f491u, r.shift);
	r.lattice = reversed(sample >> 1);
	return r;
}

FN void set_random(mv m, struct random *r, struct random value)
{
	SET(m, r->key, value.key);
	SET(m, r->shift, value.shift);
	SET(m, r->counter, value.counter);
	SET(m, r->lattice, value.lattice);
}

/* The lattice's generator 17797 to the power d < 7. */
FN uint32 generator(int d)
{
	uint32 z = 1;
	for (int k = 0; k < d; k++)
		z *= 17797u;
	return z;
}

/* Dimension d of the vertex at hand: 32 random bits, or a number in [0, 1) of 24 bits. */
FN uv draw_bits(const struct random *r, int d)
{
	uv x = r->counter + (uint32)d * 0x9e3779b9u;
	return d < EVEN ? mix(x, r->shift) + r->lattice * generator(d) : mix(x, r->key);
}
FN fv unit_of(uv bits) { return to_float(signed_of(bits >> 8)) * 0x1p-24f; }
FN fv draw(const struct random *r, int d) { return unit_of(draw_bits(r, d)); }

FN void next_vertex(struct random *r, mv m)
{
	SET(m, r->counter, r->counter + DIMENSIONS * 0x9e3779b9u);
	SET(m, r->lattice, r->lattice * generator(EVEN));
}

#endif

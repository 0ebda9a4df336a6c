/* rng - random numbers by counter: the same on every machine, in any order. */
#ifndef MEDIUM_RNG_H
#define MEDIUM_RNG_H

#include <stdint.h>

/* rng_block - four random 32-bit words for a counter, a stream and a seed (Philox4x32-10: Salmon et al. 2011). */
static inline void rng_block(uint64_t seed, uint64_t counter, uint64_t stream, uint32_t out[4])
{
	uint32_t c0 = (uint32_t)counter, c1 = (uint32_t)(counter >> 32), c2 = (uint32_t)stream, c3 = (uint32_t)(stream >> 32);
	uint32_t k0 = (uint32_t)seed, k1 = (uint32_t)(seed >> 32);
	for (int i = 0; i < 10; i++) {
		uint64_t p0 = (uint64_t)0xD2511F53 * c0, p1 = (uint64_t)0xCD9E8D57 * c2;
		c0 = (uint32_t)(p1 >> 32) ^ c1 ^ k0;
		c1 = (uint32_t)p1;
		c2 = (uint32_t)(p0 >> 32) ^ c3 ^ k1;
		c3 = (uint32_t)p0;
		k0 += 0x9E3779B9;
		k1 += 0xBB67AE85;
	}
	out[0] = c0;
	out[1] = c1;
	out[2] = c2;
	out[3] = c3;
}

/* rng_unit32 - a number in (0, 1) from one word; rng_unit53 - from two, with 53 bits, in [0, 1). */
static inline double rng_unit32(uint32_t a)
{
	return (a + 0.5) * 0x1p-32;
}

static inline double rng_unit53(uint32_t a, uint32_t b)
{
	return (double)(((uint64_t)a << 32 | b) >> 11) * 0x1p-53;
}

/* rng_poisson - a Poisson-distributed number, exact up to rounding for means from 0 to 1e12; uses the whole stream. */
double rng_poisson(double mean, uint64_t seed, uint64_t stream);

#endif

/* vec - LANES doubles in a vector, UNROLL vectors in turn, so that one hides the other's latency; for loops that are compiled for
 * several processors from one source. Nothing is contracted and no lane's value depends on another's: its bits are the same at
 * every width. */
#ifndef OPTICS_VEC_H
#define OPTICS_VEC_H

#include <stdint.h>
#include <string.h>

#define WIDTH (LANES * UNROLL)
#define EACH(u) for (int u = 0; u < UNROLL; u++)
#define INLINE static inline __attribute__((always_inline))

#if LANES == 1
typedef double vec;
typedef int64_t truths;
#define PICK(m, a, b) ((m) ? (a) : (b))
#define LANE(v, i) ((v)[i])
#else
typedef double vec __attribute__((vector_size(8 * LANES)));
typedef int64_t truths __attribute__((vector_size(8 * LANES)));
#define PICK(m, a, b) ((vec)(((m) & (truths)(a)) | (~(m) & (truths)(b))))
#define LANE(v, i) ((v)[(i) / LANES][(i) % LANES])
#endif

INLINE vec each(double a) { return a - (vec){ 0 }; }
INLINE truths bits_of(vec a)
{
	truths t;
	memcpy(&t, &a, sizeof t);
	return t;
}
INLINE vec of_bits(truths t)
{
	vec a;
	memcpy(&a, &t, sizeof a);
	return a;
}
/* Whether some lane of a is above b's: to skip what no lane needs, never to choose what a lane gets. */
INLINE int any_above(vec a, vec b)
{
#if LANES == 8 && defined __AVX512F__
	return __builtin_ia32_cmppd512_mask(a, b, 30, 0xff, 4) != 0;    /* 30: >, quiet; 4: the rounding is nobody's concern */
#else
	truths t = (a > b);
#if LANES == 1
	return t != 0;
#elif LANES == 2 && defined __SSE2__
	return __builtin_ia32_movmskpd((vec)t) != 0;
#elif LANES == 4 && defined __AVX__
	return __builtin_ia32_movmskpd256((vec)t) != 0;
#else
	int64_t all = 0;
	for (int i = 0; i < LANES; i++)
		all |= t[i];
	return all != 0;
#endif
#endif
}

INLINE vec size_of(vec a) { return of_bits(bits_of(a) & INT64_MAX); }
INLINE vec larger(vec a, vec b) { return PICK((a > b), a, b); }
INLINE vec not_zero(vec a) { return PICK(a == 0, each(1e-290), a); }

#endif

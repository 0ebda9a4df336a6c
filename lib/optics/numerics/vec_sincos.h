/* vec_sincos - sine and cosine of a vector, without libm: the same bits at every width. */
#ifndef OPTICS_VEC_SINCOS_H
#define OPTICS_VEC_SINCOS_H

#include "optics/numerics/vec.h"

#define VEC_ROUND 0x1.8p52    /* added and taken away, rounds to an integer; which then stands in the low bits */

/* sin z and cos z, |z| < 2^30; error at most 1 unit of the last place of the larger of the two.
 * z is brought within pi/4 of a multiple k pi/2, which is taken off in pieces: k times the first three is exact, and what rounding leaves
 * of the difference is carried. The polynomials are Chebyshev fits of (sin r - r)/r^3 and (cos r - 1 + r^2/2)/r^4 in r^2. */
INLINE void vec_sincos(vec z, vec *sine, vec *cosine)
{
	vec turns = z * 0x1.45f306dc9c883p-1 + VEC_ROUND, k = turns - VEC_ROUND;
	vec near = (z - k * 0x1.921fb4p0) - k * 0x1.4442dp-24, third = k * 0x1.846988p-48, most = near - third;
	vec left = ((near - most) - third) - k * 0x1.8cc51701b839ap-72, r = most + left, rest = (most - r) + left;
	vec w = r * r, half = 0.5 * w, one = 1.0 - half;
	vec s = w * (-0.16666666666666666 + w * (0.008333333333330948 + w * (-0.00019841269836756774 + w * (2.7557316101617874e-06 +
		w * (-2.505113165023518e-08 + w * 1.5918115263265974e-10)))));
	vec c = w * w * (0.041666666666666664 + w * (-0.0013888888888887398 + w * (2.480158729876456e-05 + w * (-2.7557317271145144e-07 +
		w * (2.087614614655861e-09 + w * -1.1382623647474604e-11)))));
	s = r + (r * s + rest * one);
	c = one + (((1.0 - one) - half) + (c - r * rest));
	truths q = bits_of(turns), odd = -(q & 1), si = bits_of(s), ci = bits_of(c);
	*sine = of_bits(((odd & ci) | (~odd & si)) ^ (-(q >> 1 & 1) & INT64_MIN));
	*cosine = of_bits(((odd & si) | (~odd & ci)) ^ (-((q + 1) >> 1 & 1) & INT64_MIN));
}

#endif

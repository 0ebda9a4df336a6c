/* film - exact sums: each sample is rounded to a multiple of 2^-30 and added as a 64-bit integer, so that a pixel does not
 * depend on the order, or on how its samples are divided. */
#ifndef KERN_FILM_H
#define KERN_FILM_H

#include "render/kern/path.h"

#define FILM_UNIT 1073741824.0     /* 2^30 */
#define FILM_LIMIT 0x1p32          /* of the sum of a pixel's samples */

/* The integer nearest to v 2^30; saturates (NaN too) at +-2^31 2^30, far beyond what a sum may reach with the next. */
FN int64 film_value(float v)
{
	v = v < 2147483520.f ? v : 2147483520.f;
	v = v > -2147483520.f ? v : -2147483520.f;
	int whole = (int)v;
	int part = (int)((v - (float)whole) * 1073741824.f + (v < 0.f ? -0.5f : 0.5f));
	return (int64)whole * 1073741824 + part;
}

/* Samples [first, first + n) of a pixel added to its film[3]; *overflow is set where a sum passes FILM_LIMIT. */
FN void render_pixel(const struct scene *s, const struct tables *tab, GLOBAL int64 *film, GLOBAL int *overflow, uint32 pixel,
                     uint32 first, uint32 n)
{
	int64 sum[3] = { film[0], film[1], film[2] };
	const int64 limit = (int64)1 << 62;
	for (uint32 k = 0; k < n; k++) {
		struct path p = path_begin(s, pixel, first + k);
		while (path_bounce(s, tab, &p))
			;
		for (int i = 0; i < 3; i++) {
			sum[i] += film_value(p.rgb[i]);
			if (sum[i] > limit || sum[i] < -limit) {
				*overflow = 1;
				sum[i] = 0;
			}
		}
	}
	for (int i = 0; i < 3; i++)
		film[i] = sum[i];
}

#endif

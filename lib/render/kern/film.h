/* film - exact sums: each sample's values are rounded to a multiple of 2^-30 and added as 64-bit integers, so that a pixel does
 * not depend on the order, or on how its samples are divided. */
#ifndef KERN_FILM_H
#define KERN_FILM_H

#include "render/kern/path.h"

#define FILM_UNIT 1073741824.0     /* 2^30 */
#define FILM_LIMIT 0x1p32          /* of a sum over a pixel's samples; a sample alone stays below 2^31 */

/* The sums of a pixel. Three are red, green and blue. */
enum {
	SUM_ALL,                   /* the parts below and what was seen unscattered */
	SUM_SINGLE = 3,            /* scattered once by the medium */
	SUM_MULTIPLE = 6,          /* more often */
	SUM_ALPHA = 9,             /* 1 where the camera's ray was scattered, as a mean over all wavelengths */
	SUM_DEPTH,                 /* how far away, times the former, in units of 2^-30 / depth_scale */
	SUM_LUMINANCE,
	SUM_SQUARE,                /* of luminance: 128 bits, low half first, in units of 2^-60 */
	FILM_SUMS = 14             /* then, if spectral, the radiance at each wavelength */
};

/* The integer nearest to v 2^30; saturates (NaN too) at +-FILM_MOST. */
#define FILM_MOST ((int64)2147483520 * 1073741824)
FN int64 film_value(float v)
{
	v = v < 2147483520.f ? v : 2147483520.f;
	v = v > -2147483520.f ? v : -2147483520.f;
	int whole = (int)v;
	int part = (int)((v - (float)whole) * 1073741824.f + (v < 0.f ? -0.5f : 0.5f));
	return (int64)whole * 1073741824 + part;
}

/* Adds v, of up to 3 FILM_MOST; returns 1, the sum being 0 then, where v or the sum is out of range. */
FN int film_add(int64 *sum, int64 v)
{
	const int64 limit = (int64)1 << 62;
	*sum = v < FILM_MOST && v > -FILM_MOST ? *sum + v : limit + 1;
	if (*sum <= limit && *sum >= -limit)
		return 0;
	*sum = 0;
	return 1;
}

/* Adds v^2 to sum[2], for |v| <= 2^61; returns 1 where the sum is beyond 2^127. */
FN int film_add_square(int64 *sum, int64 v)
{
	uint64 a = (uint64)(v < 0 ? -v : v), high = a >> 32, low = a & 0xffffffffu, cross = 2 * (high * low);
	uint64 before = (uint64)sum[0], square = low * low, after = before + square, carry = after < before;
	high = high * high + (cross >> 32) + carry;
	before = after;
	after += cross << 32;
	high += after < before;
	sum[0] = (int64)after;
	high += (uint64)sum[1];
	sum[1] = (int64)(high & 0x7fffffffffffffff);
	return high >> 63 != 0;
}

/* A path that is over. */
FN int film_take(const struct scene *s, int64 *sum, const struct path *p)
{
	int bad = 0;
	float rgb[3];
	for (int i = 0; i < 3; i++) {
		int64 seen = film_value(p->rgb[i]), all = seen;
		rgb[i] = p->rgb[i];
		if (p->order) {
			int64 once = p->order == 1 ? seen : film_value(p->before[1][i]), more = p->order == 1 ? 0 : seen;
			bad |= film_add(sum + SUM_SINGLE + i, once) | film_add(sum + SUM_MULTIPLE + i, more);
			all = film_value(p->before[0][i]) + once + more;
			rgb[i] += p->before[0][i] + p->before[1][i];
		}
		bad |= film_add(sum + SUM_ALL + i, all);
	}
	int64 luminance = film_value(0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]);
	bad |= film_add(sum + SUM_LUMINANCE, luminance) | film_add_square(sum + SUM_SQUARE, luminance);
	if (p->depth >= 0.f) {     /* wavelengths of smaller groups are heroes more often */
		float share = (float)(p->waves.n * s->n_groups) / (float)s->n_waves;
		bad |= film_add(sum + SUM_ALPHA, film_value(share)) | film_add(sum + SUM_DEPTH, film_value(share * (p->depth * s->depth_scale)));
	}
	return bad;
}

/* Samples [first, first + n) of a pixel added to its film; *overflow is set where a sum passes FILM_LIMIT. */
FN void render_pixel(const struct scene *s, const struct tables *tab, GLOBAL int64 *film, GLOBAL int *overflow, uint32 pixel,
                     uint32 first, uint32 n)
{
	int64 sum[FILM_SUMS];
	int bad = 0;
	for (int i = 0; i < FILM_SUMS; i++)
		sum[i] = film[i];
	for (uint32 k = 0; k < n; k++) {
		struct path p = path_begin(s, pixel, first + k);
		while (path_bounce(s, tab, &p))
			;
		bad |= film_take(s, sum, &p);
		for (int j = 0; s->spectral && j < p.waves.n; j++) {
			int64 wave = film[FILM_SUMS + wave_of(p.waves, j)];
			bad |= film_add(&wave, film_value(p.spectrum[j]));
			film[FILM_SUMS + wave_of(p.waves, j)] = wave;
		}
	}
	for (int i = 0; i < FILM_SUMS; i++)
		film[i] = sum[i];
	if (bad)
		*overflow = 1;
}

#endif

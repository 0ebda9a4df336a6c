/* film - exact sums: each sample's values are rounded to a multiple of 2^-30 and added as 64-bit integers, so that a pixel does
 * not depend on the order, or on how its samples are divided. */
#ifndef KERN_FILM_H
#define KERN_FILM_H

#include "render/kern/path_state.h"

#define FILM_UNIT 1073741824.0     /* 2^30 */

/* The sums of a pixel, added eight at a time: all that one channel needs, red, comes first; then the square, apart from them since
 * it is added by itself; then green and blue. */
enum {
	SUM_ALL,                   /* the two below and what was seen unscattered */
	SUM_SINGLE,                /* scattered once by the medium */
	SUM_MULTIPLE,              /* more often */
	SUM_ALPHA,                 /* 1 where the camera's ray was scattered, as a mean over all wavelengths */
	SUM_DEPTH,                 /* how far away, times the former, in units of 2^-30 / depth_scale */
	SUM_LUMINANCE,
	SUM_ALPHA_BLUE,            /* what a coloured medium takes away from white light behind it, by channels */
	SUM_SECOND,                /* luminance of the second replicate's samples, see random.h */
	SUM_SQUARE = 8,            /* of luminance: 128 bits, low half first, in units of 2^-60 */
	SUM_GREEN = 10,            /* all, single, multiple; then blue */
	SUM_ALPHA_RED = 16,
	SUM_ALPHA_GREEN,
	FILM_SUMS                  /* then, if spectral, the radiance at each wavelength, and alpha at each */
};
#define SUM_OF(kind, channel) ((channel) ? SUM_GREEN + 3 * ((channel) - 1) + (kind) : (kind))

#define FILM_MOST 2147483520.f      /* a sample's value is smaller in size */

/* The integers nearest to v 2^30, halves away from 0. */
FN l8 film_integers(f8 v)
{
	f8 units = v * 1073741824.f;
	l8 n = l8_of(units);
	return n + l8_of(2.f * (units - f8_of(n)));    /* the rest is exact: 0 from 2^24 on */
}

/* Bit 62 is set in the result where a sum passes its limit, 2^62 either way: bits 62 and 63 of it then differ. A sample adds less than
 * half of that, so that this is seen before a sum wraps. */
FN l8 film_beyond(l8 sum) { return sum ^ sum >> 1; }
#define FILM_BEYOND(bits) ((bits) >> 62 & 1)

/* Adds eight to as many sums; returns where one passes its limit. */
FN l8 film_add8(GLOBAL int64 *sum, l8 n)
{
	l8 all = l8_sum(l8_load(sum), n);
	l8_store(sum, all);
	return film_beyond(all);
}

/* Adds v^2 to sum[2], for |v| <= 2^61; returns what has its highest bit set where the sum is beyond 2^127. */
FN uint64 film_add_square(GLOBAL int64 *sum, int64 v)
{
	uint64 a = (uint64)(v < 0 ? -v : v), low = (uint64)sum[0] + a * a, high = (uint64)sum[1] + high_product(a, a) + (low < a * a);
	sum[0] = (int64)low;
	sum[1] = (int64)(high & 0x7fffffffffffffff);
	return high;
}

/* Lanes of m whose value is too large, or no number: these become FILM_MOST. */
FN mv film_clamp(mv m, fv *value)
{
	mv good = lt(fv_abs(*value), FV(FILM_MOST));
	*value = SEL(good, *value, FV(FILM_MOST));
	return m & NOT(good);
}

/* What the paths of lanes m add to each of the sums, but the square, and but for what lib/render/film.c makes of them: SUM_ALL gets
 * what was seen unscattered. Returns the lanes that have what no sum can take. */
FN mv film_values(const struct scene *s, struct path *p, mv m, iv sample, fv *value)
{
	mv scattered = ilt(IV(0), p->order), often = ilt(IV(1), p->order), bad = NO_LANE;
	fv zero = FV(0.f), all[3] = { zero, zero, zero };
	for (int c = 0; c < CHANNELS; c++) {
		/* what was seen last belongs to the order that the path ended in */
		fv last = p->rgb[c], none = p->before[0][c], once = p->before[1][c];
		fv single = SEL(often, once, SEL(scattered, last, zero)), more = SEL(often, last, zero);
		none = SEL(scattered, none, last);
		if (HAS_PEAK) {
			single += p->aside[0][c];
			more += p->aside[1][c];
		}
		bad |= film_clamp(m, &none) | film_clamp(m, &single) | film_clamp(m, &more);
		value[SUM_OF(SUM_ALL, c)] = none;
		value[SUM_OF(SUM_SINGLE, c)] = single;
		value[SUM_OF(SUM_MULTIPLE, c)] = more;
		all[c] = value[SUM_OF(SUM_ALL, c)] + value[SUM_OF(SUM_SINGLE, c)] + value[SUM_OF(SUM_MULTIPLE, c)];
	}
	/* wavelengths of smaller groups are heroes more often */
	fv share = s->n_groups == 1 ? FV(1.f) : to_float(p->waves.n * s->n_groups) / (float)s->n_waves;
	value[SUM_ALPHA] = share * p->cover;
	value[SUM_DEPTH] = SEL(le(zero, p->depth), share * (p->depth * s->depth_scale), zero);
	value[SUM_LUMINANCE] = CHANNELS == 1 ? all[0] : 0.2126f * all[0] + 0.7152f * all[1] + 0.0722f * all[2];
	bad |= film_clamp(m, &value[SUM_LUMINANCE]);
	value[SUM_SECOND] = value[SUM_LUMINANCE] * to_float(signed_of(replicate_of(unsigned_of(sample))));
	value[SUM_ALPHA_RED] = COLOURED ? p->alpha[0] : zero;
	value[SUM_ALPHA_GREEN] = COLOURED ? p->alpha[1] : zero;
	value[SUM_ALPHA_BLUE] = COLOURED ? p->alpha[2] : zero;
	if (COLOURED)
		bad |= film_clamp(m, &value[SUM_ALPHA_RED]) | film_clamp(m, &value[SUM_ALPHA_GREEN]) | film_clamp(m, &value[SUM_ALPHA_BLUE]);
	if (SPECTRAL)
		EACH_WAVE(j)
			bad |= film_clamp(m, &p->spectrum[j]) | film_clamp(m, &p->spectral_alpha[j]);
	return bad;
}

/* Those of lane i added to its pixel, and the path's spectrum. *over: as film_beyond; the highest bit of what it returns is set where
 * the sum of squares passes its own. */
FN uint64 film_take(const struct scene *s, GLOBAL int64 *sum, const struct path *p, const fv *value, int i, l8 *over)
{
#define EIGHT(v, a, b) F8(LANE_FLOAT((v)[0], i), LANE_FLOAT((v)[1], i), LANE_FLOAT((v)[2], i), LANE_FLOAT((v)[3], i), \
                          LANE_FLOAT((v)[4], i), LANE_FLOAT((v)[5], i), a, b)
	l8 n = film_integers(EIGHT(value, LANE_FLOAT(value[SUM_ALPHA_BLUE], i), LANE_FLOAT(value[SUM_SECOND], i)));
	*over |= film_add8(sum, n);
	uint64 high = film_add_square(sum + SUM_SQUARE, PART(n, SUM_LUMINANCE));
	if (CHANNELS == 3)
		*over |= film_add8(sum + SUM_GREEN, film_integers(EIGHT(value + SUM_GREEN, LANE_FLOAT(value[SUM_ALPHA_RED], i),
		                                                        LANE_FLOAT(value[SUM_ALPHA_GREEN], i))));
#undef EIGHT
	for (int j = 0; SPECTRAL && j < LANE(p->waves.n, i); j++) {
		GLOBAL int64 *own = sum + FILM_SUMS + LANE(p->waves.first, i) + s->n_groups * j;
		float v = LANE_FLOAT(p->spectrum[j], i), a = LANE_FLOAT(p->spectral_alpha[j], i);
		l8 all = l8_sum(film_integers(F8(v, a, 0.f, 0.f, 0.f, 0.f, 0.f, 0.f)), L8(own[0], own[s->n_waves], 0, 0, 0, 0, 0, 0));
		own[0] = PART(all, 0);
		own[s->n_waves] = PART(all, 1);
		*over |= film_beyond(all);
	}
	(void)i;                   /* of one lane, unused */
	return high;
}

#endif

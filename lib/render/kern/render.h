/* render - all samples of a range of pixels, LANES paths at a time; a lane whose path is over begins the next sample at once. */
#ifndef KERN_RENDER_H
#define KERN_RENDER_H

#include "render/kern/film.h"
#include "render/kern/path.h"

/* How many lanes wait at a vertex until the rest has gone on, and how many paths that are over until new ones begin: enough to be
 * worth their while, but not so many that few do something meanwhile. */
#define VERTEX_WAIT ((LANES + 1) / 2)
#define BEGIN_WAIT ((LANES + 3) / 4)

/* The samples still to do, pixel by pixel; and those that lanes are at. */
struct work {
	uint32 pixel, column, row, sample;
	uint32 last_pixel, first_sample, last_sample;
	iv at_pixel, at_column, at_row, at_sample;
};

/* Give the next samples to lanes m; returns those for which there was one. */
FN mv work_take(const struct scene *s, struct work *w, mv m)
{
	iv left = IV(0);
	EACH_LANE_OF(m, i) {
		if (w->pixel < w->last_pixel) {
			LANE(w->at_pixel, i) = (int)w->pixel;
			LANE(w->at_column, i) = (int)w->column;
			LANE(w->at_row, i) = (int)w->row;
			LANE(w->at_sample, i) = (int)w->sample;
			LANE(left, i) = 1;
			if (++w->sample == w->last_sample) {
				w->sample = w->first_sample;
				w->pixel++;
				w->row += ++w->column == (uint32)s->camera.width;
				w->column = w->column == (uint32)s->camera.width ? 0 : w->column;
			}
		}
	}
	return ieq(left, IV(1));
}

/* Samples [first, last) of pixels [first_pixel, last_pixel) added to the film; *overflow is set where a sum passes 2^32. */
FN void render_pixels(const struct scene *s, const struct tables *t, GLOBAL int64 *film, GLOBAL int *overflow, uint32 first_pixel,
                      uint32 last_pixel, uint32 first, uint32 last)
{
	uint32 width = (uint32)s->camera.width;
	struct work work = { first_pixel, first_pixel % width, first_pixel / width, first, last_pixel, first, last,
		IV(0), IV(0), IV(0), IV(0) };
	struct path p = { 0 };
	mv live = NO_LANE, over = NO_LANE, fresh = work_take(s, &work, ALL_LANES), leaving = NO_LANE;
	mv bad = NO_LANE;
	uint64 square = 0;
	l8 high = L8(0, 0, 0, 0, 0, 0, 0, 0);
	while (any(fresh | live)) {
		if (any(fresh))
			path_begin(s, &p, fresh, work.at_pixel, work.at_column, work.at_row, work.at_sample);
		live |= fresh;
		path_fly(s, t, &p, fresh | leaving);
		int least = count(live) - VERTEX_WAIT;
		media_step(s, t, &p.walk, p.waves, &p.walk_random, least > 0 ? least : 0);
		mv here = live & NOT(media_going(s, &p.walk)), chained = HAS_PEAK ? here & p.chain.flying : NO_LANE;
		mv ended = path_arrive(s, t, &p, here & p.flying);
		if (any(chained))
			chain_arrive(s, t, &p, chained);
		leaving = live & NOT(p.flying | media_going(s, &p.walk) | ended | (HAS_PEAK ? p.chain.flying : NO_LANE));
		ended |= path_depart(s, t, &p, leaving);
		leaving &= NOT(ended);
		live &= NOT(ended);
		over |= ended;
		fresh = NO_LANE;
		if (any(live) && count(over) < BEGIN_WAIT)
			continue;
		fv value[FILM_SUMS];
		bad |= film_values(s, &p, over, work.at_sample, value);
		EACH_LANE_OF(over, i)
			square |= film_take(s, film + (int64)s->film_sums * LANE(work.at_pixel, i), &p, value, (int)i, &high);
		fresh = work_take(s, &work, over);
		over = NO_LANE;
	}
	EACH(k, 8)
		if (any(bad) || square >> 63 || FILM_BEYOND(PART(high, k)))
			*overflow = 1;
}

#endif

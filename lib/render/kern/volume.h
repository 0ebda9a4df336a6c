/* volume - free flight and transmittance in the four models of the medium.
 *
 * A ray on its way through the medium is a march: either a free flight, which ends at a collision or passes, or a shadow ray, whose
 * transmittance is wanted. Lanes march side by side, each in its own ray, and end at different times.
 *
 * A flight is sampled for one wavelength, the hero; event[j] is what its own density would be for wavelength j: the common
 * currency in which the wavelengths of a path are weighed against each other. */
#ifndef KERN_VOLUME_H
#define KERN_VOLUME_H

#include "render/kern/particles.h"
#include "render/kern/voxels.h"

/* Random numbers of a vertex. Even ones come first; an alias table tears apart what is even, so its numbers are not. */
enum { DRAW_FLIGHT, DRAW_AZIMUTH, DRAW_COSINE, DRAW_LIGHT, DRAW_LIGHT_1, DRAW_LIGHT_2,
       DRAW_CLASS, DRAW_SHADOW, DRAW_SHADOWED, DRAW_ANGLE, DRAW_PLACE, DRAW_ROULETTE, DRAW_DETOUR };

/* Through one medium of the mean extinction nothing needs steps. */
struct bulk {
	struct vec entry, along;
	fv t0, length;             /* along the ray */
};

struct march {
	struct gather gather;      /* of these three, the transport's is used */
	struct passage passage;
	struct bulk bulk;
};

/* Where rays take steps, or detours, lanes wait for each other, and what concerns a vertex must be kept for those that do. */
#define MARCHES (TRANSPORT != TRANSPORT_CONTINUOUS)    /* a ray takes steps */
#define LANES_WAIT (MARCHES || PEAK)
#define PUT(m, place, value) ((place) = LANES_WAIT ? SEL(m, value, place) : (value))
#define PUT3(m, place, value) ((place) = LANES_WAIT ? sel3(m, value, place) : (value))

#define AMONG_PARTICLES (TRANSPORT == TRANSPORT_EXPLICIT || TRANSPORT == TRANSPORT_FAT_RAY)

FN mv marching(const struct scene *s, const struct march *g)
{
	return AMONG_PARTICLES ? g->gather.going : TRANSPORT == TRANSPORT_GRID ? g->passage.going : NO_LANE;
}

/* Lanes m set out along r up to t_end, in flight, or else as shadow rays. */
FN void march_begin(const struct scene *s, const struct tables *t, struct march *g, mv m, struct ray r, fv t_end, mv flight,
                    struct waves w, iv hero, const struct random *random)
{
	if (AMONG_PARTICLES) {
		gather_begin(s, &g->gather, m, r, t_end, flight);
	} else if (TRANSPORT == TRANSPORT_GRID) {
		fv target = free_path(SEL(flight, draw_bits(random, DRAW_FLIGHT), draw_bits(random, DRAW_SHADOW)));
		target += SEL(flight, FV(0.f), FV(SHADOW_DEPTH));
		if (!COUNTED) {     /* in units of the integral of the density */
			fv own = of_hero(s, t->extinction, m, w, hero), thinnest = own;
			EACH_WAVE(j)
				thinnest = fv_min(thinnest, of_wave(s, t->extinction, 0, m, w, j));
			own = SEL(flight, own, thinnest);
			target = SEL(lt(FV(0.f), own), target / own, FV(FAR));
		}
		passage_begin(s, &g->passage, m, r, t_end, flight, target);
	} else {
		fv t0, t1;
		clip_medium(s, r, &t0, &t1);
		PUT3(m, g->bulk.entry, add(r.from, scale(r.along, t0)));
		PUT3(m, g->bulk.along, r.along);
		PUT(m, g->bulk.t0, t0);
		PUT(m, g->bulk.length, fv_max(fv_min(t1, t_end) - t0, FV(0.f)));
	}
}

/* A step of all lanes under way. */
FN void march_on(const struct scene *s, const struct tables *t, struct march *g, struct waves w, iv hero, const struct random *random)
{
	if (AMONG_PARTICLES)
		gather_on(s, t, &g->gather, w, random);
	else if (TRANSPORT == TRANSPORT_GRID)
		passage_on(s, t, &g->passage, w, hero);
}

/* What shadow rays m let through at each wavelength. */
FN void shadow_end(const struct scene *s, const struct tables *t, const struct march *g, mv m, struct waves w, fv *out)
{
	if (AMONG_PARTICLES) {
		EACH_WAVE(j)
			out[j] = gather_through(s, &g->gather, j);
	} else if (TRANSPORT == TRANSPORT_GRID) {
		fv thinnest = FV(FAR);
		EACH_WAVE(j) {
			out[j] = COUNTED ? g->passage.depth[j] : of_wave(s, t->extinction, 0, m, w, j) * g->passage.depth[0];
			thinnest = fv_min(thinnest, out[j]);
		}
		fv sure = fv_max(FV(0.f), thinnest - SHADOW_DEPTH);    /* e^-sure was the chance to come through */
		EACH_WAVE(j)
			out[j] = SEL(g->passage.reached, FV(0.f), expneg(out[j] - sure));
	} else {
		EACH_WAVE(j)
			out[j] = expneg(of_wave(s, t->extinction, 0, m, w, j) * g->bulk.length);
	}
}

/* Where flights end. */
struct collision {
	mv happened;               /* else it reached t_end */
	struct vec point;          /* of the collision */
	fv t;                      /* how far away */
	iv class, id;              /* what scatters there; id NONE where it is no single particle */
};

FN struct collision flight_particles(const struct scene *s, const struct tables *t, const struct gather *g, mv m, iv hero, fv *event)
{
	struct collision c = { NO_LANE, g->entry, FV(0.f), IV(0), g->id[0] };
	EACH_WAVE(j)
		c.id = SEL(ieq(hero, IV(j)), g->id[j], c.id);
	c.happened = m & NOT(ieq(c.id, IV(NONE)));
	fv depth = hero_among(s, g->depth, hero);
	c.point = add(g->entry, scale(g->along, depth));
	c.t = depth - g->ahead;
	if (s->only_class >= 0)
		c.class = IV(s->only_class);
	else
		particle_at(t, c.happened, c.id, &c.class);
	EACH_WAVE(j)
		event[j] = SEL(ieq(g->id[j], c.id), FV(1.f), FV(0.f));
	return c;
}

/* Which class of a cube's particles is met: by count x c_ext of the hero. */
FN iv class_in(const struct scene *s, const struct tables *t, mv m, const struct passage *g, iv wave, fv u)
{
	iv i[3];
	indices(g, i);
	iv class = IV(0), row = (((i[2] - BRICK) * s->voxels[1] + (i[1] - BRICK)) * s->voxels[0] + (i[0] - BRICK)) * s->n_classes;
	fv all = FV(0.f), sum = FV(0.f);
	for (int k = 0; k < s->n_classes; k++)
		all += to_float(igather(m, t->count, row + k)) * gather(m, t->disc, k * s->n_waves + wave);
	for (int k = 0; k < s->n_classes; k++) {
		fv own = to_float(igather(m, t->count, row + k)) * gather(m, t->disc, k * s->n_waves + wave);
		class = SEL(lt(FV(0.f), own) & le(sum, u * all), IV(k), class);
		sum += own;
	}
	return class;
}

FN struct collision flight_voxels(const struct scene *s, const struct tables *t, struct passage *g, mv m, struct waves w, iv hero,
                                  const struct random *random, fv *event)
{
	struct collision c = { m & g->reached, g->entry, passage_end(s, t, g, m), IV(s->n_classes), IV(NONE) };
	c.point = add(g->entry, scale(g->along, c.t));
	c.t += g->t0;
	if (COUNTED)
		c.class = s->only_class >= 0 ? IV(s->only_class)
		    : class_in(s, t, c.happened, g, hero_of(s, w, hero), draw(random, DRAW_CLASS));
	EACH_WAVE(j) {
		fv own = of_wave(s, t->extinction, 0, m, w, j), depth = COUNTED ? g->depth[j] : own * g->depth[0];
		fv rate = COUNTED ? of_class(s, t->disc, c.happened, c.class, w, j) * s->largest_inverse : own;
		event[j] = expneg(depth) * SEL(c.happened, rate, FV(1.f));
	}
	return c;
}

FN struct collision flight_bulk(const struct scene *s, const struct tables *t, const struct bulk *g, mv m, struct waves w, iv hero,
                                const struct random *random, fv *event)
{
	fv sigma = of_hero(s, t->extinction, m, w, hero), free = free_path(draw_bits(random, DRAW_FLIGHT));
	mv happened = m & lt(free, sigma * g->length);
	fv length = SEL(happened, free * (1.f / sigma), g->length);
	struct collision c = { happened, add(g->entry, scale(g->along, length)), g->t0 + length, IV(s->n_classes), IV(NONE) };
	EACH_WAVE(j) {
		fv own = of_wave(s, t->extinction, 0, m, w, j);
		event[j] = expneg(own * length) * SEL(c.happened, own, FV(1.f));
	}
	return c;
}

/* How flights m ended; event[j]: their density (collision) or probability (none) for wavelength j, up to a common factor. */
FN struct collision flight_end(const struct scene *s, const struct tables *t, struct march *g, mv m, struct waves w, iv hero,
                               const struct random *random, fv *event)
{
	struct collision c = AMONG_PARTICLES ? flight_particles(s, t, &g->gather, m, hero, event)
	    : TRANSPORT == TRANSPORT_GRID ? flight_voxels(s, t, &g->passage, m, w, hero, random, event)
	    : flight_bulk(s, t, &g->bulk, m, w, hero, random, event);
	if (CARRIED == 1)          /* the hero alone: its own event, whatever it is */
		event[0] = FV(1.f);
	return c;
}

#endif

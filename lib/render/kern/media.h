/* media - flights and shadow rays through all volumes of a scene, which may overlap.
 *
 * What is in one volume knows nothing of the others: a flight ends at the nearest of the collisions that flights through each alone
 * would have, and transmittances multiply. The volumes are passed one by one, each with random numbers of its own, a flight no further
 * than to the nearest collision so far. One that has collided has passed all others up to there; those that were passed before were
 * passed too far, and of several wavelengths are passed again, to the collision, for the pdf there.
 *
 * A volume that only absorbs ends the camera's own flights, so that alpha and depth tell of it; further ones lose weight in it instead, by
 * its transmittance to the collision that the others, which come before it, have settled. */
#ifndef KERN_MEDIA_H
#define KERN_MEDIA_H

#include "render/kern/volume.h"

/* For any number of volumes, one of them included, one copy has to do. */
#ifdef VOLUMES
#define MEDIA_FN FN
#else
#define MEDIA_FN FN_ONCE
#endif

struct media_walk {
	struct volume_walk walk;   /* through the volume at hand */
	/* of several volumes */
	mv going;                  /* not yet through all of them */
	mv flight;                 /* else a shadow ray */
	mv by_chance;              /* a flight that ends where it is absorbed */
	mv again;                  /* a flight that passes the volumes before that of its collision once more */
	iv at;                     /* the volume at hand */
	struct ray ray;
	fv t_end;                  /* the nearest collision, or where the ray ends */
	struct collision nearest;
	fv passed[CARRIED];        /* pdf of the flight, transmittance of the shadow ray, so far */
	fv kept[CARRIED];          /* of a flight's weight */
};

/* Random numbers of volume k, the first of which has the vertex's own. */
FN struct random volume_random(const struct random *random, int k)
{
	struct random r = *random;
	if (k) {
		r.key = r.shift = mix(r.shift + (uint32)k * 0x9e3779b9u, random->key ^ 0x7feb352du);
		r.lattice = UV(0);
	}
	return r;
}

/* Lanes that have steps to take. */
FN mv media_going(const struct scene *s, const struct media_walk *g)
{
	return N_VOLUMES > 1 ? g->going : volume_going(&s->volume[0], &g->walk);
}

/* Flights through a volume, all others being shadow rays there. */
FN mv flights_in(const struct volume *v, const struct media_walk *g) { return v->absorbs ? g->flight & g->by_chance : g->flight; }

/* Lanes m set out through the volume that they have come to. */
FN_ONCE void media_enter(const struct scene *s, const struct tables *t, struct media_walk *g, mv m, struct waves w,
                         const struct random *random)
{
	for (int k = 0; k < N_VOLUMES; k++) {
		mv own = m & ieq(g->at, IV(k));
		if (!any(own))
			continue;
		struct random numbers = volume_random(random, k);
		struct ray r = g->ray;
		r.from = sub(r.from, load3(s->volume[k].centre));
		r.skip = SEL(ieq(r.volume, IV(k)), r.skip, IV(NONE));
		volume_begin(s, &s->volume[k], t + k, &g->walk, own, r, g->t_end, flights_in(&s->volume[k], g), w, &numbers);
	}
}

/* Lanes m set out along r up to t_end, in flight, or else as shadow rays; by_chance: flights that end where they are absorbed. */
MEDIA_FN void media_begin(const struct scene *s, const struct tables *t, struct media_walk *g, mv m, struct ray r, fv t_end,
                          mv flight, mv by_chance, struct waves w, const struct random *random)
{
	if (N_VOLUMES == 1) {
		volume_begin(s, &s->volume[0], t, &g->walk, m, r, t_end, flight, w, random);
		return;
	}
	set3(m, &g->ray.from, r.from);
	set3(m, &g->ray.along, r.along);
	set3(m, &g->ray.inverse, r.inverse);
	SET(m, g->ray.skip, r.skip);
	SET(m, g->ray.volume, r.volume);
	SET(m, g->t_end, t_end);
	SET(m, g->at, IV(0));
	EACH_WAVE(j) {
		SET(m, g->passed[j], FV(1.f));
		SET(m, g->kept[j], FV(1.f));
	}
	SET_TRUTH(m, g->by_chance, by_chance);
	SET_TRUTH(m, g->flight, flight);
	SET_TRUTH(m, g->again, NO_LANE);
	SET_TRUTH(m, g->nearest.happened, NO_LANE);
	g->going |= m;
	media_enter(s, t, g, m, w, random);
}

/* Lanes m have come through volume k, or into a collision in it. */
FN void media_pass(const struct scene *s, const struct tables *t, struct media_walk *g, int k, mv m, struct waves w,
                   const struct random *random)
{
	const struct volume *v = &s->volume[k];
	struct random numbers = volume_random(random, k);
	mv flight = m & flights_in(v, g), shadow = m & NOT(flight);
	fv own[CARRIED];
	if (any(shadow)) {
		volume_transmittance(s, v, t + k, &g->walk, shadow, w, own);
		EACH_WAVE(j) {
			SET(shadow & NOT(g->flight), g->passed[j], g->passed[j] * own[j]);
			SET(shadow & g->flight, g->kept[j], g->kept[j] * own[j]);
		}
	}
	if (!any(flight))
		return;
	struct collision c = volume_end(s, v, t + k, &g->walk, flight, w, &numbers, own);
	mv met = c.happened & NOT(g->again);
	EACH_WAVE(j)           /* what was passed before a collision is passed again */
		SET(flight, g->passed[j], SEL(met, own[j], g->passed[j] * own[j]));
	set3(met, &g->nearest.point, add(c.point, load3(v->centre)));
	SET(met, g->nearest.t, c.t);
	SET(met, g->nearest.class, c.class);
	SET(met, g->nearest.id, c.id);
	SET(met, g->nearest.volume, IV(k));
	SET(met, g->t_end, c.t);
	g->nearest.happened |= met;
}

/* Lanes m have done with the volume at hand, and go on through the next one. */
FN_ONCE void media_next(const struct scene *s, const struct tables *t, struct media_walk *g, mv m, struct waves w,
                        const struct random *random)
{
	for (int k = 0; k < N_VOLUMES; k++) {
		mv own = m & ieq(g->at, IV(k));
		if (any(own))
			media_pass(s, t, g, k, own, w, random);
	}
	fv most = FV(0.f);
	EACH_WAVE(j)
		most = fv_max(most, g->passed[j]);
	SET(m, g->at, g->at + 1);
	mv on = m & ilt(g->at, SEL(g->again, g->nearest.volume, IV(N_VOLUMES))) & (g->flight | lt(FV(0.f), most));
	if (CARRIED > 1) {
		mv again = m & NOT(on | g->again) & g->nearest.happened & ilt(IV(0), g->nearest.volume);
		SET(again, g->at, IV(0));
		g->again |= again;
		on |= again;
	}
	g->going &= NOT(m & NOT(on));
	if (any(on))
		media_enter(s, t, g, on, w, random);
}

/* All lanes that have steps to take do so, until at most least of them have any left. */
FN void media_step(const struct scene *s, const struct tables *t, struct media_walk *g, struct waves w, const struct random *random,
                   int least)
{
	if (N_VOLUMES == 1) {
		volume_step(s, &s->volume[0], t, &g->walk, w, random, least);
		return;
	}
	while (count(g->going) > least) {
		for (int k = 0; k < N_VOLUMES; k++) {
			mv own = g->walk.ray.going & ieq(g->at, IV(k)), others = g->walk.ray.going & NOT(own);
			int n = count(own);
			if (!n)
				continue;
			struct random numbers = volume_random(random, k);
			g->walk.ray.going = own;
			volume_step(s, &s->volume[k], t + k, &g->walk, w, &numbers, (n - 1) / 2);
			g->walk.ray.going |= others;
		}
		mv done = g->going & NOT(g->walk.ray.going);
		if (any(done))
			media_next(s, t, g, done, w, random);
	}
}

/* What shadow rays m let through at each wavelength. */
FN void media_transmittance(const struct scene *s, const struct tables *t, struct media_walk *g, mv m, struct waves w, fv *out)
{
	if (N_VOLUMES == 1) {
		volume_transmittance(s, &s->volume[0], t, &g->walk, m, w, out);
		return;
	}
	EACH_WAVE(j)
		out[j] = g->passed[j];
}

/* What flights m keep of wavelength j's weight. */
FN fv media_kept(const struct scene *s, const struct media_walk *g, int j) { return N_VOLUMES == 1 ? FV(1.f) : g->kept[j]; }

/* How flights m ended; flight_pdf as volume_end. */
MEDIA_FN struct collision media_end(const struct scene *s, const struct tables *t, struct media_walk *g, mv m, struct waves w,
                                    const struct random *random, fv *flight_pdf)
{
	if (N_VOLUMES == 1)
		return volume_end(s, &s->volume[0], t, &g->walk, m, w, random, flight_pdf);
	struct collision c = g->nearest;
	c.happened &= m;
	EACH_WAVE(j)
		flight_pdf[j] = CARRIED == 1 ? FV(1.f) : g->passed[j];
	return c;
}

#endif

/* forward_peak - next-event estimation under a high forward peak, by chains of scatterings.
 *
 * Ordinary next-event estimation gives spikes there: p towards a sun is huge in the rare case that the path travels that way. So p is
 * taken as what is below its truncation and the peak above it. Of the scatterings of any path to a sun, one is the last below the
 * truncation, and those after it are by peaks. At each vertex, what is below the truncation is estimated as that last one: by a chain
 * of n further scatterings by the peak, n being geometric, whose directions are drawn backwards from the sun and whose flights go
 * forward. What is evaluated is then at most truncation / (1 - peak). Paths that may have been scattered by peaks alone, from the camera
 * or the ground on, are weighed by the share of their pdf that was: for them the sun is estimated by the peak at the vertex, and met by
 * chance. A sun so large that multiple importance sampling bounds its spikes lower is left to that. All this is where the
 * first volume alone scatters. */
#ifndef KERN_FORWARD_PEAK_H
#define KERN_FORWARD_PEAK_H

#include "render/kern/light.h"
#include "render/kern/path_state.h"
#include "render/kern/phase.h"

#define PEAK_CLASS (s->volume[0].n_classes + 1)    /* its phase function is the peak */

/* Random numbers of the k-th scattering of a chain, counted from the sun. */
FN struct random chain_random(const struct path *p, iv k)
{
	struct random r = p->random;
	r.key = r.shift = mix(unsigned_of(k) * 0x9e3779b1u, p->random.key ^ 0x2c1b3c6du);
	r.lattice = UV(0);
	return r;
}

/* Directions from which n scatterings by the peak turn to a light; their pdf is taken into pdf[j]. */
FN struct vec chain_direction(const struct scene *s, const struct tables *t, struct path *p, mv m, iv n, struct vec light,
                              fv *pdf)
{
	for (int k = 1; any(m &= NOT(ilt(n, IV(k)))); k++) {
		struct random r = chain_random(p, IV(k));
		fv sn, cs, value[CARRIED];
		phase_draw(s, t, m, PEAK_CLASS, IV(0), p->waves, draw_bits(&r, DRAW_ANGLE), draw_bits(&r, DRAW_PLACE), &sn, &cs, value);
		take_pdf(s, p->waves, pdf, m, value);
		set3(m, &light, to_world(light, sn, cs, 2.f * PI * draw(&r, DRAW_AZIMUTH)));
	}
	return light;
}

/* Chains of lanes m from a vertex to a light: their length, none in other lanes. Returns the direction in which they leave. */
FN struct vec chain_begin(const struct scene *s, const struct tables *t, struct path *p, mv m, struct vec light)
{
	fv u = draw(&p->random, DRAW_CHAIN) + 0x1p-25f;
	SET(m, p->chain.left, to_int(neglog(u) * s->chain_scale));
	SET(m, p->chain.length, p->chain.left);
	set3(m, &p->chain.light, light);
	return chain_direction(s, t, p, m, p->chain.left, light, p->chain.pdf);
}

/* The next walk of lanes m towards their light, from a point: a flight of a chain, or at last the shadow ray. */
FN void chain_go(const struct scene *s, const struct tables *t, struct path *p, mv m, struct ray r, fv t_end)
{
	mv flight = NO_LANE;
	if (HAS_PEAK) {         /* else walk_random is still the flight's that came here, of the same vertex */
		struct random own = chain_random(p, -p->chain.left);
		flight = ilt(IV(0), p->chain.left);
		set_random(m, &p->walk_random, p->random);
		set_random(m & flight, &p->walk_random, own);
		SET_TRUTH(m, p->chain.flying, flight);
	}
	media_begin(s, t, &p->walk, m, r, t_end, flight, NO_LANE, p->waves, &p->walk_random);
}

/* Flights of chains m have ended. */
FN void chain_arrive(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	fv flight_pdf[CARRIED], none[CARRIED];
	struct collision c = media_end(s, t, &p->walk, m, p->waves, &p->walk_random, flight_pdf);
	fv mean = take_pdf(s, p->waves, p->chain.pdf, m, flight_pdf);
	mv hit = m & c.happened & lt(FV(0.f), mean);
	if (N_VOLUMES > 1)
		hit &= ieq(c.volume, IV(0));
	p->chain.flying &= NOT(m);
	EACH_WAVE(j) {
		fv albedo = of_class(s, &s->volume[0], t->albedo, hit, c.class, p->waves, j);
		SET(m, p->nee[j], SEL(hit, p->nee[j] * albedo * media_kept(s, &p->walk, j), FV(0.f)));
		none[j] = FV(0.f);     /* pdfs of the directions were taken in at the vertex */
	}
	if (!any(hit))
		return;
	SET(hit, p->chain.left, p->chain.left - 1);
	struct vec along = chain_direction(s, t, p, hit, p->chain.left, p->chain.light, none);
	struct ray r = { c.point, along, inverse3(along), c.id, IV(0) };
	iv surface;
	fv t_end = surface_distance(s, r, &surface);
	mv blocked = hit & ieq(p->chain.left, IV(0)) & NOT(ieq(surface, IV(NONE)));
	EACH_WAVE(j)
		SET(blocked, p->nee[j], FV(0.f));
	chain_go(s, t, p, hit & NOT(blocked), r, t_end);
}

/* The share of the pdf of paths m that peaks alone have, after a direction in which p is value[j]; lanes ground begin anew. */
FN void take_peak_share(const struct scene *s, const struct tables *t, struct path *p, mv m, mv hit, mv ground, const fv *value)
{
	EACH_WAVE(j) {
		fv high = fv_max(FV(0.f), value[j] - of_wave(s, t->truncation, 0, m, p->waves, j));
		SET(m, p->peak_share[j], SEL(ground, FV(1.f), SEL(hit & lt(FV(0.f), high), p->peak_share[j] * high / value[j], FV(0.f))));
	}
}

#endif

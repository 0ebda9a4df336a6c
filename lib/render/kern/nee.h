/* nee - next-event estimation: at each vertex one light is drawn, and a shadow ray sent to it. */
#ifndef KERN_NEE_H
#define KERN_NEE_H

#include "render/kern/forward_peak.h"

#define ISOTROPIC 0.0795774715f    /* sr^-1 */

/* What wavelengths scatter from the path's direction into another one at their vertices, lanes m, sr^-1: a phase function, or on the
 * ground a cosine on the side that the path comes from. */
FN void vertex_value(const struct scene *s, const struct tables *t, const struct path *p, mv m, struct vec along,
                     fv *value)
{
	mv ground = ON_GROUND(p->vertex);
	if (IS_ISOTROPIC)
		EACH_WAVE(j)
			value[j] = FV(ISOTROPIC);
	else
		vertex_phase(s, t, m & NOT(ground), &p->vertex, angle_between(p->ray.along, along), p->waves, value);
	if (HAS_GROUND) {
		fv cosine = fv_max(FV(0.f), SEL(lt(p->ray.along.y, FV(0.f)), along.y, -along.y));
		EACH_WAVE(j)
			SET(ground, value[j], cosine / PI);
	}
}

/* A walk to a distant light is long: where less is scattered than evenly (largest: of all wavelengths), lanes distant of m make it as
 * seldom, and what it brings counts the more. Returns those of shines that go on. */
FN mv nee_roulette(const struct scene *s, struct path *p, mv m, mv shines, mv distant, fv largest)
{
	fv q = SEL(distant, fv_min(FV(1.f), largest * (1.f / ISOTROPIC)), FV(1.f));
	shines &= lt(draw(&p->random, DRAW_SHADOWED), q);
	EACH_WAVE(j)
		SET(m, p->nee[j], SEL(shines, p->nee[j] * (1.f / fv_max(q, FV(1e-20f))), FV(0.f)));
	return shines;
}

/* What the lights drawn add through a clear medium, of lanes m whose vertices scatter value[] that way: nee[]. chained lanes go there by
 * chains of scatterings by the peak, of length 0 where straight. Returns the largest of all wavelengths, as a
 * phase function's value, sr^-1. */
FN fv nee_weigh(const struct scene *s, const struct tables *t, struct path *p, mv m, const struct light_sample *d,
                const fv *value, mv chained, mv straight)
{
	fv direction_pdf = FV(0.f), k = 1.f / d->pick, alone = k, largest = FV(0.f);    /* alone: met by no path */
	EACH_WAVE(j)
		direction_pdf += value[j] * PATH_PDF(p, j);
	if (CARRIED > 1)
		direction_pdf /= to_float(p->waves.n);
	mv extended = m & lt(FV(0.f), d->pdf);
	if (any(extended)) {
		SET(extended, k, 1.f / (d->pdf + direction_pdf));
		SET(extended, alone, 1.f / d->pdf);
	}
	EACH_WAVE(j) {
		fv nee = value[j] * k, pdf = PATH_PDF(p, j);
		if (HAS_PEAK) {
			fv low = fv_min(value[j], of_wave(s, t->truncation, 0, m, p->waves, j));
			fv high = SEL(straight, (value[j] - low) * p->peak_share[j] * k, FV(0.f));
			nee = SEL(chained, (low * alone + high) * (1.f / (1.f - s->peak)), nee);
			pdf = p->chain.pdf[j];
		}
		PUT(m, p->nee[j], SEL(d->shines, nee, FV(0.f)));
		largest = fv_max(largest, nee * pdf / alone);
	}
	return largest;
}

/* Draw lights at vertices m, and set out to them. */
FN void nee_begin(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	struct light_sample d;
	light_choose(s, t, m, p->vertex.point, &p->random, &d);
	mv ground = ON_GROUND(p->vertex), chained = HAS_PEAK ? d.shines & d.spiky & NOT(ground) : NO_LANE, straight = ALL_LANES;
	struct ray r = { p->vertex.point, d.along, d.inverse, p->vertex.id, p->vertex.volume };
	fv value[CARRIED];
	if (HAS_PEAK) {
		SET(m, p->chain.left, IV(0));
		SET(m, p->chain.length, IV(0));
		EACH_WAVE(j)
			SET(m, p->chain.pdf[j], PATH_PDF(p, j));
	}
	if (any(chained)) {
		r.along = chain_begin(s, t, p, chained, d.along);
		r.inverse = inverse3(r.along);
		straight = ieq(p->chain.left, IV(0));
	}
	vertex_value(s, t, p, d.shines, r.along, value);
	if (HAS_GROUND)            /* on the side that the path comes from */
		d.shines &= NOT(ground) | lt(FV(0.f), value[0]);
	/* straight to the light, unless by a chain */
	iv surface;
	fv t_end = surface_distance(s, r, &surface);
	d.shines &= NOT(straight) | NOT(light_blocked(&d, surface, t_end));
	fv largest = nee_weigh(s, t, p, m, &d, value, chained, straight);
	for (int i = 0; i < CHANNELS; i++)
		PUT(m, p->nee_rgb[i], d.rgb[i]);
	if (LANES_WAIT)
		d.shines = nee_roulette(s, p, m, d.shines, d.distant & NOT(ground), largest);
	chain_go(s, t, p, d.shines, r, SEL(straight, d.t_end, t_end));
}

/* Shadow rays of lanes m have ended: take in what came through. By a chain it was scattered more often. */
FN void nee_end(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	fv through[CARRIED];
	media_transmittance(s, t, &p->walk, m, p->waves, through);
	EACH_WAVE(j) {
		fv nee = p->nee[j] * (HAS_PEAK ? CARRIED > 1 ? p->chain.pdf[j] : FV(1.f) : PATH_PDF(p, j));
		mv lighted = m & lt(FV(0.f), nee), straight = HAS_PEAK ? lighted & ieq(p->chain.length, IV(0)) : lighted;
		add_radiance(s, t, p, straight, j, nee * through[j], p->nee_rgb, p->rgb);
		if (!HAS_PEAK || !any(lighted & NOT(straight)))
			continue;
		mv once = ieq(p->order + p->chain.length, IV(1));
		add_radiance(s, t, p, lighted & NOT(straight) & once, j, nee * through[j], p->nee_rgb, p->aside[0]);
		add_radiance(s, t, p, lighted & NOT(straight | once), j, nee * through[j], p->nee_rgb, p->aside[1]);
	}
}

#endif

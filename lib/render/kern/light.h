/* light - lights drawn and met.
 *
 * A light is found in two ways: drawn at a vertex (next-event estimation) and met by a path that goes on. Each is weighed by its
 * pdf of directions alone, sr^-1: that of drawing this light and this direction, against that of the path, the mean over its
 * heroes. The transmittance stays out of the weights: it may be random in a flight and known on a shadow ray, and weights that
 * contained it would then not sum to one. */
#ifndef KERN_LIGHT_H
#define KERN_LIGHT_H

#include "render/kern/envmap.h"
#include "render/kern/surface.h"
#include "render/kern/traversal.h"

struct light_sample {
	struct vec along, inverse;
	fv t_end;                  /* where it shines from */
	iv surface;                /* that it is, or NONE */
	fv pick;                   /* probability of drawing this light */
	fv pdf;                    /* of drawing it and this direction, sr^-1; 0: delta light */
	fv rgb[3];                 /* radiance; of delta light irradiance */
	mv shines, distant, spiky; /* as in struct light */
};

/* Pdf of drawing the direction along, which meets the quad of a light at distance t, sr^-1; 0 behind it. */
FN fv quad_pdf(const struct scene *s, const struct light *l, struct vec along, fv t)
{
	fv c = -dot3(load3(s->surfaces.surface[l->surface].normal), along);
	return SEL(lt(FV(0.f), c), t * (t * l->pdf) / c, FV(0.f));
}

/* Light i seen from the points of lanes m. */
FN void light_draw(const struct scene *s, const struct tables *t, mv m, int i, struct vec point, const struct random *random,
                   struct light_sample *d)
{
	const struct light *l = &s->lights.light[i];
	*d = (struct light_sample){ load3(l->at), load3(l->inverse), FV(FAR), IV(NONE), FV(l->pick), FV(l->pdf),
		{ FV(l->rgb[0]), FV(l->rgb[1]), FV(l->rgb[2]) }, m, l->distant ? m : NO_LANE, l->spiky ? m : NO_LANE };
	if (l->delta)
		return;
	if (l->kind == LIGHT_QUAD) {
		const struct surface *q = &s->surfaces.surface[l->surface];
		fv x = draw(random, DRAW_LIGHT_1), y = draw(random, DRAW_LIGHT_2);
		struct vec to = sub(add(load3(q->corner), add(scale(load3(q->edge[0]), x), scale(load3(q->edge[1]), y))), point);
		fv t2 = dot3(to, to);
		d->t_end = fv_sqrt(t2);
		d->along = scale(to, 1.f / d->t_end);
		d->surface = IV(l->surface);
		d->pdf = quad_pdf(s, l, d->along, d->t_end);
		d->shines &= lt(FV(1e-30f), t2) & lt(FV(0.f), d->pdf);
	} else if (l->kind == LIGHT_MAP) {
		iv row, column;
		d->along = envmap_draw(&s->lights, t, m, draw_bits(random, DRAW_LIGHT_1), draw_bits(random, DRAW_LIGHT_2), &row, &column);
		d->pdf = envmap_pdf(&s->lights, t, m, row, column);
		envmap_value(&s->lights, t, m, row, column, d->rgb);
	} else {                   /* uniform over the disc, in 1 - cos */
		fv c = l->one_minus_cos * draw(random, DRAW_LIGHT_1);
		d->along = to_world(d->along, fv_sqrt(c * (2.f - c)), 1.f - c, 2.f * PI * draw(random, DRAW_LIGHT_2));
	}
	d->inverse = inverse3(d->along);
}

/* One of the lights, each by its pick. */
FN void light_choose(const struct scene *s, const struct tables *t, mv m, struct vec point, const struct random *random,
                     struct light_sample *d)
{
	mv own = m;
	iv which = IV(0);
	if (s->lights.n > 1) {
		fv u = draw(random, DRAW_LIGHT);
		for (int i = 0; i < s->lights.n - 1; i++)
			which += SEL(le(FV(s->lights.light[i].until), u), IV(1), IV(0));
		own &= ieq(which, IV(0));
	}
	light_draw(s, t, own, 0, point, random, d);
	for (int i = 1; i < s->lights.n; i++) {
		own = m & ieq(which, IV(i));
		if (!any(own))
			continue;
		struct light_sample other;
		light_draw(s, t, own, i, point, random, &other);
		set3(own, &d->along, other.along);
		set3(own, &d->inverse, other.inverse);
		SET(own, d->t_end, other.t_end);
		SET(own, d->surface, other.surface);
		SET(own, d->pick, other.pick);
		SET(own, d->pdf, other.pdf);
		EACH(k, 3)
			SET(own, d->rgb[k], other.rgb[k]);
		d->shines |= other.shines;
		d->distant |= other.distant;
		d->spiky |= other.spiky;
	}
}

/* Where a surface at distance t stands before what was drawn. What lies on the light itself, as another quad at a common edge, does
 * not: hence the margin. */
FN mv light_blocked(const struct light_sample *d, iv surface, fv t)
{
	return NOT(ieq(surface, IV(NONE))) & NOT(ieq(surface, d->surface)) & lt(t, d->t_end * TIE);
}

/* The weight of a light met by a path of that pdf of directions (0: from the camera, where none is drawn): the balance heuristic. */
FN fv mis_weight(fv path_pdf, fv light_pdf)
{
	return SEL(lt(FV(0.f), path_pdf), path_pdf / (path_pdf + light_pdf), FV(1.f));
}

/* Radiance of surface i met at distance t, weighed. */
FN void surface_radiance(const struct scene *s, int i, struct ray r, fv t, fv path_pdf, fv *rgb)
{
	int light = s->surfaces.surface[i].light;
	EACH(c, 3)
		rgb[c] = FV(0.f);
	if (light == NONE)
		return;
	fv pdf = quad_pdf(s, &s->lights.light[light], r.along, t), k = SEL(lt(FV(0.f), pdf), mis_weight(path_pdf, pdf), FV(0.f));
	EACH(c, 3)
		rgb[c] = s->lights.light[light].rgb[c] * k;
}

/* Radiance of what lies behind everything, weighed: the environment, the map, suns with a disc; spiky ones apart. */
FN void sky_radiance(const struct scene *s, const struct tables *t, mv m, struct vec along, fv path_pdf, fv *rgb, fv *spikes)
{
	EACH(c, 3) {
		rgb[c] = FV(s->lights.environment[c]);
		spikes[c] = FV(0.f);
	}
	for (int i = 0; i < s->lights.n; i++) {
		const struct light *l = &s->lights.light[i];
		struct vec off = sub(along, load3(l->at));
		fv own[3] = { FV(l->rgb[0]), FV(l->rgb[1]), FV(l->rgb[2]) }, k;
		if (l->delta || l->kind == LIGHT_QUAD)
			continue;
		if (l->kind == LIGHT_MAP) {
			iv row, column;
			envmap_locate(&s->lights, along, &row, &column);
			envmap_value(&s->lights, t, m, row, column, own);
			k = mis_weight(path_pdf, envmap_pdf(&s->lights, t, m, row, column));
		} else {
			k = SEL(le(dot3(off, off), FV(2.f * l->one_minus_cos)), mis_weight(path_pdf, FV(l->pdf)), FV(0.f));
		}
		EACH(c, 3)
			if (l->spiky)
				spikes[c] += own[c] * k;
			else
				rgb[c] += own[c] * k;
	}
}

#endif

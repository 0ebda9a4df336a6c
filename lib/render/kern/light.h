/* light - surfaces that end a ray, and lights drawn and met.
 *
 * A light is found in two ways: drawn at a vertex (next-event estimation) and met by a path that goes on. Each is weighed by its
 * density of directions alone, sr^-1: that of drawing this light and this direction, against that of the path, the mean over its
 * heroes. The transmittance stays out of the weights: it may be random in a flight and known on a shadow ray, and weights that
 * contained it would then not sum to one. */
#ifndef KERN_LIGHT_H
#define KERN_LIGHT_H

#include "render/kern/volume.h"

#define GROUND (-2)

/* ------------------------------------------------------------------ quads and the ground */

/* Distance along a ray to a quad, FAR if it passes by. */
FN fv quad_distance(const struct light *q, struct ray r)
{
	struct vec n = load3(q->normal), from = sub(r.from, load3(q->at));
	fv t = -dot3(n, from) * inverse(dot3(n, r.along));
	struct vec at = add(from, scale(r.along, t));
	fv u = dot3(load3(q->dual[0]), at), v = dot3(load3(q->dual[1]), at);
	mv met = lt(FV(0.f), t) & lt(t, FV(FAR)) & le(FV(0.f), u) & le(u, FV(1.f)) & le(FV(0.f), v) & le(v, FV(1.f));
	return SEL(met, t, FV(FAR));
}

#define TIE 0.999998f    /* distances nearer to each other than this ratio are one: a few steps of a float */

/* Distance to the first surface, and which it is: the index of a quad, GROUND, or NONE at FAR. A quad that lies on the ground is
 * before it. */
FN fv surface_distance(const struct scene *s, struct ray r, iv *which)
{
	fv t = FV(FAR);
	*which = IV(NONE);
	if (HAS_GROUND) {
		t = (s->ground_height - r.from.y) * inverse(r.along.y);
		mv met = lt(FV(0.f), t) & lt(t, FV(FAR));
		*which = SEL(met, IV(GROUND), *which);
		t = SEL(met, t, FV(FAR));
	}
	for (int i = 0; i < s->n_lights; i++) {
		if (s->light[i].kind != LIGHT_QUAD)
			continue;
		fv own = quad_distance(&s->light[i], r);
		mv met = lt(own, t) | (ieq(*which, IV(GROUND)) & lt(own * TIE, t));
		SET(met, t, own);
		SET(met, *which, IV(i));
	}
	return t;
}

/* Density of drawing the direction along, which meets a quad at distance t, sr^-1; 0 behind it. */
FN fv quad_pdf(const struct scene *s, const struct light *q, struct vec along, fv t)
{
	fv c = -dot3(load3(q->normal), along);
	return SEL(lt(FV(0.f), c), t * (t * (q->density * s->pick)) / c, FV(0.f));
}

/* ------------------------------------------------------------------ the map: latitude and longitude, constant over a texel */

/* Solid angle of a texel: by the polar angle of its middle, from the nearer pole, where the sine is relative. */
FN fv texel_angle(const struct scene *s, iv row)
{
	fv sn, cs;
	fv_sincos((to_float(iv_min(row, s->map_height - 1 - row)) + 0.5f) * (PI / (float)s->map_height), &sn, &cs);
	return sn * s->map_angle;
}

/* Width of an interval of a CDF in units of 2^-31. */
FN fv cdf_width(INTS cdf, mv m, iv i)
{
	return to_float(signed_of(unsigned_of(igather(m, cdf, i + 1)) - unsigned_of(igather(m, cdf, i))));
}

/* Density of drawing a direction in a texel, sr^-1. */
FN fv envmap_pdf(const struct scene *s, const struct tables *t, mv m, iv row, iv column)
{
	iv columns = s->map_height + 1 + row * (s->map_width + 1);
	fv share = cdf_width(t->map_cdf, m, row) * 0x1p-31f * (cdf_width(t->map_cdf, m, columns + column) * 0x1p-31f);
	return share * s->pick / texel_angle(s, row);
}

/* The texel in a direction: top row +y, centre column -z, columns turn towards +x. */
FN void envmap_locate(const struct scene *s, struct vec d, iv *row, iv *column)
{
	fv polar = fv_atan2(fv_sqrt(d.x * d.x + d.z * d.z), d.y) / PI, azimuth = 0.5f + fv_atan2(d.x, -d.z) / (2.f * PI);
	*row = to_int(fv_min(polar * (float)s->map_height, FV((float)s->map_height - 1.f)));
	*column = to_int(fv_max(FV(0.f), fv_min(azimuth * (float)s->map_width, FV((float)s->map_width - 1.f))));
}

FN void envmap_value(const struct scene *s, const struct tables *t, mv m, iv row, iv column, fv *rgb)
{
	EACH(c, 3)
		rgb[c] = gather(m, t->map, 3 * (row * s->map_width + column) + c);
}

/* The interval of cdf[n + 1], which begins at index from, in units of 2^-31, that u of 32 bits falls into, and the place in it, in
 * (0, 1]. Compared less 1, so that 2^31 is a signed number. */
FN iv cdf_draw(INTS cdf, mv m, iv from, int n, uv u, fv *place)
{
	iv low = IV(0), high = IV(n), target = signed_of(u >> 1);
	for (mv on = m & ilt(low + 1, high); any(on); on &= ilt(low + 1, high)) {
		iv middle = signed_of(unsigned_of(low + high) >> 1);
		mv below = ilt(signed_of(unsigned_of(igather(on, cdf, from + middle)) - 1u), target);
		SET(on & below, low, middle);
		SET(on & NOT(below), high, middle);
	}
	iv begin = igather(m, cdf, from + low);
	fv width = cdf_width(cdf, m, from + low);
	*place = fv_min(FV(1.f), (to_float(signed_of(unsigned_of(target) - unsigned_of(begin))) + 0.5f) / fv_max(width, FV(1.f)));
	return low;
}

/* A direction of the map by its luminance: texel by texel exactly as tabulated, uniform in solid angle over one. */
FN struct vec envmap_draw(const struct scene *s, const struct tables *t, mv m, uv u, uv v, iv *row, iv *column)
{
	fv down, across, sn, cs, step = FV(PI / (float)s->map_height);
	*row = cdf_draw(t->map_cdf, m, IV(0), s->map_height, u, &down);
	*column = cdf_draw(t->map_cdf, m, s->map_height + 1 + *row * (s->map_width + 1), s->map_width, v, &across);
	/* sin^2(theta / 2), linear in solid angle, from the nearer pole, where it resolves the smallest texel */
	mv north = ilt(*row, IV(s->map_height / 2));
	fv from = to_float(SEL(north, *row, s->map_height - 1 - *row));
	fv_sincos(0.5f * from * step, &sn, &cs);
	fv h0 = sn * sn;
	fv_sincos(0.5f * (from + 1.f) * step, &sn, &cs);
	fv h = h0 + (sn * sn - h0) * SEL(north, down, 1.f - down);
	fv y = 1.f - 2.f * h, out = 2.f * fv_sqrt(h * (1.f - h));
	fv_sincos(2.f * PI * fv_min(FV(1.f), (to_float(*column) + across) / (float)s->map_width), &sn, &cs);
	return vec3(-out * sn, SEL(north, y, -y), out * cs);    /* the left edge is +z, a quarter turn from there -x */
}

/* ------------------------------------------------------------------ drawing one, meeting one */

struct light_sample {
	struct vec along, inverse;
	fv t_end;                  /* where it shines from */
	iv which;                  /* the surface that it is, or NONE */
	fv density;                /* of drawing this light and this direction, sr^-1; 0: parallel light, that is never met */
	fv rgb[3];                 /* radiance; of parallel light irradiance */
	mv shines, sun, small;
};

/* Light i seen from the points of lanes m. */
FN void light_draw(const struct scene *s, const struct tables *t, mv m, int i, struct vec point, const struct random *random,
                   struct light_sample *d)
{
	const struct light *l = &s->light[i];
	*d = (struct light_sample){ load3(l->at), load3(l->inverse), FV(FAR), IV(NONE), FV(l->density * s->pick),
		{ FV(l->rgb[0]), FV(l->rgb[1]), FV(l->rgb[2]) }, m, l->kind == LIGHT_SUN ? m : NO_LANE, l->small ? m : NO_LANE };
	if (l->kind == LIGHT_SUN && l->cap == 0.f)
		return;
	if (l->kind == LIGHT_QUAD) {
		fv x = draw(random, DRAW_LIGHT_1), y = draw(random, DRAW_LIGHT_2);
		struct vec to = sub(add(d->along, add(scale(load3(l->edge[0]), x), scale(load3(l->edge[1]), y))), point);
		fv t2 = dot3(to, to);
		d->t_end = fv_sqrt(t2);
		d->along = scale(to, 1.f / d->t_end);
		d->which = IV(i);
		d->density = quad_pdf(s, l, d->along, d->t_end);
		d->shines &= lt(FV(1e-30f), t2) & lt(FV(0.f), d->density);
	} else if (l->kind == LIGHT_MAP) {
		iv row, column;
		d->along = envmap_draw(s, t, m, draw_bits(random, DRAW_LIGHT_1), draw_bits(random, DRAW_LIGHT_2), &row, &column);
		d->density = envmap_pdf(s, t, m, row, column);
		envmap_value(s, t, m, row, column, d->rgb);
	} else {                   /* uniform over the disc, in 1 - cos */
		fv c = l->cap * draw(random, DRAW_LIGHT_1);
		d->along = to_world(d->along, fv_sqrt(c * (2.f - c)), 1.f - c, 2.f * PI * draw(random, DRAW_LIGHT_2));
	}
	d->inverse = inverse3(d->along);
}

/* One of the lights that are drawn, all equally likely. */
FN void light_choose(const struct scene *s, const struct tables *t, mv m, struct vec point, const struct random *random, struct light_sample *d)
{
	mv own = m;
	iv which = IV(0);
	if (s->n_drawn > 1) {
		which = to_int(draw(random, DRAW_LIGHT) * (float)s->n_drawn);
		own &= ieq(which, IV(0));
	}
	light_draw(s, t, own, 0, point, random, d);
	for (int i = 1; i < s->n_drawn; i++) {
		own = m & ieq(which, IV(i));
		if (!any(own))
			continue;
		struct light_sample other;
		light_draw(s, t, own, i, point, random, &other);
		set3(own, &d->along, other.along);
		set3(own, &d->inverse, other.inverse);
		SET(own, d->t_end, other.t_end);
		SET(own, d->which, other.which);
		SET(own, d->density, other.density);
		EACH(k, 3)
			SET(own, d->rgb[k], other.rgb[k]);
		d->shines |= other.shines;
		d->sun |= other.sun;
		d->small |= other.small;
	}
}

/* Where a surface at distance t stands before what was drawn. What lies on the light itself, as another quad at a common edge, does
 * not: hence the margin. */
FN mv light_blocked(const struct light_sample *d, iv surface, fv t)
{
	return NOT(ieq(surface, IV(NONE))) & NOT(ieq(surface, d->which)) & lt(t, d->t_end * TIE);
}

/* The weight of a light met by a path whose direction has the density chance (0: from the camera, where none is drawn). */
FN fv mis_weight(fv chance, fv density) { return SEL(lt(FV(0.f), chance), chance / (chance + density), FV(1.f)); }

/* Radiance of quad i met at distance t. */
FN void quad_radiance(const struct scene *s, int i, struct ray r, fv t, fv chance, fv *rgb)
{
	fv density = quad_pdf(s, &s->light[i], r.along, t), k = SEL(lt(FV(0.f), density), mis_weight(chance, density), FV(0.f));
	EACH(c, 3)
		rgb[c] = s->light[i].rgb[c] * k;
}

/* Radiance of what lies behind everything: the environment, the map, suns with a disc; small ones apart. */
FN void sky_radiance(const struct scene *s, const struct tables *t, mv m, struct vec along, fv chance, fv *rgb, fv *suns)
{
	EACH(c, 3) {
		rgb[c] = FV(s->environment[c]);
		suns[c] = FV(0.f);
	}
	for (int i = 0; i < s->n_drawn; i++) {
		const struct light *l = &s->light[i];
		struct vec off = sub(along, load3(l->at));
		fv own[3] = { FV(l->rgb[0]), FV(l->rgb[1]), FV(l->rgb[2]) }, k;
		if (l->kind == LIGHT_MAP) {
			iv row, column;
			envmap_locate(s, along, &row, &column);
			envmap_value(s, t, m, row, column, own);
			k = mis_weight(chance, envmap_pdf(s, t, m, row, column));
		} else if (l->kind == LIGHT_SUN && l->cap > 0.f) {
			k = SEL(le(dot3(off, off), FV(2.f * l->cap)), mis_weight(chance, FV(l->density * s->pick)), FV(0.f));
		} else {
			continue;
		}
		EACH(c, 3)
			if (l->small)
				suns[c] += own[c] * k;
			else
				rgb[c] += own[c] * k;
	}
}

#endif

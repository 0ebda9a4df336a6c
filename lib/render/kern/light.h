/* light - surfaces that end a ray, and lights drawn and met.
 *
 * A light is found in two ways: drawn at a vertex (next-event estimation) and met by a path that goes on. Each is weighed by its
 * density of directions alone, sr^-1: that of drawing this light and this direction, against that of the path, the mean over its
 * heroes. The transmittance stays out of the weights: it may be random in a flight and known on a shadow ray, and weights that
 * contained it would then not sum to one. */
#ifndef KERN_LIGHT_H
#define KERN_LIGHT_H

#include "render/kern/medium.h"

#define GROUND (-2)

/* ------------------------------------------------------------------ quads and the ground */

/* Distance along a ray to a quad, FAR if it passes by. */
FN float quad_distance(const struct light *q, struct ray r)
{
	struct vec n = load3(q->normal), from = sub(r.from, load3(q->at));
	float t = -dot3(n, from) * inverse(dot3(n, r.along));
	if (!(t > 0.f && t < FAR))
		return FAR;
	struct vec at = add(from, scale(r.along, t));
	float u = dot3(load3(q->dual[0]), at), v = dot3(load3(q->dual[1]), at);
	return u >= 0.f && u <= 1.f && v >= 0.f && v <= 1.f ? t : FAR;
}

#define TIE 0.999998f    /* distances nearer to each other than this ratio are one: a few steps of a float */

/* Distance to the first surface, and which it is: the index of a quad, GROUND, or NONE at FAR. A quad that lies on the ground is
 * before it. */
FN float surface_distance(const struct scene *s, struct ray r, int *which)
{
	float t = s->has_ground ? (s->ground_height - r.from.y) * inverse(r.along.y) : FAR;
	*which = t > 0.f && t < FAR ? GROUND : NONE;
	t = *which == GROUND ? t : FAR;
	for (int i = 0; i < s->n_lights; i++) {
		if (s->light[i].kind != LIGHT_QUAD)
			continue;
		float own = quad_distance(&s->light[i], r);
		if (own < t || (*which == GROUND && own * TIE < t)) {
			t = own;
			*which = i;
		}
	}
	return t;
}

/* Density of drawing the direction along, which meets a quad at distance t, sr^-1; 0 behind it. */
FN float quad_density(const struct scene *s, const struct light *q, struct vec along, float t)
{
	float c = -dot3(load3(q->normal), along);
	return c > 0.f ? t * (t * (q->density * s->pick)) / c : 0.f;
}

/* ------------------------------------------------------------------ the map: latitude and longitude, constant over a texel */

/* Solid angle of a texel: by the polar angle of its middle, from the nearer pole, where the sine is relative. */
FN float texel_angle(const struct scene *s, int row)
{
	float sn, cs, from = (float)(row < s->map_height / 2 ? row : s->map_height - 1 - row);
	sincos_of((from + 0.5f) * (PI / (float)s->map_height), &sn, &cs);
	return sn * s->map_angle;
}

/* Density of drawing a direction in a texel, sr^-1. */
FN float map_density(const struct scene *s, const struct tables *tab, int row, int column)
{
	GLOBAL const uint32 *rows = tab->map_cdf + row, *columns = tab->map_cdf + s->map_height + 1 + (long)row * (s->map_width + 1) + column;
	return (float)(rows[1] - rows[0]) * 0x1p-31f * ((float)(columns[1] - columns[0]) * 0x1p-31f) * s->pick / texel_angle(s, row);
}

/* The texel in a direction: top row +y, centre column -z, columns turn towards +x. */
FN void map_locate(const struct scene *s, struct vec d, int *row, int *column)
{
	float polar = turn_of(root(d.x * d.x + d.z * d.z), d.y) / PI, azimuth = 0.5f + turn_of(d.x, -d.z) / (2.f * PI);
	*row = (int)least(polar * (float)s->map_height, (float)s->map_height - 1.f);
	*column = (int)most(0.f, least(azimuth * (float)s->map_width, (float)s->map_width - 1.f));
}

FN void map_value(const struct scene *s, const struct tables *tab, int row, int column, float *rgb)
{
	GLOBAL const float *texel = tab->map + 3 * ((long)row * s->map_width + column);
	for (int i = 0; i < 3; i++)
		rgb[i] = texel[i];
}

/* The interval of cdf[n + 1], in units of 2^-31, that u of 32 bits falls into, and the place in it, in (0, 1]. */
FN int cdf_draw(GLOBAL const uint32 *cdf, int n, uint32 u, float *place)
{
	int low = 0, high = n;
	u >>= 1;
	while (high - low > 1) {
		int middle = (int)(((uint32)low + (uint32)high) / 2);
		if (cdf[middle] <= u)
			low = middle;
		else
			high = middle;
	}
	*place = least(1.f, ((float)(u - cdf[low]) + 0.5f) / (float)(cdf[low + 1] - cdf[low]));
	return low;
}

/* A direction of the map by its luminance: texel by texel exactly as tabulated, uniform in solid angle over one. */
FN struct vec map_draw(const struct scene *s, const struct tables *tab, uint32 u, uint32 v, int *row, int *column)
{
	float down, across, sn, cs, step = PI / (float)s->map_height;
	*row = cdf_draw(tab->map_cdf, s->map_height, u, &down);
	*column = cdf_draw(tab->map_cdf + s->map_height + 1 + (long)*row * (s->map_width + 1), s->map_width, v, &across);
	/* sin^2(theta / 2), linear in solid angle, from the nearer pole, where it resolves the smallest texel */
	int south = *row >= s->map_height / 2, from = south ? s->map_height - 1 - *row : *row;
	sincos_of(0.5f * (float)from * step, &sn, &cs);
	float h0 = sn * sn;
	sincos_of(0.5f * (float)(from + 1) * step, &sn, &cs);
	float h = h0 + (sn * sn - h0) * (south ? 1.f - down : down);
	float y = 1.f - 2.f * h, out = 2.f * root(h * (1.f - h));
	sincos_of(2.f * PI * least(1.f, ((float)*column + across) / (float)s->map_width), &sn, &cs);
	return vec3(-out * sn, south ? -y : y, out * cs);    /* the left edge is +z, a quarter turn from there -x */
}

/* ------------------------------------------------------------------ drawing one, meeting one */

struct drawn {
	struct vec along;
	float t_end;               /* where it shines from */
	int which;                 /* the surface that it is, or NONE */
	float density;             /* of drawing this light and this direction, sr^-1; 0: parallel light, that is never met */
	float rgb[3];              /* radiance; of parallel light irradiance */
};

/* Light i seen from a point; false where it does not shine. */
FN int light_draw(const struct scene *s, const struct tables *tab, int i, struct vec point, uint32 u, uint32 v, struct drawn *out)
{
	const struct light *l = &s->light[i];
	float x = (float)(u >> 8) * 0x1p-24f, y = (float)(v >> 8) * 0x1p-24f;
	for (int k = 0; k < 3; k++)
		out->rgb[k] = l->rgb[k];
	out->which = NONE;
	out->t_end = FAR;
	if (l->kind == LIGHT_QUAD) {
		struct vec to = add(load3(l->at), add(scale(load3(l->edge[0]), x), scale(load3(l->edge[1]), y)));
		to = sub(to, point);
		float t2 = dot3(to, to);
		if (!(t2 > 1e-30f))
			return 0;
		out->t_end = root(t2);
		out->along = scale(to, 1.f / out->t_end);
		out->which = i;
		out->density = quad_density(s, l, out->along, out->t_end);
		return out->density > 0.f;
	}
	if (l->kind == LIGHT_MAP) {
		int row, column;
		out->along = map_draw(s, tab, u, v, &row, &column);
		out->density = map_density(s, tab, row, column);
		map_value(s, tab, row, column, out->rgb);
		return 1;
	}
	out->along = load3(l->at);
	if (l->cap > 0.f) {        /* uniform over the disc, in 1 - cos */
		float c = l->cap * x;
		out->along = around(out->along, root(c * (2.f - c)), 1.f - c, 2.f * PI * y);
	}
	out->density = l->density * s->pick;
	return 1;
}

/* Whether a surface stands between a point and what was drawn from there. What lies on the light itself, as another quad at a
 * common edge, does not: hence the margin. */
FN int light_blocked(const struct scene *s, struct ray r, const struct drawn *d)
{
	int which;
	float t = surface_distance(s, r, &which);
	return which != NONE && which != d->which && t < d->t_end * TIE;
}

/* The weight of a light met by a path whose direction has the density chance (0: from the camera, where none is drawn). */
FN float met(float chance, float density) { return chance > 0.f ? chance / (chance + density) : 1.f; }

/* Radiance of a quad met at distance t. */
FN void quad_seen(const struct scene *s, int i, struct ray r, float t, float chance, float *rgb)
{
	float density = quad_density(s, &s->light[i], r.along, t), k = density > 0.f ? met(chance, density) : 0.f;
	for (int c = 0; c < 3; c++)
		rgb[c] = s->light[i].rgb[c] * k;
}

/* Radiance of what lies behind everything: the environment, the map, and suns with a disc. */
FN void sky_seen(const struct scene *s, const struct tables *tab, struct vec along, float chance, float *rgb)
{
	for (int c = 0; c < 3; c++)
		rgb[c] = s->environment[c];
	for (int i = 0; i < s->n_drawn; i++) {
		const struct light *l = &s->light[i];
		struct vec off = sub(along, load3(l->at));
		float own[3] = { l->rgb[0], l->rgb[1], l->rgb[2] }, k;
		if (l->kind == LIGHT_MAP) {
			int row, column;
			map_locate(s, along, &row, &column);
			map_value(s, tab, row, column, own);
			k = met(chance, map_density(s, tab, row, column));
		} else if (l->kind == LIGHT_SUN && l->cap > 0.f && dot3(off, off) <= 2.f * l->cap) {
			k = met(chance, l->density * s->pick);
		} else {
			continue;
		}
		for (int c = 0; c < 3; c++)
			rgb[c] += own[c] * k;
	}
}

#endif

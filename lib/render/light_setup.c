#include "render/setup_parts.h"

#include "render/kern/ray.h"

#include <math.h>
#include <string.h>

static int shines(const float *rgb) { return rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0; }

static struct light sun_light(const struct sun *sun)
{
	double towards[3], half = sun->angle * M_PI / 360, one_minus_cos = 2 * pow(sin(half / 2), 2);
	struct light l = { .kind = LIGHT_SUN, .delta = !(one_minus_cos > 0), .distant = 1, .surface = NONE };
	for (int k = 0; k < 3; k++) {
		towards[k] = -sun->direction[k];
		/* the irradiance of a disc of radiance L, perpendicular to its axis, is pi L sin^2 */
		l.rgb[k] = (float)(l.delta ? sun->irradiance[k] : sun->irradiance[k] / (M_PI * pow(sin(half), 2)));
	}
	setup_unit(towards);
	setup_floats(towards, l.at);
	struct vec inverse = inverse3(load3(l.at));
	memcpy(l.inverse, (float[]){ inverse.x, inverse.y, inverse.z }, sizeof l.inverse);
	l.one_minus_cos = (float)one_minus_cos;
	l.pdf = l.delta ? 0 : (float)(1 / (2 * M_PI * one_minus_cos));
	return l;
}

/* Returns the area, m^2. */
static double quad_surface(const struct quad *quad, const double *origin, struct surface *q)
{
	double normal[3], across[3], area = 0;
	setup_cross(quad->edge[0], quad->edge[1], normal);
	for (int k = 0; k < 3; k++)
		area += normal[k] * normal[k];
	area = sqrt(area);
	setup_unit(normal);
	for (int i = 0; i < 2; i++) {
		/* in the plane, perpendicular to the other edge; its product with its own edge is the area */
		setup_cross(i ? normal : quad->edge[1], i ? quad->edge[0] : normal, across);
		for (int k = 0; k < 3; k++)
			q->dual[i][k] = (float)(across[k] / area);
		setup_floats(quad->edge[i], q->edge[i]);
	}
	for (int k = 0; k < 3; k++)
		q->corner[k] = (float)(quad->corner[k] - origin[k]);
	setup_floats(normal, q->normal);
	q->light = NONE;
	return area;
}

/* Returns its number. */
static int add_light(struct lights *lights, struct light l)
{
	lights->light[lights->n] = l;
	return lights->n++;
}

static void map_light(struct setup *u, const struct envmap *map)
{
	struct lights *lights = &u->scene.lights;
	uint32 *cdf = NULL;
	size_t n = map->width ? envmap_cdf(map, &cdf) : 0;
	SET_TABLE(u, 0, map_cdf, setup_own(u, cdf), n);
	if (!n)
		return;
	lights->map_width = map->width;
	lights->map_height = map->height;
	lights->map_angle = (float)(4 * M_PI / map->width * sin(M_PI / 2 / map->height));
	add_light(lights, (struct light){ .kind = LIGHT_MAP, .surface = NONE });
	SET_TABLE(u, 0, map, map->rgb, 3 * (size_t)map->width * (size_t)map->height);
}

/* Quads that shine, then those that only stand in the way. */
static void quad_lights(struct setup *u, const struct scenefile *f)
{
	struct scene *s = &u->scene;
	for (int dark = 0; dark < 2; dark++)
		for (int i = 0; i < f->n_lights; i++) {
			struct light l = { .kind = LIGHT_QUAD, .surface = s->surfaces.n };
			if (f->light[i].kind != LIGHT_QUAD)
				continue;
			setup_floats(f->light[i].quad.radiance, l.rgb);
			if (shines(l.rgb) == dark)
				continue;
			struct surface *q = &s->surfaces.surface[s->surfaces.n++];
			double area = quad_surface(&f->light[i].quad, u->origin, q);
			l.pdf = (float)(1 / area);
			if (!dark)
				q->light = add_light(&s->lights, l);
		}
}

/* What a quad of that area gives where the scene is nearest to it, as light from all sides, m^2 m^-2 times its radiance: no more than from
 * a half space. */
static double quad_solid_angle(const struct scene *s, const struct surface *q, double area)
{
	double d2 = INFINITY, reach = setup_reach(s);
	for (int i = 0; i < 4; i++)
		for (int j = 0; j < 4; j++) {    /* points of it, edges included */
			double at2 = 0;
			for (int a = 0; a < 3; a++)
				at2 += pow((double)q->corner[a] + i / 3. * q->edge[0][a] + j / 3. * q->edge[1][a], 2);
			double d = fmax(0, sqrt(at2) - reach);
			if (s->surfaces.has_ground && s->surfaces.ground_albedo > 0)
				d = fmin(d, fabs((double)q->corner[1] + i / 3. * q->edge[0][1] + j / 3. * q->edge[1][1] - s->surfaces.ground_height));
			d2 = fmin(d2, d * d);
		}
	return fmin(area / fmax(d2, 1e-30), 2 * M_PI);
}

static double luminance(const float *rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

#define EVENLY 0.125    /* the share of draws that are even: what a light gives differs from place to place */

/* How often each light is drawn: by what it can contribute, the luminance of its light from all sides where the medium, or the ground, is
 * nearest to it. */
static void picks(struct scene *s, const struct envmap *map)
{
	struct lights *lights = &s->lights;
	double most[MAX_LIGHTS], all = 0, until = 0;
	for (int i = 0; i < lights->n; i++) {
		const struct light *l = &lights->light[i];
		most[i] = l->kind == LIGHT_QUAD ? luminance(l->rgb) * quad_solid_angle(s, &s->surfaces.surface[l->surface], 1 / (double)l->pdf)
		    : l->kind == LIGHT_MAP ? envmap_fluence(map) : luminance(l->rgb) * (l->delta ? 1 : 2 * M_PI * l->one_minus_cos);
		all += most[i];
	}
	for (int i = 0; i < lights->n; i++) {
		struct light *l = &lights->light[i];
		double pick = EVENLY / lights->n + (1 - EVENLY) * (all > 0 ? most[i] / all : 1. / lights->n);
		l->pick = (float)(lights->n == 1 ? 1 : pick);
		l->until = (float)(until += pick);
		l->pdf *= l->pick;
		if (l->kind == LIGHT_MAP)
			lights->map_pick = l->pick;
	}
}

void light_setup(struct setup *u, const struct scenefile *f)
{
	struct scene *s = &u->scene;
	struct lights *lights = &s->lights;
	setup_floats(f->environment, lights->environment);
	for (int i = 0; i < f->n_lights; i++)
		if (f->light[i].kind == LIGHT_SUN) {
			struct light l = sun_light(&f->light[i].sun);
			if (shines(l.rgb))
				add_light(lights, l);
		}
	map_light(u, &f->map);
	quad_lights(u, f);
	/* what is drawn of a sun is at most its pdf's height or, by chains, 1 / (1 - share) of the truncation: the lower is taken */
	float highest = 0;
	for (size_t w = 0; w < u->size[0].truncation; w++)
		highest = fmaxf(highest, u->tables[0].truncation[w] / (1 - s->peak));
	for (int i = 0; i < lights->n; i++)
		lights->light[i].spiky = lights->light[i].kind == LIGHT_SUN && (lights->light[i].delta || lights->light[i].pdf > highest);
	s->surfaces.has_ground = f->has_ground;
	s->surfaces.ground_height = (float)(f->ground_height - u->origin[1]);
	s->surfaces.ground_albedo = (float)f->ground_albedo;
	picks(s, &f->map);
}

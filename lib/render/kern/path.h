/* path - one light path from the camera: flights, scattering, next-event estimation, all its wavelengths at once.
 *
 * A path is sampled for one of its wavelengths, the hero, each equally probable. weight[j] is the throughput of wavelength j
 * (albedos, roulette), density[j] the probability density of the path had j been the hero, divided by its mean over j.
 * By the balance heuristic over heroes wavelength j then contributes weight[j] density[j] times what it sees: no wavelength is
 * favoured, and one whose own disc would not have been met has density 0 from there on. */
#ifndef KERN_PATH_H
#define KERN_PATH_H

#include "render/kern/light.h"
#include "render/kern/phase.h"
#include "render/kern/random.h"

struct path {
	struct ray ray;
	struct waves waves;
	int hero;
	float weight[MAX_WAVES], density[MAX_WAVES];
	float chance;              /* density of the ray's direction, sr^-1; 0 from the camera, where no light is drawn */
	struct random random;
	float rgb[3];              /* seen since the medium last scattered the path */
	int order;                 /* times that it did, from 2 on 2; reflections by surfaces do not count */
	float before[2][3];        /* what was seen unscattered, and scattered once, of an order that is over */
	float depth;               /* along the camera's ray to where the medium scattered it, -1 if it did not */
	float spectrum[MAX_WAVES]; /* all that was seen, by wavelength */
};

enum { DRAW_FLIGHT, DRAW_CLASS, DRAW_ANGLE, DRAW_AZIMUTH, DRAW_ROULETTE, DRAW_LIGHT, DRAW_LIGHT_1, DRAW_LIGHT_2 };
enum { DRAW_PIXEL_X, DRAW_PIXEL_Y, DRAW_HERO, DRAW_GROUP };

/* A light's colour multiplies the film's channels, so that it is seen as it is, whatever the wavelengths. */
FN void see(const struct tables *tab, struct path *p, int j, float k, const float *rgb)
{
	GLOBAL const float *c = tab->colour + 3 * wave_of(p->waves, j);
	float seen = p->weight[j] * k;
	for (int i = 0; i < 3; i++)
		p->rgb[i] += c[i] * (seen * rgb[i]);
	p->spectrum[j] += seen * rgb[1];
}

/* The medium scatters the path: what it sees from here on belongs to the next order. */
FN void scattered(struct path *p, struct vec point)
{
	if (p->chance == 0.f) {    /* the camera's ray */
		struct vec d = sub(point, p->ray.from);
		p->depth = root(dot3(d, d));
	}
	if (p->order == 2)
		return;
	for (int i = 0; i < 3; i++) {
		p->before[p->order][i] = p->rgb[i];
		p->rgb[i] = 0.f;
	}
	p->order++;
}

/* Take event[j] into the densities; returns its mean over the wavelengths, 0 if the path cannot be (it then ends). */
FN float take_event(struct path *p, const float *event)
{
	float mean = 0.f;
	for (int j = 0; j < p->waves.n; j++) {
		p->density[j] *= event[j];
		mean += p->density[j];
	}
	mean /= (float)p->waves.n;
	for (int j = 0; j < p->waves.n; j++)
		p->density[j] = mean > 0.f ? p->density[j] / mean : 0.f;
	return mean;
}

FN struct path path_begin(const struct scene *s, uint32 pixel, uint32 sample)
{
	struct path p;
	p.random = random_of(s->seed, pixel, sample);
	float x = 2.f * ((float)(pixel % (uint32)s->width) + draw(&p.random, DRAW_PIXEL_X)) / (float)s->width - 1.f;
	float y = 1.f - 2.f * ((float)(pixel / (uint32)s->width) + draw(&p.random, DRAW_PIXEL_Y)) / (float)s->height;
	p.ray.from = load3(s->eye);
	p.ray.along = unit3(add(load3(s->forward), add(scale(load3(s->right), x), scale(load3(s->up), y))));
	p.ray.skip = NONE;
	/* A fat ray covers the pixel's footprint where the ray enters the medium, and no less than any particle (eq 23). */
	float t0, t1, slant = dot3(p.ray.along, load3(s->forward));
	clip_medium(s, p.ray, &t0, &t1);
	p.ray.area = most(PI * s->largest, t0 < t1 ? s->footprint * slant * slant * slant * t0 * t0 : 0.f);
	p.waves.step = s->n_groups;
	p.waves.first = (int)(draw(&p.random, DRAW_GROUP) * (float)s->n_groups);
	p.waves.n = (s->n_waves - p.waves.first + s->n_groups - 1) / s->n_groups;
	p.hero = (int)(draw(&p.random, DRAW_HERO) * (float)p.waves.n);
	for (int j = 0; j < MAX_WAVES; j++) {
		p.weight[j] = (float)s->n_groups;
		p.density[j] = 1.f;
		p.spectrum[j] = 0.f;
	}
	p.chance = 0.f;
	p.depth = -1.f;
	p.order = 0;
	for (int i = 0; i < 3; i++)
		p.rgb[i] = p.before[0][i] = p.before[1][i] = 0.f;
	next_vertex(&p.random);
	return p;
}

/* What ends a path that did not scatter: a quad at distance t, or what lies behind everything. */
FN void see_end(const struct scene *s, const struct tables *tab, struct path *p, int surface, float t)
{
	float rgb[3];
	if (surface == NONE)
		sky_seen(s, tab, p->ray.along, p->chance, rgb);
	else
		quad_seen(s, surface, p->ray, t, p->chance, rgb);
	for (int j = 0; j < p->waves.n; j++)
		see(tab, p, j, p->density[j], rgb);
}

/* Next-event estimation at a vertex: class NONE is the ground, on the side of normal. */
FN void see_light(const struct scene *s, const struct tables *tab, struct path *p, struct vec point, int class, int id, float normal)
{
	struct drawn d;
	if (!s->n_drawn)
		return;
	int i = (int)(draw(&p->random, DRAW_LIGHT) * (float)s->n_drawn);
	if (!light_draw(s, tab, i, point, draw_bits(&p->random, DRAW_LIGHT_1), draw_bits(&p->random, DRAW_LIGHT_2), &d))
		return;
	struct ray r = { point, d.along, id, p->ray.area };
	float value[MAX_WAVES] = { 0.f }, through[MAX_WAVES], chance = 0.f;
	if (class == NONE) {
		for (int j = 0; j < p->waves.n; j++)
			value[j] = most(0.f, r.along.y * normal) / PI;
		if (!(value[0] > 0.f))
			return;
	} else {
		struct at_angle a = phase_locate(tab, class, angle_between(p->ray.along, r.along));
		for (int j = 0; j < p->waves.n; j++)
			value[j] = phase_value(tab, s->n_waves, a, wave_of(p->waves, j));
	}
	if (light_blocked(s, r, &d))
		return;
	transmittance(s, tab, r, d.t_end, p->waves, through);
	for (int j = 0; j < p->waves.n; j++) {
		value[j] *= p->density[j];
		chance += value[j];
	}
	chance /= (float)p->waves.n;
	float k = d.density > 0.f ? 1.f / (d.density + chance) : (float)s->n_drawn;
	for (int j = 0; j < p->waves.n; j++)
		see(tab, p, j, value[j] * through[j] * k, d.rgb);
}

/* Roulette on the throughput: survival is certain above 1/4, and 4 times the throughput below, never less than it. */
FN int survives(struct path *p)
{
	float throughput = 0.f;
	for (int j = 0; j < p->waves.n; j++)
		throughput = most(throughput, p->weight[j] * p->density[j]);
	float q = 4.f * throughput;
	if (!(q < 1.f))
		return 1;
	if (!(draw(&p->random, DRAW_ROULETTE) < q))
		return 0;
	for (int j = 0; j < p->waves.n; j++)
		p->weight[j] /= q;
	return 1;
}

/* One flight and what happens at its end; 0 when the path is over. */
FN int path_bounce(const struct scene *s, const struct tables *tab, struct path *p)
{
	float event[MAX_WAVES];
	int surface;
	float t_end = surface_distance(s, p->ray, &surface);
	struct collision c = free_flight(s, tab, p->ray, t_end, p->waves, p->hero, &p->random, DRAW_FLIGHT, event);
	if (!(take_event(p, event) > 0.f))
		return 0;
	if (!c.happened && surface != GROUND) {
		see_end(s, tab, p, surface, t_end);
		return 0;
	}
	struct vec point = c.point;
	int class = c.happened ? c.class : NONE;
	float normal = p->ray.along.y < 0.f ? 1.f : -1.f;
	if (class == NONE) {
		point = add(p->ray.from, scale(p->ray.along, t_end));
		point.y = s->ground_height;
	} else {
		scattered(p, point);
	}
	for (int j = 0; j < p->waves.n; j++)
		p->weight[j] *= class == NONE ? s->ground_albedo : tab->albedo[class * s->n_waves + wave_of(p->waves, j)];
	see_light(s, tab, p, point, class, c.id, normal);
	if (!survives(p))
		return 0;
	float azimuth = 2.f * PI * draw(&p->random, DRAW_AZIMUTH), theta, sn, cs;
	if (class == NONE) {       /* cosine-distributed */
		float u = draw(&p->random, DRAW_ANGLE);
		cs = root(1.f - u);
		p->ray.along = around(vec3(0.f, normal, 0.f), root(u), cs, azimuth);
		p->chance = cs / PI;
	} else {
		struct at_angle a = phase_sample(tab, s->n_waves, class, wave_of(p->waves, p->hero), draw_bits(&p->random, DRAW_ANGLE), &theta);
		for (int j = 0; j < p->waves.n; j++)
			event[j] = phase_value(tab, s->n_waves, a, wave_of(p->waves, j));
		p->chance = take_event(p, event);
		sincos_of(theta, &sn, &cs);
		p->ray.along = around(p->ray.along, sn, cs, azimuth);
	}
	p->ray.from = point;
	p->ray.skip = c.id;
	next_vertex(&p->random);
	return p->chance > 0.f;
}

#endif

/* medium - free flight and transmittance in the four models of the medium.
 *
 * A flight is sampled for one wavelength, the hero; event[j] is what its own density would be for wavelength j: the common
 * currency in which the wavelengths of a path are weighed against each other. */
#ifndef KERN_MEDIUM_H
#define KERN_MEDIUM_H

#include "render/kern/gather.h"
#include "render/kern/voxels.h"

/* Transmittance of the ray up to t_end at each wavelength. */
FN void transmittance(const struct scene *s, const struct tables *tab, struct ray r, float t_end, struct waves w, float *out)
{
	if (s->transport == TRANSPORT_EXPLICIT || s->transport == TRANSPORT_FAT_RAY) {
		struct gathered g;
		gather(s, tab, r, t_end, w, 0, GATHER_ALL, &g);
		for (int j = 0; j < w.n; j++)
			out[j] = g.through[j];
	} else if (s->transport == TRANSPORT_GRID) {
		struct passed g;
		pass_voxels(s, tab, r, t_end, w, 0, FAR, &g);
		for (int j = 0; j < w.n; j++)
			out[j] = expneg(s->counted ? g.depth[j] : tab->extinction[wave_of(w, j)] * g.depth[0]);
	} else {
		float t0, t1;
		clip_medium(s, r, &t0, &t1);
		t1 = least(t1, t_end);
		for (int j = 0; j < w.n; j++)
			out[j] = t0 < t1 ? expneg(tab->extinction[wave_of(w, j)] * (t1 - t0)) : 1.f;
	}
}

/* Where a flight ends. */
struct collision {
	int happened;              /* else it reached t_end */
	struct vec point;          /* of the collision */
	int class, id;             /* what scatters there; id NONE where it is no single particle */
};

FN struct collision flight_particles(const struct scene *s, const struct tables *tab, struct ray r, float t_end, struct waves w,
                                     int hero, const struct random *random, float *event)
{
	struct gathered g;
	struct collision c = { 0, r.from, s->n_classes, NONE };
	gather(s, tab, r, t_end, w, random, GATHER_FIRST, &g);
	c.id = g.id[hero];
	c.happened = c.id != NONE;
	c.point = add(g.entry, scale(r.along, g.depth[hero]));
	if (c.happened)
		c.class = (int)float_bits(tab->particle[4 * (long)c.id + 3]);
	for (int j = 0; j < w.n; j++)
		event[j] = g.id[j] == c.id ? 1.f : 0.f;
	return c;
}

/* Which class of a cube's particles is met: by count x c_ext of the hero. */
FN int class_in(const struct scene *s, const struct tables *tab, int voxel, int wave, float u)
{
	GLOBAL const uint32 *count = tab->count + (long)voxel * s->n_classes;
	float all = 0.f, sum = 0.f;
	int class = 0;
	for (int k = 0; k < s->n_classes; k++)
		all += (float)count[k] * tab->disc[k * s->n_waves + wave];
	for (int k = 0; k < s->n_classes; k++) {
		float own = (float)count[k] * tab->disc[k * s->n_waves + wave];
		if (own > 0.f && sum <= u * all)
			class = k;
		sum += own;
	}
	return class;
}

FN struct collision flight_voxels(const struct scene *s, const struct tables *tab, struct ray r, float t_end, struct waves w,
                                  int hero, uint32 bits, float u_class, float *event)
{
	struct passed g;
	struct collision c = { 0, r.from, s->n_classes, NONE };
	float target = free_path(bits), density = tab->extinction[wave_of(w, hero)];
	target = s->counted ? target : density > 0.f ? target / density : FAR;
	pass_voxels(s, tab, r, t_end, w, hero, target, &g);
	c.happened = g.reached;
	c.point = add(g.entry, scale(r.along, g.t));
	if (c.happened && s->counted)
		c.class = class_in(s, tab, g.voxel, wave_of(w, hero), u_class);
	for (int j = 0; j < w.n; j++) {
		int wave = wave_of(w, j);
		float own = tab->extinction[wave];
		event[j] = expneg(s->counted ? g.depth[j] : own * g.depth[0]);
		if (c.happened)
			event[j] *= s->counted ? tab->disc[c.class * s->n_waves + wave] / s->largest : own;
	}
	return c;
}

FN struct collision flight_bulk(const struct scene *s, const struct tables *tab, struct ray r, float t_end, struct waves w,
                                int hero, uint32 bits, float *event)
{
	struct collision c = { 0, r.from, s->n_classes, NONE };
	float t0, t1;
	clip_medium(s, r, &t0, &t1);
	float length = most(least(t1, t_end) - t0, 0.f), sigma = tab->extinction[wave_of(w, hero)];
	float free = free_path(bits);
	c.happened = free < sigma * length;
	if (c.happened) {
		length = free / sigma;
		c.point = add(add(r.from, scale(r.along, t0)), scale(r.along, length));
	}
	for (int j = 0; j < w.n; j++) {
		float own = tab->extinction[wave_of(w, j)];
		event[j] = expneg(own * length) * (c.happened ? own : 1.f);
	}
	return c;
}

/* A free flight of the hero wavelength up to t_end; event[j]: its density (collision) or probability (none) for wavelength j,
 * up to a common factor. Uses dimensions d and d + 1 of the random numbers. */
FN struct collision free_flight(const struct scene *s, const struct tables *tab, struct ray r, float t_end, struct waves w,
                                int hero, const struct random *random, int d, float *event)
{
	if (s->transport == TRANSPORT_EXPLICIT || s->transport == TRANSPORT_FAT_RAY)
		return flight_particles(s, tab, r, t_end, w, hero, random, event);
	if (s->transport == TRANSPORT_GRID)
		return flight_voxels(s, tab, r, t_end, w, hero, draw_bits(random, d), draw(random, d + 1), event);
	return flight_bulk(s, tab, r, t_end, w, hero, draw_bits(random, d), event);
}

#endif

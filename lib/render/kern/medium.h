/* medium - free flight and transmittance in the two models of the medium.
 *
 * A flight is sampled for one wavelength, the hero; event[j] is what its own density would be for wavelength j: the common
 * currency in which the wavelengths of a path are weighed against each other. */
#ifndef KERN_MEDIUM_H
#define KERN_MEDIUM_H

#include "render/kern/math.h"
#include "render/kern/scene.h"

#define FAR 3e38f
#define NONE (-1)

/* The wavelengths of a path: index wave_of(w, j) in the medium's list, j < n. */
struct waves {
	int n, first, step;
};

FN int wave_of(struct waves w, int j) { return w.first + w.step * j; }

struct ray {
	struct vec from, along;
	int skip;                  /* particle that it starts from, or NONE */
};

FN float inverse(float x) { return 1.f / (x < 0.f ? least(x, -1e-20f) : most(x, 1e-20f)); }

/* Where a ray is inside a box or the medium: [*t0, *t1], *t0 >= 0; nothing if *t0 >= *t1. */
FN void clip_box(struct ray r, const float *low, const float *high, float *t0, float *t1)
{
	float ix = inverse(r.along.x), iy = inverse(r.along.y), iz = inverse(r.along.z);
	float ax = (low[0] - r.from.x) * ix, bx = (high[0] - r.from.x) * ix;
	float ay = (low[1] - r.from.y) * iy, by = (high[1] - r.from.y) * iy;
	float az = (low[2] - r.from.z) * iz, bz = (high[2] - r.from.z) * iz;
	*t0 = most(most(0.f, least(ax, bx)), most(least(ay, by), least(az, bz)));
	*t1 = least(most(ax, bx), least(most(ay, by), most(az, bz)));
}

FN void clip_medium(const struct scene *s, struct ray r, float *t0, float *t1)
{
	if (!s->round) {
		float low[3] = { -s->extent[0], -s->extent[1], -s->extent[2] };
		clip_box(r, low, s->extent, t0, t1);
		return;
	}
	/* The nearest point of the ray to the centre first: the half chord then has no cancellation. */
	float middle = -dot3(r.from, r.along);
	struct vec nearest = add(r.from, scale(r.along, middle));
	float h2 = s->extent[0] * s->extent[0] - dot3(nearest, nearest);
	float h = root(most(h2, 0.f));
	*t0 = most(0.f, middle - h);
	*t1 = h2 > 0.f ? middle + h : 0.f;
}

/* ------------------------------------------------------------------ explicit: every particle is a disc of area c_ext */

/* The first particle before t_end that each wavelength meets: its index or NONE in id[j], its depth in t[j], counted from the
 * point *entry where the ray comes into the grid (from afar, floats would be too coarse for the discs).
 * A particle is met where the point of the ray closest to its centre lies ahead and nearer than the disc's radius. */
FN void first_particles(const struct scene *s, const struct tables *tab, struct ray r, float t_end, struct waves w,
                        float *t, int *id, struct vec *entry)
{
	float t0, t1;
	clip_box(r, s->grid_low, s->grid_high, &t0, &t1);
	t1 = least(t1, t_end) - t0;
	struct vec p = add(r.from, scale(r.along, t0));
	for (int j = 0; j < w.n; j++) {
		t[j] = t1;
		id[j] = NONE;
	}
	*entry = p;
	if (!(t1 > 0.f))
		return;
	const float at[3] = { p.x, p.y, p.z };
	const float inv[3] = { inverse(r.along.x), inverse(r.along.y), inverse(r.along.z) };
	int i[3], wall[3];
	float leave[3];            /* where the ray leaves the cell along each axis */
	for (int a = 0; a < 3; a++) {
		i[a] = (int)most(0.f, least((at[a] - s->grid_low[a]) / s->cell[a], (float)(s->cells[a] - 1)));
		wall[a] = i[a] + (inv[a] > 0.f);
		leave[a] = (s->grid_low[a] + (float)wall[a] * s->cell[a] - at[a]) * inv[a];
	}
	for (;;) {
		int axis = leave[0] < leave[1] ? (leave[0] < leave[2] ? 0 : 2) : (leave[1] < leave[2] ? 1 : 2);
		int cell = (i[2] * s->cells[1] + i[1]) * s->cells[0] + i[0];
		for (uint32 k = tab->first[cell]; k < tab->first[cell + 1]; k++) {
			int n = (int)tab->reference[k];
			GLOBAL const float *q = tab->particle + 4 * (long)n;
			struct vec v = vec3(q[0] - p.x, q[1] - p.y, q[2] - p.z);
			float depth = dot3(v, r.along);
			struct vec off = sub(v, scale(r.along, depth));    /* no cancellation of squares */
			float d2 = dot3(off, off);
			int class = (int)float_bits(q[3]);
			if (!(depth + t0 > 0.f) || n == r.skip || !(d2 < tab->disc_most[class]))
				continue;
			for (int j = 0; j < w.n; j++)
				if (d2 < tab->disc[class * s->n_waves + wave_of(w, j)] && depth < t[j]) {
					t[j] = depth;
					id[j] = n;
				}
		}
		/* What was met may lie in a further cell, where others may come before it. */
		float furthest = 0.f;
		for (int j = 0; j < w.n; j++)
			furthest = most(furthest, t[j]);
		if (furthest <= leave[axis] || !(leave[axis] < t1))
			return;
		int step = inv[axis] > 0.f ? 1 : -1;
		i[axis] += step;
		if (i[axis] < 0 || i[axis] >= s->cells[axis])
			return;
		wall[axis] += step;
		leave[axis] = (s->grid_low[axis] + (float)wall[axis] * s->cell[axis] - at[axis]) * inv[axis];
	}
}

/* ------------------------------------------------------------------ both models */

/* Transmittance of the ray up to t_end at each wavelength. */
FN void transmittance(const struct scene *s, const struct tables *tab, struct ray r, float t_end, struct waves w, float *out)
{
	float t0, t1, depth[MAX_WAVES];
	int id[MAX_WAVES];
	struct vec entry;
	if (s->transport == TRANSPORT_EXPLICIT) {
		first_particles(s, tab, r, t_end, w, depth, id, &entry);
		for (int j = 0; j < w.n; j++)
			out[j] = id[j] == NONE ? 1.f : 0.f;
		return;
	}
	clip_medium(s, r, &t0, &t1);
	t1 = least(t1, t_end);
	for (int j = 0; j < w.n; j++)
		out[j] = t0 < t1 ? expneg(tab->extinction[wave_of(w, j)] * (t1 - t0)) : 1.f;
}

/* Where a flight ends. */
struct collision {
	int happened;              /* else it reached t_end */
	struct vec point;          /* of the collision */
	int class, id;             /* what scatters there; id NONE in a continuous medium */
};

/* A free flight of the hero wavelength up to t_end; event[j]: its density (collision) or probability (none) for wavelength j,
 * up to a common factor. */
FN struct collision free_flight(const struct scene *s, const struct tables *tab, struct ray r, float t_end, struct waves w,
                                int hero, float u, float *event)
{
	struct collision c = { 0, r.from, s->n_classes, NONE };
	float t0, t1, depth[MAX_WAVES];
	int id[MAX_WAVES];
	struct vec entry;
	if (s->transport == TRANSPORT_EXPLICIT) {
		first_particles(s, tab, r, t_end, w, depth, id, &entry);
		c.id = id[hero];
		c.happened = c.id != NONE;
		c.point = add(entry, scale(r.along, depth[hero]));
		if (c.happened)
			c.class = (int)float_bits(tab->particle[4 * (long)c.id + 3]);
		for (int j = 0; j < w.n; j++)
			event[j] = id[j] == c.id ? 1.f : 0.f;
		return c;
	}
	clip_medium(s, r, &t0, &t1);
	t1 = least(t1, t_end);
	float length = most(t1 - t0, 0.f), sigma = tab->extinction[wave_of(w, hero)];
	float free = neglog(1.f - u);
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

#endif

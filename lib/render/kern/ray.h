/* ray - rays, the wavelengths that travel along them, and where they are inside a box or a sphere. */
#ifndef KERN_RAY_H
#define KERN_RAY_H

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
	float area;                /* cross-section of the cylinder that a fat ray queries, m^2, constant along a path */
};

FN float inverse(float x) { return 1.f / (x < 0.f ? least(x, -1e-20f) : most(x, 1e-20f)); }

/* [*t0, *t1], *t0 >= 0, of the ray lies in the box widened by a margin; nothing if *t0 >= *t1. */
FN void clip_box(struct ray r, const float *low, const float *high, float margin, float *t0, float *t1)
{
	float ix = inverse(r.along.x), iy = inverse(r.along.y), iz = inverse(r.along.z);
	float ax = (low[0] - margin - r.from.x) * ix, bx = (high[0] + margin - r.from.x) * ix;
	float ay = (low[1] - margin - r.from.y) * iy, by = (high[1] + margin - r.from.y) * iy;
	float az = (low[2] - margin - r.from.z) * iz, bz = (high[2] + margin - r.from.z) * iz;
	*t0 = most(most(0.f, least(ax, bx)), most(least(ay, by), least(az, bz)));
	*t1 = least(most(ax, bx), least(most(ay, by), most(az, bz)));
}

FN void clip_sphere(struct ray r, float radius, float *t0, float *t1)
{
	/* The nearest point of the ray to the centre first: the half chord then has no cancellation. */
	float middle = -dot3(r.from, r.along);
	struct vec nearest = add(r.from, scale(r.along, middle));
	float h2 = radius * radius - dot3(nearest, nearest);
	float h = root(most(h2, 0.f));
	*t0 = most(0.f, middle - h);
	*t1 = h2 > 0.f ? middle + h : 0.f;
}

/* The medium's own shape; particles in voxels fill these, which for a sphere reach beyond it. */
FN void clip_medium(const struct scene *s, struct ray r, float *t0, float *t1)
{
	if (s->transport == TRANSPORT_GRID && s->counted)
		clip_box(r, s->voxel_low, s->voxel_high, 0.f, t0, t1);
	else if (s->round)
		clip_sphere(r, s->extent[0], t0, t1);
	else {
		float low[3] = { -s->extent[0], -s->extent[1], -s->extent[2] };
		clip_box(r, low, s->extent, 0.f, t0, t1);
	}
}

#endif

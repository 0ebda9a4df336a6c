/* ray - rays, and where they are inside a box or a sphere. */
#ifndef KERN_RAY_H
#define KERN_RAY_H

#include "render/kern/math.h"
#include "render/kern/constants.h"

#define FAR 3e38f

struct ray {
	struct vec from, along, inverse;    /* 1 / along */
	iv skip;                   /* particle that it starts from, or NONE */
	iv volume;                 /* of several, the one that has this particle */
};

FN fv away_from_zero(fv x, float least_of) { return SEL(lt(x, FV(0.f)), fv_min(x, FV(-least_of)), fv_max(x, FV(least_of))); }
FN fv inverse(fv x) { return 1.f / away_from_zero(x, 1e-20f); }

/* 1 / x, 1 / y, 1 / z of a direction by one division; no less than 1e-12 in size is taken. */
FN struct vec inverse3(struct vec v)
{
	fv x = away_from_zero(v.x, 1e-12f), y = away_from_zero(v.y, 1e-12f), z = away_from_zero(v.z, 1e-12f);
	fv xy = x * y, all = 1.f / (xy * z), k = all * z;
	return vec3(y * k, x * k, xy * all);
}

/* [*t0, *t1], *t0 >= 0, of the ray lies in the box; nothing if *t0 >= *t1. */
FN void clip_box(struct ray r, struct vec centre, struct vec half_size, fv *t0, fv *t1)
{
	struct vec i = r.inverse, from = sub(r.from, centre);
	fv x = from.x * i.x, y = from.y * i.y, z = from.z * i.z;
	fv u = half_size.x * fv_abs(i.x), v = half_size.y * fv_abs(i.y), w = half_size.z * fv_abs(i.z);
	*t0 = fv_max(FV(0.f), fv_max(-u - x, fv_max(-v - y, -w - z)));
	*t1 = fv_min(u - x, fv_min(v - y, w - z));
}

FN void clip_sphere(struct ray r, float radius, fv *t0, fv *t1)
{
	/* The nearest point of the ray to the centre first: the half chord then has no cancellation. */
	fv middle = -dot3(r.from, r.along);
	struct vec nearest = add(r.from, scale(r.along, middle));
	fv h2 = radius * radius - dot3(nearest, nearest), h = fv_sqrt(fv_max(h2, FV(0.f)));
	*t0 = fv_max(FV(0.f), middle - h);
	*t1 = SEL(lt(FV(0.f), h2), middle + h, FV(0.f));
}

/* The medium's own shape; cubes that count particles fill these, which for a sphere reach beyond it. */
FN void clip_volume(const struct volume *v, struct ray r, fv *t0, fv *t1)
{
	if (v->round && !(TRANSPORT_OF(v) == TRANSPORT_GRID && IS_COUNTED(v)))
		clip_sphere(r, v->extent[0], t0, t1);
	else
		clip_box(r, vec3(FV(0.f), FV(0.f), FV(0.f)), load3(v->extent), t0, t1);
}

#endif

/* camera - where paths begin. */
#ifndef KERN_CAMERA_H
#define KERN_CAMERA_H

#include "render/kern/ray.h"

/* The ray through a place of the image, in pixels from its left and top. */
FN struct ray camera_ray(const struct camera *c, fv column, fv row)
{
	fv x = column * (2.f / (float)c->width) - 1.f, y = 1.f - row * (2.f / (float)c->height);
	struct vec along = unit3(add(load3(c->forward), add(scale(load3(c->right), x), scale(load3(c->up), y)))), from = load3(c->from);
	if (c->ahead > 0.f)
		from = add(from, add(scale(load3(c->across), x), scale(load3(c->rise), y)));
	struct ray r = { from, along, inverse3(along), IV(NONE), IV(0) };
	return r;
}

/* How far from the eye a place at distance t along a camera's ray is. */
FN fv camera_distance(const struct camera *c, struct vec along, fv t)
{
	return c->ahead > 0.f ? c->ahead / dot3(along, load3(c->forward)) + t : t;
}

#endif

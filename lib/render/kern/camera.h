/* camera - where paths begin. */
#ifndef KERN_CAMERA_H
#define KERN_CAMERA_H

#include "render/kern/ray.h"

/* The ray through a place of the image, in pixels from its left and top. */
FN struct ray camera_ray(const struct camera *c, fv column, fv row)
{
	fv x = column * (2.f / (float)c->width) - 1.f, y = 1.f - row * (2.f / (float)c->height);
	struct vec along = unit3(add(load3(c->forward), add(scale(load3(c->right), x), scale(load3(c->up), y))));
	struct ray r = { load3(c->eye), along, inverse3(along), IV(NONE) };
	return r;
}

#endif

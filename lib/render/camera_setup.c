#include "render/setup_parts.h"

#include <math.h>

/* Image: top row up, right = forward x up; fov along the longer side. */
void camera_setup(struct camera *c, const struct scenefile *f)
{
	double forward[3], right[3], up[3], longer = fmax(f->width, f->height), half = tan(f->fov * M_PI / 360);
	for (int i = 0; i < 3; i++)
		forward[i] = f->target[i] - f->position[i];
	setup_unit(forward);
	setup_cross(forward, f->up, right);
	setup_unit(right);
	setup_cross(right, forward, up);
	for (int i = 0; i < 3; i++) {
		c->eye[i] = (float)(f->position[i] - f->medium_position[i]);
		c->forward[i] = (float)forward[i];
		c->right[i] = (float)(right[i] * half * f->width / longer);
		c->up[i] = (float)(up[i] * half * f->height / longer);
	}
	c->width = f->width;
	c->height = f->height;
}

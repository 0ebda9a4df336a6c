#include "render/setup_parts.h"

#include <math.h>

#define FAR_EYE 64     /* volumes away: from there on floats from the eye would be too coarse for what is in it */

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* How far ahead of the eye, along forward, the first of the scene begins; not above 0 where it is around the eye or behind it. Planes
 * across forward are taken, since rays that begin on one are linear in the image's coordinates. span: of a ray through each corner of the
 * image, eye: from the origin. */
static double scene_begin(const struct scene *s, const double *eye, const double *forward, double span[4][3])
{
	double reach = setup_reach(s), first = -dot(eye, forward) - reach;
	for (int i = 0; i < s->surfaces.n; i++) {
		const struct surface *q = &s->surfaces.surface[i];
		double nearest = INFINITY, furthest = -INFINITY;
		for (int k = 0; k < 4; k++) {
			double at[3];
			for (int a = 0; a < 3; a++)
				at[a] = (double)q->corner[a] + (k & 1 ? q->edge[0][a] : 0) + (k & 2 ? q->edge[1][a] : 0) - eye[a];
			nearest = fmin(nearest, dot(at, forward));
			furthest = fmax(furthest, dot(at, forward));
		}
		first = furthest > 0 ? fmin(first, nearest) : first;
	}
	for (int k = 0; k < 4 && s->surfaces.has_ground; k++) {
		double down = (s->surfaces.ground_height - eye[1]) / span[k][1];
		first = down > 0 ? fmin(first, down) : first;
	}
	return first > FAR_EYE * reach ? first - reach : 0;
}

/* Image: top row up, right = forward x up; fov along the longer side. */
void camera_setup(struct setup *u, const struct scenefile *f)
{
	struct camera *c = &u->scene.camera;
	double forward[3], right[3], up[3], eye[3], span[4][3], from[3], longer = fmax(f->width, f->height), half = tan(f->fov * M_PI / 360);
	for (int i = 0; i < 3; i++) {
		forward[i] = f->target[i] - f->position[i];
		eye[i] = f->position[i] - u->origin[i];
	}
	setup_unit(forward);
	setup_cross(forward, f->up, right);
	setup_unit(right);
	setup_cross(right, forward, up);
	for (int i = 0; i < 3; i++) {
		right[i] *= half * f->width / longer;
		up[i] *= half * f->height / longer;
		for (int k = 0; k < 4; k++)
			span[k][i] = forward[i] + (k & 1 ? right[i] : -right[i]) + (k & 2 ? up[i] : -up[i]);
	}
	double ahead = scene_begin(&u->scene, eye, forward, span);
	for (int i = 0; i < 3; i++)
		from[i] = eye[i] + ahead * forward[i];
	c->ahead = (float)ahead;
	setup_floats(forward, c->forward);
	setup_floats(right, c->right);
	setup_floats(up, c->up);
	setup_floats(from, c->from);
	for (int i = 0; i < 3; i++) {
		c->across[i] = (float)(ahead * right[i]);
		c->rise[i] = (float)(ahead * up[i]);
	}
	c->width = f->width;
	c->height = f->height;
}

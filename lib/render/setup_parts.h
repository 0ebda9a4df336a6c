/* setup_parts - the parts of scene_setup, in the order in which they are made: each fills its part of the scene and its tables. */
#ifndef RENDER_SETUP_PARTS_H
#define RENDER_SETUP_PARTS_H

#include "render/scene_setup.h"

/* SET_TABLE - a table of volume k that somebody owns. */
#define SET_TABLE(u, k, name, pointer, elements) ((u)->tables[k].name = (pointer), (u)->size[k].name = (elements))

/* setup_own - setup_free frees p. */
void *setup_own(struct setup *u, void *p);

/* setup_unit - v to length 1. setup_cross - out = a x b. setup_floats - v rounded. Of three elements each. */
void setup_unit(double *v);
void setup_cross(const double *a, const double *b, double *out);
void setup_floats(const double *v, float *out);

/* setup_reach - how far from the origin the volumes go, m. */
double setup_reach(const struct scene *s);

/* camera_setup - needs the volumes and the surfaces: rays begin where these do. */
void camera_setup(struct setup *u, const struct scenefile *f);

/* volume_setup - volume k, of a medium by that name; needs its transport; peaked: whether a forward peak makes spikes, of
 * lights that are suns, and none but this volume scatters. */
void volume_setup(struct setup *u, int k, const struct scenefile *f, const char *name, const struct medium *m, int peaked);

/* light_setup - lights and surfaces; needs the volumes, and their peak and truncation. */
void light_setup(struct setup *u, const struct scenefile *f);

#endif

/* backend - what adds samples to a film: the kernels as C, or as OpenCL. */
#ifndef RENDER_BACKEND_H
#define RENDER_BACKEND_H

#include "render/film.h"
#include "render/scene_setup.h"

#include <stdio.h>

/* render_c - add samples [first, first + n) of pixels [pixel, pixel + pixels) to the film, by the C build of the kernels for this
 * processor: the widest lanes that it has, unless MOTES_CPU in the environment asks for scalar, v2, v3 or v4. Dies where that is none
 * of them, or more than the processor has. The film does not depend on it. */
void render_c(const struct setup *u, struct film *f, uint32 pixel, uint32 pixels, uint32 first, uint32 n, int threads);

/* The same by OpenCL, whose device holds the tables and a copy of the film. Each dies with one line on any failure. */
struct cl;
void cl_list(FILE *out);           /* a line a device: number, name, kind, platform, memory */
/* device -1: the first GPU, or else the first; verbose says which */
struct cl *cl_start(const struct setup *u, const struct film *f, int device, int verbose);
int cl_wide(const struct cl *c);   /* whether it wants very many pixels at once, as a GPU does */
void cl_render(struct cl *c, uint32 pixel, uint32 pixels, uint32 first, uint32 n);    /* of the pixels [pixel, pixel + pixels) */
void cl_read(const struct cl *c, struct film *f);     /* the device's film as it is by now, in place of what f holds */
void cl_free(struct cl *c);

#endif

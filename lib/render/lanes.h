/* lanes - the C builds of the kernels: one for each processor, transport, and number of wavelengths where that is 1 or 3, without and
 * with a peaked phase function. */
#ifndef RENDER_LANES_H
#define RENDER_LANES_H

#include "render/kern/scene.h"

/* Adds samples [first, last) of pixels [first_pixel, last_pixel) to the film, as render_pixels in kern/render.h. */
typedef void render_fn(const struct scene *s, const struct tables *t, int64 *film, int *overflow, uint32 first_pixel, uint32 last_pixel,
                       uint32 first, uint32 last);

/* render_CPU_TRANSPORT_WAVES; 0 wavelengths stands for any number. */
#define LANES_OF(cpu, transport) render_fn render_##cpu##_##transport##_0, render_##cpu##_##transport##_1, render_##cpu##_##transport##_3, \
	render_##cpu##_##transport##_1p, render_##cpu##_##transport##_3p;
#define LANES_FOR(cpu) LANES_OF(cpu, 0) LANES_OF(cpu, 1) LANES_OF(cpu, 2) LANES_OF(cpu, 3)
LANES_FOR(scalar)
#ifdef __x86_64__
LANES_FOR(v2)
LANES_FOR(v3)
LANES_FOR(v4)
#endif

#endif

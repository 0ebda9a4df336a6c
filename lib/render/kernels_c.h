/* kernels_c - the C builds of the kernels: for each processor, for 1 and 3 wavelengths apart from any number of them, and for
 * continuous media without a forward peak (smooth) apart from all. */
#ifndef RENDER_KERNELS_C_H
#define RENDER_KERNELS_C_H

#include "base/cpu.h"
#include "render/kern/scene.h"

/* Adds samples [first, last) of pixels [first_pixel, last_pixel) to the film, as render_pixels in kern/render.h; t: of each volume. */
typedef void render_fn(const struct scene *s, const struct tables *t, int64 *film, int *overflow, uint32 first_pixel, uint32 last_pixel,
                       uint32 first, uint32 last);

CPU_DECLARE(render_fn, render_any);
CPU_DECLARE(render_fn, render_1);
CPU_DECLARE(render_fn, render_3);
CPU_DECLARE(render_fn, render_smooth1);
CPU_DECLARE(render_fn, render_smooth3);

#endif

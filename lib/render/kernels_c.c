/* One build of the kernels: compiled many times, with RENDER the name, LANES, and perhaps constants (kern/constants.h). */
#include "render/kern/render.h"
#include "render/kernels_c.h"

render_fn RENDER;

void RENDER(const struct scene *s, const struct tables *t, int64 *film, int *overflow, uint32 first_pixel, uint32 last_pixel, uint32 first,
            uint32 last)
{
	render_pixels(s, t, film, overflow, first_pixel, last_pixel, first, last);
}

/* film - the sums of an image's samples, as the kernels add to them (kern/film.h); what can be told of them only when they are looked
 * at is computed then, so that a film may be looked at at any time and go on. */
#ifndef RENDER_FILM_H
#define RENDER_FILM_H

#include "render/kern/scene.h"

#include <stddef.h>

struct film {
	int width, height;
	int n_sums;                /* of a pixel */
	int channels;              /* 1 where green and blue are as red, whose sums alone are kept then */
	int64 *sum;                /* [pixel][n_sums] */
	int overflow;              /* a sum went beyond its limit */
};

/* film_make - empty, of a scene's image. */
void film_make(struct film *f, const struct scene *s);

/* film_pixel - the sums of a pixel, all channels and the sum over all orders of scattering among them: out[n_sums]. Returns 0 where one is
 * out of range. */
int film_pixel(const struct film *f, size_t pixel, int64 *out);

/* film_holds - are all sums in range? */
int film_holds(const struct film *f);

void film_free(struct film *f);

#endif

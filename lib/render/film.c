#include "render/film.h"

#include "base/die.h"
#include "render/kern/film.h"

#include <stdlib.h>
#include <string.h>

void film_make(struct film *f, const struct scene *s)
{
	*f = (struct film){ .width = s->camera.width, .height = s->camera.height, .n_sums = s->film_sums, .channels = s->channels };
	f->sum = xalloc((size_t)f->width * (size_t)f->height, (size_t)f->n_sums * sizeof *f->sum);
}

int film_pixel(const struct film *f, size_t pixel, int64 *out)
{
	int overflow = 0;
	memcpy(out, f->sum + pixel * (size_t)f->n_sums, (size_t)f->n_sums * sizeof *out);
	for (int c = 0; c < 3; c++) {
		int64 *own = &out[SUM_OF(0, c)];
		if (c >= f->channels)
			memcpy(own, out, 3 * sizeof *own);
		else    /* what was seen unscattered, and the rest */
			for (int kind = SUM_SINGLE; kind <= SUM_MULTIPLE; kind++)
				overflow |= __builtin_add_overflow(own[SUM_ALL], own[kind], &own[SUM_ALL]);
	}
	return !overflow;
}

int film_holds(const struct film *f)
{
	size_t pixels = (size_t)f->width * (size_t)f->height;
	int64 *room = xalloc((size_t)f->n_sums, sizeof *room);
	int holds = !f->overflow;
	for (size_t i = 0; i < pixels && holds; i++)
		holds = film_pixel(f, i, room);
	free(room);
	return holds;
}

void film_free(struct film *f)
{
	free(f->sum);
}

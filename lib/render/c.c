/* The C build of the kernels. */
#include "render/job.h"
#include "render/kern/film.h"

void render_c(struct job *j, uint32 first, uint32 n, int threads)
{
	int64 pixels = (int64)j->scene.width * j->scene.height;
	int overflow = 0;
#pragma omp parallel for num_threads(threads) schedule(dynamic, 64) reduction(| : overflow)
	for (int64 i = 0; i < pixels; i++)
		render_pixel(&j->scene, &j->tables, j->film + j->scene.film_sums * i, &overflow, (uint32)i, first, n);
	j->overflow |= overflow;
}

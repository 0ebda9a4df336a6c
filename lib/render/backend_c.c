/* The C backend: which build of the kernels serves a scene, and its pixels divided among threads. */
#include "base/cpu.h"
#include "render/backend.h"
#include "render/kernels_c.h"

#define CHUNK 256              /* pixels that a thread takes at a time, or fewer, */
#define CHUNK_PATHS 16384      /* of about so many paths */

static render_fn *build_for(const struct scene *s)
{
	render_fn *const any[CPU_LEVELS] = CPU_BUILDS(render_any);
	render_fn *const one[2][CPU_LEVELS] = { CPU_BUILDS(render_1), CPU_BUILDS(render_smooth1) };
	render_fn *const three[2][CPU_LEVELS] = { CPU_BUILDS(render_3), CPU_BUILDS(render_smooth3) };
	int plain = s->n_volumes == 1 && s->channels == s->n_waves && !s->spectral, level = cpu_level();
	int smooth = s->volume[0].transport == TRANSPORT_CONTINUOUS && !(s->peak > 0.f);
	return plain && s->n_waves == 1 ? one[smooth][level] : plain && s->n_waves == 3 ? three[smooth][level] : any[level];
}

void render_c(const struct setup *u, struct film *f, uint32 pixel, uint32 pixels, uint32 first, uint32 n, int threads)
{
	render_fn *render = build_for(&u->scene);
	uint32 end = pixel + pixels, chunk = n < CHUNK_PATHS / CHUNK ? CHUNK : CHUNK_PATHS / n + 1;
	int overflow = 0;
#pragma omp parallel for num_threads(threads) schedule(dynamic) reduction(| : overflow)
	for (uint32 from = pixel; from < end; from += chunk)
		render(&u->scene, u->tables, f->sum, &overflow, from, end - from < chunk ? end : from + chunk, first, first + n);
	f->overflow |= overflow;
}

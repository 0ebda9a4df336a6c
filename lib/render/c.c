/* The C backend: which build of the kernels serves a job, and its pixels divided among threads. */
#include "base/cpu.h"
#include "render/job.h"
#include "render/lanes.h"

#define CHUNK 256              /* pixels that a thread takes at a time, or fewer, */
#define CHUNK_PATHS 16384      /* of about so many paths */

#define BUILDS_OF(cpu, transport) { { render_##cpu##_##transport##_0, render_##cpu##_##transport##_1, render_##cpu##_##transport##_3 }, \
	{ render_##cpu##_##transport##_0, render_##cpu##_##transport##_1p, render_##cpu##_##transport##_3p } }
#define BUILDS(cpu) { BUILDS_OF(cpu, 0), BUILDS_OF(cpu, 1), BUILDS_OF(cpu, 2), BUILDS_OF(cpu, 3) }

static render_fn *build_for(const struct scene *s)
{
	render_fn *const build[][4][2][3] = { BUILDS(scalar),    /* [cpu][transport][without, with a peak][any, 1, 3 wavelengths, channels] */
#ifdef __x86_64__
		BUILDS(v2), BUILDS(v3), BUILDS(v4)
#endif
	};
	int plain = s->channels == s->n_waves && !s->spectral;
	return build[cpu_level()][s->transport][s->peak > 0][!plain ? 0 : s->n_waves == 1 ? 1 : s->n_waves == 3 ? 2 : 0];
}

void render_c(struct job *j, uint32 pixel, uint32 pixels, uint32 first, uint32 n, int threads)
{
	render_fn *render = build_for(&j->scene);
	uint32 end = pixel + pixels, chunk = n < CHUNK_PATHS / CHUNK ? CHUNK : CHUNK_PATHS / n + 1;
	int overflow = 0;
#pragma omp parallel for num_threads(threads) schedule(dynamic) reduction(| : overflow)
	for (uint32 from = pixel; from < end; from += chunk)
		render(&j->scene, &j->tables, j->film, &overflow, from, end - from < chunk ? end : from + chunk, first, first + n);
	j->overflow |= overflow;
}

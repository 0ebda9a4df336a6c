/* The C backend: which build of the kernels serves a job, and its pixels divided among threads. */
#include "base/die.h"
#include "render/job.h"
#include "render/lanes.h"

#include <stdlib.h>
#include <string.h>

#define CHUNK 256              /* pixels that a thread takes at a time */

#define BUILDS_OF(cpu, transport) { { render_##cpu##_##transport##_0, render_##cpu##_##transport##_1, render_##cpu##_##transport##_3 }, \
	{ render_##cpu##_##transport##_0, render_##cpu##_##transport##_1p, render_##cpu##_##transport##_3p } }
#define BUILDS(cpu) { BUILDS_OF(cpu, 0), BUILDS_OF(cpu, 1), BUILDS_OF(cpu, 2), BUILDS_OF(cpu, 3) }

struct cpu {
	const char *name;
	int here;                  /* this processor can */
	render_fn *build[4][2][3]; /* [transport][without, with a peak][any, 1, 3 wavelengths] */
};

static render_fn *build_for(const struct scene *s)
{
	const struct cpu cpus[] = {
#ifdef __x86_64__
		{ "v4", __builtin_cpu_supports("x86-64-v4"), BUILDS(v4) },
		{ "v3", __builtin_cpu_supports("x86-64-v3"), BUILDS(v3) },
		{ "v2", __builtin_cpu_supports("x86-64-v2"), BUILDS(v2) },
#endif
		{ "scalar", 1, BUILDS(scalar) },
	};
	const char *asked = getenv("MOTES_CPU");
	for (size_t i = 0; i < sizeof cpus / sizeof *cpus; i++) {
		if (asked && *asked ? strcmp(asked, cpus[i].name) : !cpus[i].here)
			continue;
		if (!cpus[i].here)
			die("MOTES_CPU", "this processor is no %s", asked);
		return cpus[i].build[s->transport][s->peak > 0][s->n_waves == 1 ? 1 : s->n_waves == 3 ? 2 : 0];
	}
	die("MOTES_CPU", "'%s' is none of scalar, v2, v3, v4", asked);
}

void render_c(struct job *j, uint32 first, uint32 n, int threads)
{
	render_fn *render = build_for(&j->scene);
	uint32 pixels = (uint32)(j->scene.width * j->scene.height);
	int overflow = 0;
#pragma omp parallel for num_threads(threads) schedule(dynamic) reduction(| : overflow)
	for (uint32 from = 0; from < pixels; from += CHUNK)
		render(&j->scene, &j->tables, j->film, &overflow, from, pixels - from < CHUNK ? pixels : from + CHUNK, first, first + n);
	j->overflow |= overflow;
}

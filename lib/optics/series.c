#include "optics/series_kernels.h"

#include <stdlib.h>
#include <string.h>

struct cpu {
	const char *name;
	const struct series_kernels *kernels;    /* NULL: this processor cannot */
};

/* What MOTES_CPU asks for, else the best there is; name NULL: it asks for what does not exist. */
static struct cpu choice(void)
{
	const struct cpu cpus[] = {
#ifdef __x86_64__
		{ "v4", __builtin_cpu_supports("x86-64-v4") ? &series_v4 : NULL },
		{ "v3", __builtin_cpu_supports("x86-64-v3") ? &series_v3 : NULL },
		{ "v2", __builtin_cpu_supports("x86-64-v2") ? &series_v2 : NULL },
#endif
		{ "scalar", &series_scalar },
	};
	const char *asked = getenv("MOTES_CPU");
	for (size_t i = 0; i < sizeof cpus / sizeof *cpus; i++)
		if (asked && *asked ? !strcmp(asked, cpus[i].name) : cpus[i].kernels != NULL)
			return cpus[i];
	return (struct cpu){ NULL, NULL };
}

const char *series_refuses(void)
{
	struct cpu c = choice();
	return !c.name ? "is none of scalar, v2, v3, v4" : !c.kernels ? "is more than this processor can" : NULL;
}

/* The shortest grid with a length that the transform likes: 16 2^a or 16 3 2^a, at least twice the highest order. */
static int steps_for(int n)
{
	int two = 32, three = 48;
	while (two < 2 * n)
		two *= 2;
	while (three < 2 * n)
		three *= 2;
	return two < three ? two : three;
}

struct series *series_new(int n, double (*c)[SERIES])
{
	struct series *s = malloc(sizeof *s);
	if (!s)
		return NULL;
	s->kernels = choice().kernels;
	if (!s->kernels)
		s->kernels = &series_scalar;
	s->steps = steps_for(n);
	s->grid = malloc(((size_t)s->steps + 2 * SERIES_PAD) * SERIES * sizeof *s->grid);
	if (!s->grid || s->kernels->prepare(s, n, c)) {
		series_free(s);
		return NULL;
	}
	return s;
}

void series_at(const struct series *s, int count, const double *theta, double (*values)[SERIES])
{
	s->kernels->at(s, count, theta, values);
}

void series_free(struct series *s)
{
	if (s)
		free(s->grid);
	free(s);
}

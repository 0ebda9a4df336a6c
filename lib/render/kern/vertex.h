/* vertex - where a path scatters, and by what: a class of one of the scene's volumes, or the ground. */
#ifndef KERN_VERTEX_H
#define KERN_VERTEX_H

#include "render/kern/phase.h"

enum { VERTEX_MEDIUM, VERTEX_GROUND };

struct vertex {
	struct vec point;
	iv kind;
	iv class, id;              /* what scatters in a medium; id NONE where it is no single particle */
	iv volume;                 /* of several, the one that has it */
};

#define ON_GROUND(vertex) (HAS_GROUND ? ieq((vertex).kind, IV(VERTEX_GROUND)) : NO_LANE)

/* Lanes m of vertices in volume k. */
#define IN_VOLUME(m, vertex, k) (N_VOLUMES > 1 ? (m) & ieq((vertex)->volume, IV(k)) : (m))

/* The albedo of what scatters at wavelength j. */
FN fv vertex_albedo(const struct scene *s, const struct tables *t, mv m, const struct vertex *vertex, struct waves w, int j)
{
	fv albedo = FV(0.f);
	for (int k = 0; k < N_VOLUMES; k++) {
		mv own = IN_VOLUME(m, vertex, k);
		fv there = of_class(s, &s->volume[k], t[k].albedo, own, vertex->class, w, j);
		albedo = N_VOLUMES > 1 ? SEL(own, there, albedo) : there;
	}
	return albedo;
}

/* value[j] in sr^-1 at an angle, as phase_value. */
FN void vertex_phase(const struct scene *s, const struct tables *t, mv m, const struct vertex *vertex, fv theta, struct waves w, fv *value)
{
	EACH_WAVE(j)
		value[j] = FV(0.f);
	for (int k = 0; k < N_VOLUMES; k++) {
		mv own = IN_VOLUME(m, vertex, k);
		fv there[CARRIED];
		phase_value(s, t + k, own, s->volume[k].only_class, vertex->class, theta, w, there);
		EACH_WAVE(j)
			value[j] = N_VOLUMES > 1 ? SEL(own, there[j], value[j]) : there[j];
	}
}

/* A scattering angle, as phase_draw. */
FN void vertex_draw(const struct scene *s, const struct tables *t, mv m, const struct vertex *vertex, struct waves w, uv u, uv v, fv *sine,
                    fv *cosine, fv *value)
{
	*sine = *cosine = FV(0.f);
	EACH_WAVE(j)
		value[j] = FV(0.f);
	for (int k = 0; k < N_VOLUMES; k++) {
		mv own = IN_VOLUME(m, vertex, k);
		fv sn, cs, there[CARRIED];
		phase_draw(s, t + k, own, s->volume[k].only_class, vertex->class, w, u, v, &sn, &cs, there);
		*sine = N_VOLUMES > 1 ? SEL(own, sn, *sine) : sn;
		*cosine = N_VOLUMES > 1 ? SEL(own, cs, *cosine) : cs;
		EACH_WAVE(j)
			value[j] = N_VOLUMES > 1 ? SEL(own, there[j], value[j]) : there[j];
	}
}

#endif

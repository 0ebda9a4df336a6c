/* waves - the wavelengths that travel along a path, and their values in tables. */
#ifndef KERN_WAVES_H
#define KERN_WAVES_H

#include "render/kern/constants.h"

/* The wavelengths of a path: index wave_of(w, j) in the medium's list, j < n. Where the largest group has one more, it stands for
 * any; its pdf is 0. The path is sampled for one of them, the hero. */
struct waves {
	iv n, first, hero;
};

/* A value of wavelength j, from a table by wavelength that begins at index from; of lanes m. */
#ifdef WAVES
FN iv wave_of(const struct scene *s, struct waves w, int j) { return (void)s, (void)w, IV(j); }
FN fv of_wave(const struct scene *s, FLOATS table, int from, mv m, struct waves w, int j)
{
	return (void)s, (void)w, (void)m, FV(float_at(table, from + j));
}
#else
FN iv wave_of(const struct scene *s, struct waves w, int j) { return iv_min(w.first + s->n_groups * j, IV(N_WAVES - 1)); }
FN fv of_wave(const struct scene *s, FLOATS table, int from, mv m, struct waves w, int j)
{
	return gather(m, table, from + wave_of(s, w, j));
}
#endif

/* The same from a table [class][wave]. */
FN fv of_class(const struct scene *s, const struct volume *v, FLOATS table, mv m, iv class, struct waves w, int j)
{
	return v->only_class >= 0 ? of_wave(s, table, v->only_class * N_WAVES, m, w, j)
	    : gather(m, table, class * N_WAVES + wave_of(s, w, j));
}

/* The hero's index in the medium's list; and a value of it. */
FN iv hero_of(const struct scene *s, struct waves w)
{
#if defined WAVES && WAVES == 1
	return (void)s, (void)w, IV(0);
#else
	return w.first + s->n_groups * w.hero;
#endif
}

FN fv of_hero(const struct scene *s, FLOATS table, mv m, struct waves w)
{
	return CARRIED == 1 ? FV(float_at(table, 0)) : gather(m, table, hero_of(s, w));
}

/* The hero's of values by wavelength. */
FN fv hero_among(const struct scene *s, const fv *value, struct waves w)
{
	fv own = value[0];
	EACH_WAVE(j)
		own = SEL(ieq(w.hero, IV(j)), value[j], own);
	return own;
}

#endif

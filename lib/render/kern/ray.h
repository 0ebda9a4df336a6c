/* ray - rays, the wavelengths that travel along them, and where they are inside a box or a sphere. */
#ifndef KERN_RAY_H
#define KERN_RAY_H

#include "render/kern/math.h"
#include "render/kern/scene.h"

#define FAR 3e38f
#define NONE (-1)

/* What a build has as constants: its transport, the number of wavelengths, channels, whether there is a peak, or all that a scene alone
 * is told by; the rest is as in the scene. */
#ifndef TRANSPORT
#define TRANSPORT (s->transport)
#endif
#ifndef PEAK
#define PEAK (s->peak > 0.f)
#endif
#ifndef CHANNELS
#define CHANNELS (s->channels)
#define SPECTRAL (s->spectral)
#endif
#ifndef BRANCHES
#define BRANCHES (s->branches > 1)
#define HAS_GROUND (s->has_ground)
#define ALL_ISOTROPIC (s->isotropic)
#define COUNTED (s->counted)
#endif
#ifdef WAVES
#define CARRIED WAVES
#define EACH_WAVE(j) EACH(j, WAVES)
#else
#define CARRIED MAX_WAVES
#define EACH_WAVE(j) for (int j = 0; j < s->carried; j++)
#endif

/* The wavelengths of a path: index wave_of(w, j) in the medium's list, j < n. Where the largest group has one more, it stands for
 * any; its density is 0. */
struct waves {
	iv n, first;
};

/* A value of wavelength j, from a table by wavelength that begins at index from; of lanes m. */
#ifdef WAVES
FN iv wave_of(const struct scene *s, struct waves w, int j) { return (void)s, (void)w, IV(j); }
FN fv of_wave(const struct scene *s, FLOATS table, int from, mv m, struct waves w, int j)
{
	return (void)s, (void)w, (void)m, FV(float_at(table, from + j));
}
#else
FN iv wave_of(const struct scene *s, struct waves w, int j) { return iv_min(w.first + s->n_groups * j, IV(s->n_waves - 1)); }
FN fv of_wave(const struct scene *s, FLOATS table, int from, mv m, struct waves w, int j)
{
	return gather(m, table, from + wave_of(s, w, j));
}
#endif

/* The same from a table [class][wave]. */
FN fv of_class(const struct scene *s, FLOATS table, mv m, iv class, struct waves w, int j)
{
	return s->only_class >= 0 ? of_wave(s, table, s->only_class * s->n_waves, m, w, j)
	    : gather(m, table, class * s->n_waves + wave_of(s, w, j));
}

/* The index of the hero, one of j < n, in the medium's list; and a value of it. */
FN iv hero_of(const struct scene *s, struct waves w, iv hero)
{
#if defined WAVES && WAVES == 1
	return (void)s, (void)w, (void)hero, IV(0);
#else
	return w.first + s->n_groups * hero;
#endif
}

FN fv of_hero(const struct scene *s, FLOATS table, mv m, struct waves w, iv hero)
{
	return CARRIED == 1 ? FV(float_at(table, 0)) : gather(m, table, hero_of(s, w, hero));
}

/* The hero's of values by wavelength. */
FN fv hero_among(const struct scene *s, const fv *value, iv hero)
{
	fv own = value[0];
	EACH_WAVE(j)
		own = SEL(ieq(hero, IV(j)), value[j], own);
	return own;
}

struct ray {
	struct vec from, along, inverse;    /* 1 / along */
	iv skip;                   /* particle that it starts from, or NONE */
};

FN fv away_from_zero(fv x, float least_of) { return SEL(lt(x, FV(0.f)), fv_min(x, FV(-least_of)), fv_max(x, FV(least_of))); }
FN fv inverse(fv x) { return 1.f / away_from_zero(x, 1e-20f); }

/* 1 / x, 1 / y, 1 / z of a direction by one division; no less than 1e-12 in size is taken. */
FN struct vec inverse3(struct vec v)
{
	fv x = away_from_zero(v.x, 1e-12f), y = away_from_zero(v.y, 1e-12f), z = away_from_zero(v.z, 1e-12f), xy = x * y, all = 1.f / (xy * z), k = all * z;
	return vec3(y * k, x * k, xy * all);
}

/* [*t0, *t1], *t0 >= 0, of the ray lies in the box; nothing if *t0 >= *t1. */
FN void clip_box(struct ray r, struct vec centre, struct vec half_size, fv *t0, fv *t1)
{
	struct vec i = r.inverse, from = sub(r.from, centre);
	fv x = from.x * i.x, y = from.y * i.y, z = from.z * i.z;
	fv u = half_size.x * fv_abs(i.x), v = half_size.y * fv_abs(i.y), w = half_size.z * fv_abs(i.z);
	*t0 = fv_max(FV(0.f), fv_max(-u - x, fv_max(-v - y, -w - z)));
	*t1 = fv_min(u - x, fv_min(v - y, w - z));
}

FN void clip_sphere(struct ray r, float radius, fv *t0, fv *t1)
{
	/* The nearest point of the ray to the centre first: the half chord then has no cancellation. */
	fv middle = -dot3(r.from, r.along);
	struct vec nearest = add(r.from, scale(r.along, middle));
	fv h2 = radius * radius - dot3(nearest, nearest), h = fv_sqrt(fv_max(h2, FV(0.f)));
	*t0 = fv_max(FV(0.f), middle - h);
	*t1 = SEL(lt(FV(0.f), h2), middle + h, FV(0.f));
}

/* The medium's own shape; particles in voxels fill these, which for a sphere reach beyond it. */
FN void clip_medium(const struct scene *s, struct ray r, fv *t0, fv *t1)
{
	if (s->round && !(TRANSPORT == TRANSPORT_GRID && COUNTED))
		clip_sphere(r, s->extent[0], t0, t1);
	else
		clip_box(r, vec3(FV(0.f), FV(0.f), FV(0.f)), load3(s->extent), t0, t1);
}

#endif

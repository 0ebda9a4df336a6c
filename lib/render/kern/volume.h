/* volume - free flight and transmittance in a volume, by its model: particles, voxels or homogeneous, each of which has begin, step,
 * transmittance and end.
 *
 * A flight is sampled for one wavelength, the hero; flight_pdf[j] is what its own density would be for wavelength j: the common
 * currency in which the wavelengths of a path are weighed against each other. media.h has rays through several volumes. */
#ifndef KERN_VOLUME_H
#define KERN_VOLUME_H

#include "render/kern/homogeneous.h"
#include "render/kern/particles.h"
#include "render/kern/voxels.h"

struct volume_walk {
	struct traversal ray;
	struct particle_query particles;     /* of these three, the transport's is used */
	struct voxel_dda voxels;
	struct homogeneous homogeneous;
};

/* The model's function, with the arguments that all have. */
#define MODEL(op, ...) (USES_PARTICLES(v) ? particles_##op(s, v, t, &g->ray, &g->particles, __VA_ARGS__) \
	: TRANSPORT_OF(v) == TRANSPORT_GRID ? voxels_##op(s, v, t, &g->ray, &g->voxels, __VA_ARGS__) \
	: homogeneous_##op(s, v, t, &g->ray, &g->homogeneous, __VA_ARGS__))

/* Lanes that have steps to take. */
FN mv volume_going(const struct volume *v, const struct volume_walk *g) { return TAKES_STEPS(v) ? g->ray.going : NO_LANE; }

/* Lanes m set out along r up to t_end, in flight, or else as shadow rays. */
FN void volume_begin(const struct scene *s, const struct volume *v, const struct tables *t, struct volume_walk *g, mv m, struct ray r,
                     fv t_end, mv flight, struct waves w, const struct random *random)
{
	MODEL(begin, m, r, t_end, flight, w, random);
}

/* All lanes that have steps to take do so, until at most least of them have any left. */
FN void volume_step(const struct scene *s, const struct volume *v, const struct tables *t, struct volume_walk *g, struct waves w,
                    const struct random *random, int least)
{
	if (USES_PARTICLES(v))
		while (count(g->ray.going) > least)
			particles_step(s, v, t, &g->ray, &g->particles, w, random);
	else if (TRANSPORT_OF(v) == TRANSPORT_GRID)
		while (count(g->ray.going) > least)
			voxels_step(s, v, t, &g->ray, &g->voxels, w, random);
}

/* What shadow rays m let through at each wavelength. */
FN void volume_transmittance(const struct scene *s, const struct volume *v, const struct tables *t, struct volume_walk *g, mv m,
                             struct waves w, fv *out)
{
	MODEL(transmittance, m, w, out);
}

/* How flights m ended; flight_pdf[j]: their density (collision) or probability (none) for wavelength j, up to a common factor. */
FN struct collision volume_end(const struct scene *s, const struct volume *v, const struct tables *t, struct volume_walk *g, mv m,
                               struct waves w, const struct random *random, fv *flight_pdf)
{
	struct collision c = MODEL(end, m, w, random, flight_pdf);
	if (CARRIED == 1)          /* the hero alone: its own, whatever it is */
		flight_pdf[0] = FV(1.f);
	return c;
}

/* Whether the optical depth of a flight's whole way can be known: of several volumes it is not. */
#define KNOWS_DEPTH (N_VOLUMES == 1 && !USES_PARTICLES(&s->volume[0]))
#define DEPTH_MODEL(op, ...) (TRANSPORT_OF(v) == TRANSPORT_GRID ? voxels_##op(s, v, t, &g->ray, &g->voxels, __VA_ARGS__) \
	: homogeneous_##op(s, v, t, &g->ray, &g->homogeneous, __VA_ARGS__))

/* Camera flights m, which set out, learn how thick the volume is. */
FN void volume_measure(const struct scene *s, const struct volume *v, const struct tables *t, struct volume_walk *g, mv m, struct waves w)
{
	if (TRANSPORT_OF(v) == TRANSPORT_GRID)
		voxels_measure(s, v, t, &g->voxels, m, w);
}

/* They have ended: those that went through little, *thin, are forced to end in the volume (ray.forced). Returns those that have to take
 * their steps again. */
FN mv volume_force(const struct scene *s, const struct volume *v, const struct tables *t, struct volume_walk *g, mv m, struct waves w,
                   const struct random *random, mv *thin)
{
	return DEPTH_MODEL(force, m, w, random, thin);
}

/* The optical depth of the whole way of forced flights m, at each wavelength. */
FN void volume_depth(const struct scene *s, const struct volume *v, const struct tables *t, struct volume_walk *g, mv m, struct waves w, fv *out)
{
	DEPTH_MODEL(depth, m, w, out);
}

#undef DEPTH_MODEL
#undef MODEL

#endif

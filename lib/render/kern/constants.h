/* constants - what a build may have as constants; the rest is as in the scene. In C the number of wavelengths, channels and volumes, and
 * that a medium is continuous and without a peak; in OpenCL all that many a branch depends on. */
#ifndef KERN_CONSTANTS_H
#define KERN_CONSTANTS_H

#include "render/kern/scene.h"

#ifdef VOLUMES
#define N_VOLUMES VOLUMES
#else
#define N_VOLUMES (s->n_volumes)
#endif
#ifdef TRANSPORT               /* of the only volume, as the next three */
#define TRANSPORT_OF(v) TRANSPORT
#else
#define TRANSPORT_OF(v) ((v)->transport)
#endif
#ifdef PEAK
#define HAS_PEAK PEAK
#else
#define HAS_PEAK (s->peak > 0.f)
#endif
#ifdef COUNTED
#define IS_COUNTED(v) COUNTED
#else
#define IS_COUNTED(v) ((v)->counted)
#endif
#ifdef CLASSED
#define IS_CLASSED(v) CLASSED
#else
#define IS_CLASSED(v) ((v)->classed)
#endif
#ifdef ALL_ISOTROPIC
#define IS_ISOTROPIC ALL_ISOTROPIC
#else
#define IS_ISOTROPIC (s->isotropic)
#define HAS_GROUND (s->surfaces.has_ground)
#endif
#ifndef CHANNELS
#define CHANNELS (s->channels)
#define SPECTRAL (s->spectral)
#endif
#ifdef WAVES
#define N_WAVES WAVES
#define CARRIED WAVES
#define EACH_WAVE(j) EACH(j, WAVES)
#else
#define N_WAVES (s->n_waves)
#define CARRIED MAX_WAVES
#define EACH_WAVE(j) for (int j = 0; j < s->carried; j++)
#endif

/* A medium of several wavelengths, whose alpha has a colour, too. */
#define COLOURED (N_WAVES > 1)

/* Where rays take steps, pass several volumes, or are chains of scatterings by a peak, lanes wait for each other, and what concerns a
 * vertex must be kept for those that do. */
#define TAKES_STEPS(v) (TRANSPORT_OF(v) != TRANSPORT_CONTINUOUS)
#define LANES_WAIT (N_VOLUMES > 1 || TAKES_STEPS(&s->volume[0]) || HAS_PEAK)
#define PUT(m, place, value) ((place) = LANES_WAIT ? SEL(m, value, place) : (value))
#define PUT3(m, place, value) ((place) = LANES_WAIT ? sel3(m, value, place) : (value))

#endif

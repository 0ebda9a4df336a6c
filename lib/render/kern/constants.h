/* constants - what a build may have as constants; the rest is as in the scene. In C the number of wavelengths and channels, and that a
 * medium is continuous and without a peak; in OpenCL all that many a branch depends on. */
#ifndef KERN_CONSTANTS_H
#define KERN_CONSTANTS_H

#include "render/kern/scene.h"

#ifdef TRANSPORT
#define TRANSPORT_OF(v) TRANSPORT
#else
#define TRANSPORT_OF(v) ((v)->transport)
#endif
#ifdef PEAK
#define HAS_PEAK(v) PEAK
#else
#define HAS_PEAK(v) ((v)->peak > 0.f)
#endif
#ifdef COUNTED
#define IS_ISOTROPIC(v) ALL_ISOTROPIC
#define IS_COUNTED(v) COUNTED
#else
#define IS_ISOTROPIC(v) ((v)->isotropic)
#define IS_COUNTED(v) ((v)->counted)
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

/* Where rays take steps, or chains of scatterings by a peak, lanes wait for each other, and what concerns a vertex must be kept for
 * those that do. */
#define TAKES_STEPS(v) (TRANSPORT_OF(v) != TRANSPORT_CONTINUOUS)
#define LANES_WAIT (TAKES_STEPS(&s->volume) || HAS_PEAK(&s->volume))
#define PUT(m, place, value) ((place) = LANES_WAIT ? SEL(m, value, place) : (value))
#define PUT3(m, place, value) ((place) = LANES_WAIT ? sel3(m, value, place) : (value))

#endif

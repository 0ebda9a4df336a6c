/* scene_setup - a scene and its medium made ready for the kernels, and the film that they fill. */
#ifndef RENDER_SCENE_SETUP_H
#define RENDER_SCENE_SETUP_H

#include "medium/medium.h"
#include "render/phase_sampler.h"
#include "render/bricks.h"
#include "render/kern/scene.h"
#include "render/scene_file.h"

#include <stddef.h>
#include <stdio.h>

struct job {
	struct scene scene;
	struct tables tables;
	/* elements of each table, in the order of struct tables */
	size_t n_extinction, n_disc, n_albedo, n_cap, n_colour, n_phase, n_interval, n_alias, n_angle, n_particle, n_first, n_brick, n_voxel, n_count,
		n_map, n_map_cdf;
	struct phase_sampler phase_sampler;      /* what is made here of the medium */
	struct bricks bricks;
	int64 *film;               /* [pixel][scene.film_sums], see kern/film.h */
	int overflow;              /* a sum went beyond the film's limit */
};

/* job_make - the tables point into the medium where they can. Dies when the wavelengths make no colour.
 * transport, attenuation, branches: as in the kernels' scene.h. */
void job_make(struct job *j, const struct scenefile *file, const struct medium *medium, int transport, int attenuation, int branches,
              uint32 seed);

/* job_film - an empty film; spectral: with sums for every wavelength. */
void job_film(struct job *j, int spectral);

/* job_finish - what can be told of the film's sums only when all samples are in. */
void job_finish(struct job *j);

void job_free(struct job *j);

/* render_c - add samples [first, first + n) of pixels [pixel, pixel + pixels) to the film, by the C build of the kernels for this processor: the widest
 * lanes that it has, unless MOTES_CPU in the environment asks for scalar, v2, v3 or v4. Dies where that is none of them, or more than
 * the processor has. The film does not depend on it. */
void render_c(struct job *j, uint32 pixel, uint32 pixels, uint32 first, uint32 n, int threads);

/* The same by OpenCL, whose device holds the tables and the film meanwhile. Each dies with one line on any failure. */
struct cl;
void cl_list(FILE *out);    /* a line a device: number, name, kind, platform, memory */
struct cl *cl_start(struct job *j, int device, int verbose);      /* -1: the first GPU, or else the first; verbose says which */
int cl_wide(const struct cl *c);   /* whether it wants very many pixels at once, as a GPU does */
void cl_render(struct cl *c, uint32 pixel, uint32 pixels, uint32 first, uint32 n);    /* of the pixels [pixel, pixel + pixels) */
void cl_finish(struct cl *c);      /* brings the film back */

#endif

/* scene_setup - a scene and its media made ready for the kernels. */
#ifndef RENDER_SCENE_SETUP_H
#define RENDER_SCENE_SETUP_H

#include "medium/medium.h"
#include "render/bricks.h"
#include "render/kern/scene.h"
#include "render/phase_sampler.h"
#include "render/scene_file.h"

#include <stddef.h>

#define TABLE_SIZE(type, name) size_t name;
struct table_sizes { TABLES(TABLE_SIZE, TABLE_SIZE) };
#define TABLE_ONE(type, name) + 1
enum { N_TABLES = TABLES(TABLE_ONE, TABLE_ONE) };

struct setup {
	struct scene scene;
	double origin[3];          /* of the kernels' coordinates, the middle of all media, in the scene's */
	struct tables tables[MAX_VOLUMES];
	struct table_sizes size[MAX_VOLUMES];    /* their elements, of 4 bytes */
	/* what is made here of the media, and tables that nobody else owns */
	struct phase_sampler sampler[MAX_VOLUMES];
	struct bricks bricks[MAX_VOLUMES];
	void *own[N_TABLES * MAX_VOLUMES];
	int n_own;
};

/* How to render a scene: see the kernels' scene.h. */
struct render_options {
	int transport[MAX_VOLUMES];    /* of each medium */
	int attenuation;
	int spectral;
	uint32 seed;
};

/* setup_make - medium[] are the file's, with the same wavelengths; the tables point into them and the file's map where they can. Dies when
 * the wavelengths make no colour. */
void setup_make(struct setup *u, const struct scenefile *file, const struct medium *const *medium, const struct render_options *options);

void setup_free(struct setup *u);

#endif

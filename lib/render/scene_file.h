/* scene_file - a scene as the user wrote it; scene(5). */
#ifndef RENDER_SCENE_FILE_H
#define RENDER_SCENE_FILE_H

#include "render/envmap.h"

struct sun {
	double direction[3];       /* the way the light travels */
	double irradiance[3];      /* perpendicular to the beam */
	double angle;              /* degrees across */
};

struct quad {
	double corner[3], edge[2][3];
	double radiance[3];        /* to the side of edge[0] x edge[1] */
};

/* A light, by its kind: LIGHT_SUN or LIGHT_QUAD (the map is apart: there is one at most). */
struct scene_light {
	int kind;
	union {
		struct sun sun;
		struct quad quad;
	};
};

struct scene_medium {
	char *file;                /* path, relative names resolved against the scene's folder */
	double position[3];
	int transport;             /* as kern/scene.h, or -1 where the scene does not say */
};

struct scenefile {
	double position[3], target[3], up[3], fov;     /* camera; fov in degrees along the longer side */
	int width, height;
	int n_media;
	struct scene_medium medium[MAX_VOLUMES];       /* as written */
	int has_ground;
	double ground_height, ground_albedo;
	double environment[3];     /* linear RGB, as all strengths */
	int n_lights;
	struct scene_light light[MAX_LIGHTS];    /* as written */
	struct envmap map;
	char *history;             /* one line: the scene in canonical form, without file names */
};

/* scene_transport - the names of transports, as kern/scene.h numbers them; NULL at the end. */
extern const char *const scene_transport[];

/* scenefile_read - read and check a scene ("-": standard input, whose folder is the current one); dies with its line on a misspelt or
 * missing key or a bad value. */
void scenefile_read(const char *path, struct scenefile *s);

void scenefile_free(struct scenefile *s);

#endif

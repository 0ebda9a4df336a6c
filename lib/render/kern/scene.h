/* scene - what the kernels are given, the same layout on host and device. Lengths in m, angles in rad, the medium's centre
 * at the origin. */
#ifndef KERN_SCENE_H
#define KERN_SCENE_H

#include "render/kern/compat.h"

#define MAX_WAVES 8      /* wavelengths carried by one path; a medium of more is divided into interleaved groups */
#define MAX_LIGHTS 16

enum { TRANSPORT_EXPLICIT, TRANSPORT_FAT_RAY, TRANSPORT_GRID, TRANSPORT_CONTINUOUS };
enum { ATTENUATION_PRODUCT, ATTENUATION_EXPONENTIAL };

enum { LIGHT_SUN, LIGHT_QUAD, LIGHT_MAP };

struct light {
	int kind;
	float rgb[3];              /* radiance, of a parallel sun irradiance; a map has its own */
	float at[3];               /* sun: unit vector to its centre; quad: corner */
	float cap;                 /* sun: 1 - cos of its angular radius; 0: parallel */
	float density;             /* sun: of the directions drawn over the disc, sr^-1; quad: of its points, m^-2 */
	float edge[2][3];          /* quad: from the corner */
	float dual[2][3];          /* quad: in its plane, dual[i] . edge[j] = 1 where i = j, else 0; m^-1 */
	float normal[3];           /* quad: unit vector to the side that shines */
};

struct scene {
	float eye[3], right[3], up[3], forward[3];   /* a ray leaves along forward + x right + y up, x and y in [-1, 1] */
	int width, height;
	uint32 seed;
	int transport, attenuation;
	float footprint;           /* area of a pixel on the plane 1 m ahead, m^2: what a fat ray covers */
	int n_waves, n_groups;
	int n_classes;             /* class n_classes is the mixture of the whole medium */
	int round;                 /* the medium fills a sphere of radius extent[0], else a box */
	float extent[3];
	float largest;             /* the largest disc: its squared radius, m^2 */
	int cells[3];              /* grid over the centres of the particles */
	float grid_low[3], grid_high[3], cell[3];
	int voxels[3];             /* counted: cubes of particles; else nodes of a density */
	int counted;
	float voxel_low[3], voxel_high[3], voxel[3];
	int has_ground;
	float ground_height, ground_albedo;
	float environment[3];      /* radiance, the same all around */
	int n_lights, n_drawn;     /* lights and quads; the first n_drawn shine and are drawn, each with probability pick */
	float pick;
	int map_width, map_height;
	float map_angle;           /* solid angle of a texel / sin of the polar angle of its centre, sr */
	struct light light[MAX_LIGHTS];
	int film_sums;             /* of a pixel: FILM_SUMS, and one a wavelength if spectral */
	int spectral;
	float depth_scale;         /* a power of 2: depths times this are below 1 */
};

struct tables {
	GLOBAL const float *extinction;  /* [wave] m^-1, of the whole medium; for a density grid, where it is 1 */
	GLOBAL const float *disc;        /* [class][wave] squared radius of the disc of area c_ext, m^2 */
	GLOBAL const float *albedo;      /* [class][wave] */
	GLOBAL const float *colour;      /* [wave][3] linear RGB of radiance 1 */
	GLOBAL const int *node;          /* [class][2] first node of the phase table, number of nodes */
	GLOBAL const float *theta;       /* [node] rad */
	GLOBAL const float *p;           /* [node][wave] sr^-1, linear in theta between nodes */
	GLOBAL const uint32 *cdf;        /* [node][wave] in units of 2^-32, the last node's 2^32 wrapped to 0 */
	GLOBAL const float *particle;    /* [particle][4] position m, the bits of the class; cell by cell */
	GLOBAL const uint32 *first;      /* [cell] its first particle; one more at the end */
	GLOBAL const float *voxel;       /* [voxel][wave] extinction, m^-1; or [node], density relative to extinction[] */
	GLOBAL const uint32 *count;      /* [voxel][class] particles */
	GLOBAL const float *map;         /* [row][column][3] radiance */
	GLOBAL const uint32 *map_cdf;    /* [row + 1] of the rows, then [row][column + 1] of each row's texels, in units of 2^-31 */
};

#endif

/* scene - what the kernels are given, the same layout on host and device. Lengths in m, angles in rad, the medium's centre
 * at the origin. */
#ifndef KERN_SCENE_H
#define KERN_SCENE_H

#include "render/kern/compat.h"

#define MAX_WAVES 8      /* wavelengths carried by one path; a medium of more is divided into interleaved groups */
#define MAX_LIGHTS 16

enum { TRANSPORT_EXPLICIT, TRANSPORT_CONTINUOUS };

struct light {                     /* a sun */
	float towards[3];          /* unit vector to its centre */
	float cap;                 /* 1 - cos of its angular radius; 0: parallel */
	float strength;            /* radiance, of a parallel sun irradiance */
	float density;             /* of the directions drawn over the disc, sr^-1 */
};

struct scene {
	float eye[3], right[3], up[3], forward[3];   /* a ray leaves along forward + x right + y up, x and y in [-1, 1] */
	int width, height;
	uint32 seed;
	int transport;
	int n_waves, n_groups;
	int n_classes;             /* class n_classes is the mixture of the whole medium */
	int round;                 /* the medium fills a sphere of radius extent[0], else a box */
	float extent[3];
	int cells[3];              /* grid over the discs of the particles */
	float grid_low[3], grid_high[3], cell[3];
	int has_ground;
	float ground_height, ground_albedo;
	float environment;         /* radiance */
	int n_lights;
	struct light light[MAX_LIGHTS];
	int film_sums;             /* of a pixel: FILM_SUMS, and one a wavelength if spectral */
	int spectral;
	float depth_scale;         /* a power of 2: depths times this are below 1 */
};

struct tables {
	GLOBAL const float *extinction;  /* [wave] m^-1, of the whole medium */
	GLOBAL const float *disc;        /* [class][wave] squared radius of the disc of area c_ext, m^2 */
	GLOBAL const float *disc_most;   /* [class] the largest over the wavelengths */
	GLOBAL const float *albedo;      /* [class][wave] */
	GLOBAL const float *colour;      /* [wave][3] linear RGB of radiance 1 */
	GLOBAL const int *node;          /* [class][2] first node of the phase table, number of nodes */
	GLOBAL const float *theta;       /* [node] rad */
	GLOBAL const float *p;           /* [node][wave] sr^-1, linear in theta between nodes */
	GLOBAL const uint32 *cdf;        /* [node][wave] in units of 2^-32, the last node's 2^32 wrapped to 0 */
	GLOBAL const float *particle;    /* [particle][4] position m, the bits of the class */
	GLOBAL const uint32 *first;      /* [cell] first of its references; one more at the end */
	GLOBAL const uint32 *reference;  /* particles whose disc may reach into the cell */
};

#endif

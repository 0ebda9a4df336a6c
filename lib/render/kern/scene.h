/* scene - what the kernels are given, the same layout on host and device: a camera, a medium, lights, surfaces, and tables. Lengths
 * in m, angles in rad, the middle of all media at the origin. */
#ifndef KERN_SCENE_H
#define KERN_SCENE_H

#include "render/kern/lane.h"

#define NONE (-1)
#define MAX_WAVES 8      /* wavelengths carried by one path; a medium of more is divided into interleaved groups */
#define MAX_LIGHTS 16    /* lights and surfaces each */
#define MAX_VOLUMES 8

struct camera {
	float right[3], up[3], forward[3];           /* a ray leaves along forward + x right + y up, x and y in [-1, 1] */
	float ahead;               /* it begins so far ahead of the eye along forward, m: at the eye, or where the scene begins for a */
	float from[3], across[3], rise[3];           /* far one, at from + x across + y rise */
	int width, height;
};

enum { TRANSPORT_EXPLICIT, TRANSPORT_FAT_RAY, TRANSPORT_GRID, TRANSPORT_CONTINUOUS };
enum { ATTENUATION_PRODUCT, ATTENUATION_EXPONENTIAL };

#define ANGLE_STEPS 256      /* of the first level of the index of angles */

/* Every table: its type, its name. LARGE ones grow with the medium or the map, and may be several buffers of a device. A volume has its
 * own of each; colours and maps are the first one's. */
#define TABLES(SMALL, LARGE) \
	SMALL(float, extinction)   /* [wave] m^-1, of the whole medium; for a density grid, where it is 1 */ \
	SMALL(float, disc_radius2) /* [class][wave] squared radius of the disc of area c_ext, m^2 */ \
	SMALL(float, albedo)       /* [class][wave] */ \
	SMALL(float, truncation)   /* [wave] sr^-1, what is above is the peak, see forward_peak.h; the peak is class n_classes + 1 */ \
	SMALL(float, colour)       /* [wave][6] linear RGB of radiance 1; the shares of a light's R, G and B in it */ \
	SMALL(int, phase)          /* [class][4] where its phase function stands in the next three, see phase.h */ \
	LARGE(float, interval)     /* [interval][4 + 2 wave] sin, cos, theta, width; for each wavelength p in sr^-1 and its slope */ \
	LARGE(int, alias)          /* [column][wave][2] threshold, the other interval */ \
	LARGE(int, angle)          /* [step][2] first part, number of parts; [part][2] interval, the bits of where the next begins */ \
	LARGE(float, particle)     /* [particle][4] position m, the bits of the class; cell by cell */ \
	LARGE(int, first)          /* [cell] its first particle; one more at the end */ \
	LARGE(int, brick)          /* [brick] the number of its voxels, or minus its distance to any that has some; see voxels.h */ \
	LARGE(float, voxel)        /* by brick: [voxel][wave] extinction, m^-1; or nodes of density relative to extinction[], or, where each \
	                              class has its own, [wave] nodes of extinction, m^-1 */ \
	LARGE(int, count)          /* [voxel][class] particles, row by row */ \
	LARGE(float, density)      /* [class][node] density, where each class has its own, in units that disc_radius2 has in it, too */ \
	LARGE(float, map)          /* [row][column][3] radiance */ \
	LARGE(int, map_cdf)        /* [row + 1] of the rows, then [row][column + 1] of each row's texels, in units of 2^-31 */
#define TABLE_PLACE(type, name) int name;
struct table_places { TABLES(TABLE_PLACE, TABLE_PLACE) };

/* A medium and the model by which rays pass it. */
struct volume {
	int transport, attenuation;
	int counted;               /* made of particles: voxels are cubes that count them, else the cells between the nodes of a density, */
	int classed;               /* of which each class may have its own */
	int n_classes;             /* class n_classes is the mixture of the whole medium */
	int only_class;            /* that scatters, or -1 where there are several */
	int absorbs;               /* and does not scatter; such volumes are the last */
	float centre[3];           /* of all that follows */
	int round;                 /* it fills a sphere of radius extent[0], else a box */
	float extent[3];
	/* particles: cylinders that query them, the grid over their centres */
	float fat_area;            /* cross-section of fat rays, m^2 */
	float largest, largest_inverse;           /* the largest disc: its squared radius, m^2; and 1 / that */
	float query_radius2;       /* squared radius of the cylinder that must hold a centre */
	float query_radius;        /* that radius, and what rounding may move a place in the grid */
	int cells[3];
	float grid_low[3], cell[3];
	float grid_centre[3], grid_reached[3];    /* that box and, around it, what the query reaches: half sizes */
	/* voxels */
	int voxels[3], bricks[3];
	float voxel_low[3], voxel[3], voxels_per_m[3];    /* the low end of the bricks, whose outermost have nothing in them */
	struct table_places at;    /* on a device its tables are in the same buffers as those of other volumes, from there on */
};

enum { LIGHT_SUN, LIGHT_QUAD, LIGHT_MAP };

/* A light that is drawn. */
struct light {
	int kind;
	int delta;                 /* parallel light: drawn, never met */
	int distant;               /* a shadow ray to it is long, and sent the more seldom the less is scattered that way */
	int spiky;                 /* so small that a peak makes spikes of it, see forward_peak.h */
	float rgb[3];              /* radiance, of delta light irradiance; a map has its own */
	float pick, until;         /* probability that it is the one drawn, and that it or one before it is */
	float pdf;                 /* with pick in it; sun: of the directions drawn over the disc, sr^-1; quad: of its points, m^-2 */
	float at[3], inverse[3];   /* sun: unit vector to its centre; 1 / that */
	float one_minus_cos;       /* sun: of its angular radius */
	int surface;               /* quad: whose front it is */
};

struct lights {
	float environment[3];      /* radiance, the same all around */
	int n;
	float map_pick;            /* the map's pick */
	int map_width, map_height;
	float map_angle;           /* solid angle of a texel / sin of the polar angle of its centre, sr */
	struct light light[MAX_LIGHTS];
};

/* A quad, which ends rays. */
struct surface {
	float corner[3], edge[2][3];
	float dual[2][3];          /* in its plane, dual[i] . edge[j] = 1 where i = j, else 0; m^-1 */
	float normal[3];           /* unit vector to its front */
	int light;                 /* that its front is, or NONE */
};

struct surfaces {
	int has_ground;
	float ground_height, ground_albedo;
	int n;
	struct surface surface[MAX_LIGHTS];
};

struct scene {
	struct camera camera;
	int n_volumes;
	struct volume volume[MAX_VOLUMES];
	int isotropic;             /* all phase functions are 1 / (4 pi) */
	float peak;                /* share of scattering that is above the truncation of a peaked phase function, 0: there is no peak; */
	float chain_scale;         /* 1 / -log(peak); of the first volume, the only one that scatters */
	struct lights lights;
	struct surfaces surfaces;
	uint32 seed;
	int n_waves, n_groups;
	int carried;               /* wavelengths of the largest group */
	int channels;              /* 3; 1 where red, green and blue are the same */
	int film_sums;             /* of a pixel: FILM_SUMS, and two a wavelength if spectral */
	int spectral;
	float depth_scale;         /* a power of 2: depths times this are below 1 */
};

#define TABLE_float FLOATS
#define TABLE_int INTS
#define TABLE_MEMBER(type, name) TABLE_##type name;
struct tables { TABLES(TABLE_MEMBER, TABLE_MEMBER) };

#endif

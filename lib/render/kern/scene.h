/* scene - what the kernels are given, the same layout on host and device. Lengths in m, angles in rad, the medium's centre
 * at the origin. */
#ifndef KERN_SCENE_H
#define KERN_SCENE_H

#include "render/kern/lane.h"

#define MAX_WAVES 8      /* wavelengths carried by one path; a medium of more is divided into interleaved groups */
#define MAX_LIGHTS 16

enum { TRANSPORT_EXPLICIT, TRANSPORT_FAT_RAY, TRANSPORT_GRID, TRANSPORT_CONTINUOUS };
enum { ATTENUATION_PRODUCT, ATTENUATION_EXPONENTIAL };

enum { LIGHT_SUN, LIGHT_QUAD, LIGHT_MAP };

struct light {
	int kind;
	float rgb[3];              /* radiance, of a parallel sun irradiance; a map has its own */
	float at[3];               /* sun: unit vector to its centre; quad: corner */
	float inverse[3];          /* sun: 1 / at */
	int small;                 /* sun: so small that a peak makes spikes of it, see path.h */
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
	float fat;                 /* cross-section of fat rays, m^2 */
	int n_waves, n_groups;
	int carried;               /* wavelengths of the largest group */
	int n_classes;             /* class n_classes is the mixture of the whole medium */
	int only_class;            /* that scatters, or -1 where there are several */
	int isotropic;             /* all phase functions are 1 / (4 pi) */
	int branches;              /* ways that a camera ray goes on from where the medium first scatters it */
	float branch_share;        /* 1 / branches */
	float peak;                /* share of scattering that is above the cap of a peaked phase function, 0: there is no peak */
	float detours;             /* 1 / -log(peak) */
	int round;                 /* the medium fills a sphere of radius extent[0], else a box */
	float extent[3];
	float largest, largest_inverse;       /* the largest disc: its squared radius, m^2; and 1 / that */
	int cells[3];              /* grid over the centres of the particles */
	float grid_low[3], cell[3];
	float grid_centre[3], grid_reached[3];    /* that box and, around it, what the query reaches: half sizes */
	float reach2;              /* squared radius of the cylinder that must hold a centre */
	float reach;               /* that radius, and what rounding may move a place in the grid */
	int counted;               /* voxels are cubes of particles, else the cells between the nodes of a density */
	int voxels[3], bricks[3];
	float voxel_low[3], voxel[3], voxels_per_m[3];    /* the low end of the bricks, whose outermost have nothing in them */
	int has_ground;
	float ground_height, ground_albedo;
	float environment[3];      /* radiance, the same all around */
	int n_lights, n_drawn;     /* lights and quads; the first n_drawn shine and are drawn, each with probability pick */
	float pick;
	int map_width, map_height;
	float map_angle;           /* solid angle of a texel / sin of the polar angle of its centre, sr */
	struct light light[MAX_LIGHTS];
	int channels;              /* 3; 1 where red, green and blue are the same */
	int film_sums;             /* of a pixel: FILM_SUMS, and one a wavelength if spectral */
	int spectral;
	float depth_scale;         /* a power of 2: depths times this are below 1 */
};

#define ANGLE_STEPS 256      /* of the first level of the index of angles */

struct tables {
	FLOATS extinction;  /* [wave] m^-1, of the whole medium; for a density grid, where it is 1 */
	FLOATS disc;        /* [class][wave] squared radius of the disc of area c_ext, m^2 */
	FLOATS albedo;      /* [class][wave] */
	FLOATS cap;         /* [wave] sr^-1, of the phase function where it has a peak, see path.h; the peak is class n_classes + 1 */
	FLOATS colour;      /* [wave][6] linear RGB of radiance 1; the shares of a light's R, G and B in it */
	INTS phase;         /* [class][4] where its phase function stands in the next three, see phase.h */
	FLOATS interval;    /* [interval][4 + 2 wave] sin, cos, theta, width; for each wavelength p in sr^-1 and its slope */
	INTS alias;         /* [column][wave][2] threshold, the other interval */
	INTS angle;         /* [step][2] first part, number of parts; [part][2] interval, the bits of where the next begins */
	FLOATS particle;    /* [particle][4] position m, the bits of the class; cell by cell */
	INTS first;         /* [cell] its first particle; one more at the end */
	INTS brick;         /* [brick] the number of its voxels, or minus its distance to any that has some; see voxels.h */
	FLOATS voxel;       /* by brick: [voxel][wave] extinction, m^-1; or nodes of density relative to extinction[] */
	INTS count;         /* [voxel][class] particles, row by row */
	FLOATS map;         /* [row][column][3] radiance */
	INTS map_cdf;       /* [row + 1] of the rows, then [row][column + 1] of each row's texels, in units of 2^-31 */
};

#endif

/* medium - a baked medium: optics by class and wavelength, phase functions, and the particles in their grid. Its arrays are those
 * of medium(5), of which medium_file has the readers and writers. */
#ifndef MEDIUM_MEDIUM_H
#define MEDIUM_MEDIUM_H

#include <stddef.h>
#include <stdint.h>

/* What the matter of a medium is: single particles, which cubes also count; or a field of relative density, of which the classes
 * have their expected numbers. */
enum medium_kind { MEDIUM_PARTICLES, MEDIUM_DENSITY };

struct medium {
	enum medium_kind kind;
	char *history;                  /* cmd lines as in tab(5) */
	double centre[3];               /* m, where the user's coordinates have the middle; all that follows is relative to it */
	int round;                      /* a sphere of radius half[0], else a box */
	double half[3];                 /* m */
	int n_waves, n_classes;
	double *wavelength;             /* [wave] um, ascending */
	double *radius;                 /* [class] um, ascending */
	double *count;                  /* [class] particles in the medium (expected, where none are given) */
	double *c_ext, *c_sca;          /* [class][wave] um^2 */
	size_t n_nodes;
	int32_t *node;                  /* [class][2] first node and number of nodes; class n_classes is the whole medium's mixture */
	float *theta;                   /* [node] rad */
	float *p;                       /* [node][wave] sr^-1, normalised */
	size_t n_particles;             /* of MEDIUM_PARTICLES, as is all to voxel_count */
	float *particle;                /* [particle][4] x y z m, the bits of an int32 class; in the order of the cells */
	int32_t cells[3];               /* the grid over the centres */
	float low[3], cell[3];          /* m */
	size_t n_first;
	uint32_t *first;                /* [cell] its first particle, and one more at the end */
	int32_t voxels[3];              /* of the finest level of cubes that count particles, or the nodes of the density */
	double voxel;                   /* m, side of these cubes */
	size_t n_voxel_count;
	uint32_t *voxel_count;          /* [level][voxel][class], finest level first; see particle_counts.h */
	size_t n_density;
	float *density;                 /* [z][y][x] of MEDIUM_DENSITY: relative density, see density.h; or [class][z][y][x], each class's own */
	double matter;                  /* m^3, integral of the density, or of each class's, over the medium */
	double *host;                   /* [wave] m^-1, absorption by what is between the particles; NULL: none */
};

/* medium_by_class - whether each class has a density of its own. */
int medium_by_class(const struct medium *m);

/* medium_volume - in m^3. */
double medium_volume(const struct medium *m);

/* medium_depth - mean optical depth along the shortest axis at the first wavelength. */
double medium_depth(const struct medium *m);

/* medium_even - is the density, or each class's, the same everywhere? Not of particles. */
int medium_even(const struct medium *m);

/* medium_free - one whose arrays are its own: a baked one, not one of a file (medium_file_close). */
void medium_free(struct medium *m);

#endif

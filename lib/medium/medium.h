/* medium - a baked medium: optics by class and wavelength, phase functions, and the particles in their grid; medium(5). */
#ifndef MEDIUM_MEDIUM_H
#define MEDIUM_MEDIUM_H

#include <stddef.h>
#include <stdint.h>

#define MEDIUM_CLASSES 4096
#define MEDIUM_WAVES 1024

struct medium {
	char *history;                  /* cmd lines as in tab(5) */
	int round;                      /* a sphere of radius half[0], else a box; centred on the origin */
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
	uint32_t *cdf;                  /* [node][wave], see phase_cdf */
	size_t n_particles;             /* 0: a medium without particles; the rest is then empty */
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
	float *density;                 /* [z][y][x] relative density of a medium without particles, see density.h */
	double matter;                  /* m^3, integral of the density over the medium */
	uint32_t crc;                   /* of an open file: what a history says of its content */
	void *map;
	size_t map_size;
};

/* medium_volume - in m^3. */
double medium_volume(const struct medium *m);

/* medium_depth - mean optical depth along the shortest axis at the first wavelength. */
double medium_depth(const struct medium *m);

/* medium_write - write a file (not standard output: it is mapped when read). Dies. */
void medium_write(const char *path, const struct medium *m);

/* medium_open - verify a file by one sequential read, map it and check its indices, so that the kernels can rely on
 * them, and the ranges of its values. Dies. */
void medium_open(const char *path, struct medium *m);

void medium_close(struct medium *m);

/* medium_free - one that is not of a file, whose arrays are its own. */
void medium_free(struct medium *m);

#endif

/* medium_layout - what the writer and the reader of medium(5) have to agree on: the arrays of the file, in their order. */
#ifndef MEDIUM_MEDIUM_LAYOUT_H
#define MEDIUM_MEDIUM_LAYOUT_H

#include "medium/medium.h"

#define MEDIUM_MAGIC "#?MOTES-MEDIUM 1\n"
#define MEDIUM_ALIGN 64      /* of each array, from the begin of the file */
#define MEDIUM_TRAILER 16    /* u64 file size, u32 CRC-32 of all before, u32 0 */

/* Each array's name in struct medium and in the file, its element, and how many there are. */
#define MEDIUM_SECTIONS(SECTION) \
	SECTION(wavelength, double, waves) \
	SECTION(radius, double, classes) \
	SECTION(count, double, classes) \
	SECTION(c_ext, double, classes * waves) \
	SECTION(c_sca, double, classes * waves) \
	SECTION(node, int32_t, 2 * (classes + 1)) \
	SECTION(theta, float, m->n_nodes) \
	SECTION(p, float, m->n_nodes * waves) \
	SECTION(particle, float, 4 * m->n_particles) \
	SECTION(first, uint32_t, m->n_first) \
	SECTION(voxel_count, uint32_t, m->n_voxel_count) \
	SECTION(density, float, m->n_density)

#define MEDIUM_SECTION_NUMBER(name, type, n) SECTION_##name,
enum medium_section { MEDIUM_SECTIONS(MEDIUM_SECTION_NUMBER) N_SECTIONS };
#undef MEDIUM_SECTION_NUMBER

struct medium_layout {
	const char *name;
	size_t offset, size;     /* of the pointer in struct medium; of an element */
};

/* An array that files of before have in front of that of particles: 4 bytes an element of p. Nobody needs it. */
#define MEDIUM_FORMER "cdf"

extern const struct medium_layout medium_layout[N_SECTIONS];

/* medium_layout_counts - elements of each array, n[N_SECTIONS]. */
void medium_layout_counts(const struct medium *m, uint64_t *n);

#endif

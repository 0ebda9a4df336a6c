/* npy - density grids as NumPy arrays: C order, little-endian, shape [z][y][x], or [class][z][y][x]. */
#ifndef FORMAT_NPY_H
#define FORMAT_NPY_H

#include <stddef.h>

struct npy_grid {
	size_t nx, ny, nz;
	float *v;                /* v[(z * ny + y) * nx + x], finite, >= 0; from malloc. Of several classes one after the other. */
};

/* npy_density - read a whole grid of |u1 (value/255), <f4 or <f8; "-" is standard input. *classes: how many there are, 1 of three
 * dimensions; NULL: these alone are taken.
 * Dies on anything else: other types or orders, damage, bytes missing or left over, values negative or not finite as floats. */
struct npy_grid npy_density(const char *path, size_t *classes);

#endif

/* envmap - an environment map: latitude and longitude, and how the kernels draw from it. */
#ifndef RENDER_ENVMAP_H
#define RENDER_ENVMAP_H

#include "render/kern/scene.h"

struct envmap {
	int width, height;         /* 0: there is none */
	float *rgb;                /* [row][column][3] radiance; top row +y, centre column -z, columns turn towards +x */
	double scale[3];           /* by which the file's texels were multiplied */
	uint32 crc;                /* of the texels as they were read: what a history says of it */
};

/* envmap_read - an EXR file with the channels R, G and B, or Y alone, times a scale; dies on a texel that is negative or not finite. */
void envmap_read(const char *path, const double *scale, struct envmap *m);

/* envmap_cdf - the integrals by which texels are drawn, as struct tables has them: in proportion to luminance x solid angle, each
 * probability a multiple of 2^-31. Returns their number, 0 for a map that is black. */
size_t envmap_cdf(const struct envmap *m, uint32 **cdf);

/* envmap_fluence - the luminance of its light from all sides: the integral over the sphere. */
double envmap_fluence(const struct envmap *m);

#endif

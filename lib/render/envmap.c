#include "render/envmap.h"

#include "base/die.h"
#include "format/exr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

void envmap_read(const char *path, const double *scale, struct envmap *m)
{
	static const char *const names[] = { "R", "G", "B" };
	struct exr image;
	exr_read(path, &image);
	size_t n = (size_t)image.width * (size_t)image.height;
	m->width = image.width;
	m->height = image.height;
	m->rgb = xalloc(n, 3 * sizeof *m->rgb);
	m->crc = 0;
	memcpy(m->scale, scale, sizeof m->scale);
	for (size_t c = 0; c < 3; c++) {
		const struct exr_channel *from = exr_find(&image, names[c]);
		if (!from && !exr_find(&image, "R") && !exr_find(&image, "G") && !exr_find(&image, "B"))
			from = exr_find(&image, "Y");
		if (!from || from->is_uint)
			die(path, "needs channels R, G, B, or Y alone, of floats");
		for (size_t i = 0; i < n; i++) {
			float v = (float)(from->data[i] * scale[c]);
			if (!(from->data[i] >= 0 && isfinite(v)))
				die(path, "channel %s is %g at column %zu, row %zu (from 0); radiance is finite and not negative", from->name,
				    from->data[i], i % (size_t)image.width, i / (size_t)image.width);
			m->rgb[3 * i + c] = v;
		}
		for (size_t row = 0; row < (size_t)m->height; row++)
			m->crc = (uint32)crc32(m->crc, (const unsigned char *)&from->data[row * (size_t)m->width], (uInt)m->width * 4);
	}
	exr_free(&image);
}

/* Weights to their integral, in units of 2^-31; even where all are 0, since that is not drawn. */
static double integrate(size_t n, const double *weight, uint32 *cdf)
{
	double sum = 0, part = 0;
	for (size_t i = 0; i < n; i++)
		sum += weight[i];
	for (size_t i = 0; i < n; i++) {
		cdf[i] = (uint32)llrint(0x1p31 * fmin(1, sum > 0 ? part / sum : (double)i / (double)n));
		part += weight[i];
	}
	cdf[n] = 1u << 31;
	return sum;
}

double envmap_fluence(const struct envmap *m)
{
	double sum = 0;
	for (int r = 0; r < m->height; r++)
		for (int c = 0; c < m->width; c++) {
			const float *texel = m->rgb + 3 * ((size_t)r * (size_t)m->width + (size_t)c);
			sum += (0.2126 * texel[0] + 0.7152 * texel[1] + 0.0722 * texel[2]) * sin(M_PI * (r + 0.5) / m->height);
		}
	return sum * 2 * M_PI * M_PI / m->width / m->height;
}

size_t envmap_cdf(const struct envmap *m, uint32 **cdf)
{
	size_t width = (size_t)m->width, height = (size_t)m->height, n = height + 1 + height * (width + 1);
	double *row = xalloc(height, sizeof *row), *weight = xalloc(width, sizeof *weight);
	*cdf = xalloc(n, sizeof **cdf);
	for (size_t r = 0; r < height; r++) {
		for (size_t c = 0; c < width; c++) {
			const float *texel = m->rgb + 3 * (r * width + c);
			weight[c] = 0.2126 * texel[0] + 0.7152 * texel[1] + 0.0722 * texel[2];
		}
		row[r] = integrate(width, weight, *cdf + height + 1 + r * (width + 1)) * sin(M_PI * ((double)r + 0.5) / (double)height);
	}
	double all = integrate(height, row, *cdf);
	free(row);
	free(weight);
	return all > 0 ? n : 0;
}

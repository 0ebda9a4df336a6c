#include "format/png.h"

#include "base/die.h"
#include "base/out.h"
#include "base/standard.h"

#include <math.h>
#include <png.h>
#include <stdint.h>
#include <stdlib.h>

/* IEC 61966-2-1. */
static double srgb(double v)
{
	return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
}

static unsigned level(float v, unsigned top)
{
	if (!(v > 0))
		return 0;
	return v >= 1 ? top : (unsigned)(srgb(v) * top + 0.5);
}

static void failed(png_structp png, const char *what)
{
	die(png_get_error_ptr(png), "cannot write: %s", what);
}

static void silent(png_structp png, const char *what)
{
	(void)png, (void)what;
}

void png_write_srgb(const char *path, int width, int height, const float *rgb, int bits)
{
	char *name = xtext("%s", standard_output(path));
	struct out out = out_open(path, 1);
	png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, name, failed, silent);
	png_infop info = png ? png_create_info_struct(png) : NULL;
	if (!info)
		die(NULL, "out of memory");
	png_init_io(png, out.f);
	png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, bits, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
	             PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
	png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
	png_write_info(png, info);
	size_t n = 3 * (size_t)width;
	unsigned char *row = xalloc(n, (size_t)bits / 8);
	for (int y = 0; y < height; y++) {
		for (size_t i = 0; i < n; i++) {
			unsigned v = level(rgb[(size_t)y * n + i], bits == 16 ? 65535 : 255);
			if (bits == 16) {
				row[2 * i] = (unsigned char)(v >> 8);     /* big-endian, whatever the machine */
				row[2 * i + 1] = (unsigned char)v;
			} else {
				row[i] = (unsigned char)v;
			}
		}
		png_write_row(png, row);
	}
	png_write_end(png, info);
	png_destroy_write_struct(&png, &info);
	free(row);
	free(name);
	out_close(&out);
}

/* png - 8- or 16-bit sRGB images, by libpng. */
#ifndef FORMAT_PNG_H
#define FORMAT_PNG_H

/* png_write_srgb - write linear rgb[height][width][3] (1 = white), sRGB-encoded and clipped to [0, 1].
 * Given: path  file, or NULL or "-" for standard output
 *        bits  8 or 16
 * Dies on failure. */
void png_write_srgb(const char *path, int width, int height, const float *rgb, int bits);

#endif

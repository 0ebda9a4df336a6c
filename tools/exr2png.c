/* exr2png - a picture to look at: linear light to sRGB. */
#include "base/die.h"
#include "base/opt.h"
#include "base/standard.h"
#include "format/exr.h"
#include "format/png.h"

#include <math.h>
#include <stdlib.h>

static const struct exr_channel *channel(const struct exr *image, const char *path, const char *name)
{
	const struct exr_channel *c = exr_find(image, name);
	if (c && c->is_uint)
		die(path, "channel %s holds integers, not light", name);
	return c;
}

int main(int argc, char **argv)
{
	const char *output = NULL;
	double exposure = 0;
	int bits = 0;
	const struct opt opts[] = {
		{ "--exposure", OPT_REAL, &exposure, -60, 60, "STOPS", "multiply the light by 2^STOPS", 0 },
		{ "--bits", OPT_CHOICE, &bits, 0, 0, "16|8", "bits a channel", 0 },
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [IMAGE.exr]", "Turn an OpenEXR image into a PNG in sRGB.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one image at most");
	const char *path = standard_input(args.n ? args.operand[0] : NULL);

	struct exr image;
	exr_read(args.n ? args.operand[0] : NULL, &image);
	static const char *const names[] = { "R", "G", "B" };
	const struct exr_channel *grey = channel(&image, path, "Y"), *c[3];
	for (int i = 0; i < 3; i++)
		c[i] = channel(&image, path, names[i]);
	if (!c[0] && !c[1] && !c[2])
		c[0] = c[1] = c[2] = grey;
	if (!c[0] || !c[1] || !c[2])
		die(path, "has neither channels R, G, B nor a channel Y");

	size_t n = (size_t)image.width * (size_t)image.height;
	float scale = (float)exp2(exposure), *rgb = xalloc(n, 3 * sizeof *rgb);
	for (size_t p = 0; p < n; p++)
		for (int i = 0; i < 3; i++) {
			if (isnan(c[i]->data[p]))
				die(path, "channel %s is not a number at column %zu, row %zu (from 0)", c[i]->name,
				    p % (size_t)image.width, p / (size_t)image.width);
			rgb[3 * p + (size_t)i] = c[i]->data[p] * scale;
		}
	png_write_srgb(output, image.width, image.height, rgb, bits ? 8 : 16);
	free(rgb);
	exr_free(&image);
	return 0;
}

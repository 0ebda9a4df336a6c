/* channels min|mean|max|rms|error FILE CHANNEL.. [+|- FILE CHANNEL..]..: of each channel, plus or minus those in its place of further files, that
 * over all pixels, in one line; error: the rms over the root of the number of pixels, of the mean's error where each pixel has its own.
 * For the shell tests, which ask hundreds of times. */
#include "base/die.h"
#include "format/exr.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct statistics {
	double min, max, sum, squares;
	size_t n;
};

static void take(struct statistics *s, double v)
{
	if (!isfinite(v))
		die(NULL, "a pixel is %g", v);
	s->min = fmin(s->min, v);
	s->max = fmax(s->max, v);
	s->sum += v;
	s->squares += v * v;
	s->n++;
}

static double told(const struct statistics *s, const char *what)
{
	if (!strcmp(what, "min"))
		return s->min;
	if (!strcmp(what, "max"))
		return s->max;
	if (!strcmp(what, "mean"))
		return s->sum / (double)s->n;
	if (!strcmp(what, "rms"))
		return sqrt(s->squares / (double)s->n);
	if (!strcmp(what, "error"))
		return sqrt(s->squares) / (double)s->n;
	die(what, "is none of min, mean, max, rms, error");
}

static const struct exr_channel *channel(const struct exr *image, const char *path, const char *name)
{
	const struct exr_channel *c = exr_find(image, name);
	if (!c || c->is_uint)
		die(path, "has no channel %s of numbers", name);
	return c;
}

int main(int argc, char **argv)
{
	int n = 0, words = argc - 1;    /* channels of a file; words of all files, each but the first after a sign */
	while (n + 3 < argc && strcmp(argv[n + 3], "+") && strcmp(argv[n + 3], "-"))
		n++;
	if (n == 0 || words % (n + 2))
		die(NULL, "needs what to tell, and as many channels of each file");
	int files = words / (n + 2);
	struct exr *image = xalloc((size_t)files, sizeof *image);
	char **word[files];             /* sign or what, FILE, CHANNEL.. */
	for (int f = 0; f < files; f++) {
		word[f] = argv + 1 + f * (n + 2);
		exr_read(word[f][1], &image[f]);
		if (image[f].width != image->width || image[f].height != image->height)
			die(word[f][1], "is of another size");
	}
	for (int c = 0; c < n; c++) {
		struct statistics s = { INFINITY, -INFINITY, 0, 0, 0 };
		const float *data[files];
		for (int f = 0; f < files; f++)
			data[f] = channel(&image[f], word[f][1], word[f][2 + c])->data;
		for (size_t p = 0; p < (size_t)image->width * (size_t)image->height; p++) {
			double v = data[0][p];
			for (int f = 1; f < files; f++)
				v += word[f][0][0] == '-' ? -(double)data[f][p] : (double)data[f][p];
			take(&s, v);
		}
		printf("%s%.9g", c ? " " : "", told(&s, argv[1]));
	}
	putchar('\n');
	for (int f = 0; f < files; f++)
		exr_free(&image[f]);
	free(image);
	return 0;
}

/* block_means A.exr B.exr CHANNEL: for each block of 8 x 8 pixels the mean of two renderings from different seeds, and its variance, which the
 * differences of their pixels tell. */
#include "base/die.h"
#include "format/exr.h"

#include <stdio.h>

#define SIDE 8

int main(int argc, char **argv)
{
	static struct exr image[2];
	const float *data[2];
	if (argc != 4)
		die(NULL, "needs two images and a channel");
	for (int i = 0; i < 2; i++) {
		exr_read(argv[1 + i], &image[i]);
		const struct exr_channel *c = exr_find(&image[i], argv[3]);
		if (!c || image[i].width != image->width || image[i].height != image->height || image[i].width % SIDE || image[i].height % SIDE)
			die(argv[1 + i], "has no %s, or no such size", argv[3]);
		data[i] = c->data;
	}
	for (int y = 0; y < image->height; y += SIDE)
		for (int x = 0; x < image->width; x += SIDE) {
			double sum = 0, squares = 0;
			for (int p = 0; p < SIDE * SIDE; p++) {
				int at = (y + p / SIDE) * image->width + x + p % SIDE;
				double a = data[0][at], b = data[1][at];
				sum += a + b;
				squares += (a - b) * (a - b);
			}
			/* (a - b)^2 is twice the variance of each, on average: a quarter of it that of their mean */
			printf("%.9g %.9g\n", sum / (2 * SIDE * SIDE), squares / (4.0 * SIDE * SIDE * SIDE * SIDE));
		}
	exr_free(&image[0]);
	exr_free(&image[1]);
	return 0;
}

/* How far alpha of each channel and each wavelength of a spectral image is from what is missing of white light there; then the mean of alpha
 * at each, by name. For cli/film.t. */
#include "base/die.h"
#include "format/exr.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv)
{
	if (argc != 2)
		return 2;
	static struct exr e;
	double worst = 0;
	int n = 0;
	exr_read(argv[1], &e);
	for (int i = 0; i < e.n; i++) {
		const char *name = e.channel[i].name;
		int wave = !strncmp(name, "A.", 2), colour = name[0] == 'A' && strlen(name) == 2;
		if (!wave && !colour)
			continue;
		char *light = wave ? xtext("S0%s", name + 1) : xtext("%s", name + 1);
		const struct exr_channel *seen = exr_find(&e, light);
		if (!seen)
			die(argv[1], "lacks %s", light);
		double mean = 0, pixels = (double)e.width * e.height;
		for (size_t p = 0; p < (size_t)pixels; p++) {
			worst = fmax(worst, fabs((double)seen->data[p] + (double)e.channel[i].data[p] - 1));
			mean += e.channel[i].data[p] / pixels;
		}
		printf("%s %.6f\n", name, mean);
		free(light);
		n++;
	}
	printf("worst %.3g\n", n ? worst : 1);
	exr_free(&e);
	return 0;
}

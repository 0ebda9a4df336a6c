/* How far the red, green and blue of a spectral image are from the colours of its wavelengths; fails where that is more than rounding.
 * For cli/film.t. */
#include "base/die.h"
#include "format/exr.h"
#include "render/colour.h"

#include <math.h>
#include <stdio.h>

int main(int argc, char **argv)
{
	if (argc != 2)
		return 2;
	const char *path = argv[1];
	static struct exr e;
	static const char *const rgb[] = { "R", "G", "B" };
	double wavelength[64], worst = 0;
	const struct exr_channel *wave[64];
	float weight[64][3];
	int n = 0;
	exr_read(path, &e);
	for (int i = 0; i < e.n && n < 64; i++) {
		int whole, part;
		if (sscanf(e.channel[i].name, "S0.%d,%6dnm", &whole, &part) == 2) {
			wavelength[n] = (whole + part * 1e-6) / 1000;
			wave[n++] = &e.channel[i];
		}
	}
	if (colour_weights(n, wavelength, weight))
		die(path, "no colour");
	for (size_t p = 0; p < (size_t)e.width * (size_t)e.height; p++)
		for (int c = 0; c < 3; c++) {
			double sum = 0, size = 1e-3, got = exr_find(&e, rgb[c])->data[p];
			for (int w = 0; w < n; w++) {
				sum += (double)weight[w][c] * wave[w]->data[p];
				size += fabs((double)weight[w][c] * wave[w]->data[p]);
			}
			worst = fmax(worst, fabs(sum - got) / size);
		}
	printf("%d wavelengths: %.2g\n", n, worst);
	return !(n && worst < 1e-6);
}

#include "render/colour.h"

#include <math.h>

static double lobe(double nm, double centre, double below, double above)
{
	double t = (nm - centre) * (nm < centre ? below : above);
	return exp(-0.5 * t * t);
}

/* Colour matching functions: Wyman et al. 2013, "Simple analytic approximations to the CIE XYZ color matching functions",
 * multi-lobe form; within 0.01 of the 2 degree observer. */
static void matching(double nm, double xyz[3])
{
	xyz[0] = 0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323)
	    - 0.065 * lobe(nm, 501.1, 0.0490, 0.0382);
	xyz[1] = 0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322);
	xyz[2] = 1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725);
}

const char *colour_weights(int n, const double *wavelength, float (*rgb)[3])
{
	/* Inverse of the matrix of the sRGB primaries; its rows' dot products with white are 1 before rounding. */
	static const double to_rgb[3][3] = { { 3.2404542, -1.5371385, -0.4985314 }, { -0.9692660, 1.8760108, 0.0415560 },
		{ 0.0556434, -0.2040259, 1.0572252 } };
	static const double white[3] = { 0.95047, 1.0, 1.08883 };
	double sum[3] = { 0, 0, 0 }, xyz[3];
	if (n <= 3) {
		for (int i = 0; i < n; i++)
			for (int c = 0; c < 3; c++)
				rgb[i][c] = n == 1 || n - 1 - i == c * (n - 1) / 2.0 ? 1.f : n == 2 && c == 1 ? 0.5f : 0.f;
		return 0;
	}
	for (int pass = 0; pass < 2; pass++)
		for (int i = 0; i < n; i++) {
			double width = (wavelength[i + 1 < n ? i + 1 : i] - wavelength[i > 0 ? i - 1 : i]) / 2;
			matching(wavelength[i] * 1000, xyz);
			if (!pass) {
				for (int c = 0; c < 3; c++)
					sum[c] += width * xyz[c];
				continue;
			}
			for (int c = 0; c < 3; c++) {
				double value = 0, of_white = 0;
				for (int k = 0; k < 3; k++) {
					value += to_rgb[c][k] * white[k] * width * xyz[k] / sum[k];
					of_white += to_rgb[c][k] * white[k];
				}
				rgb[i][c] = (float)(value / of_white);
			}
		}
	for (int c = 0; c < 3; c++)
		if (!(sum[c] > 1e-9))
			return "four wavelengths or more make a colour, but too few of them are visible";
	return 0;
}

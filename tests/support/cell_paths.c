/* A field whose drops differ in size from cell to cell, and light paths through it by the simplest method there is: flights by Woodcock's
 * rejection in doubles, one wavelength at a time, scattering until a path leaves. Nothing is shared with the renderer.
 *
 * usage: cell_paths field >FIELD.npy      densities [class][z][y][x]
 *        cell_paths xsect >XSECT.txt      cross sections, for txttab
 *        cell_paths phase >PHASE.txt      phase functions of Henyey and Greenstein
 *        cell_paths mean N SEED           for each wavelength the mean over the image, and its standard error, of N paths */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 64                /* cells along the cube of side 2 m */
#define CLASSES 5
#define WAVES 3
#define DENSEST 6.             /* extinction at 0.55 um, m^-1 */
#define CONCENTRATION 1e6      /* m^-3 a class where its density is 1: weights 1 / CLASSES of five times as many */

static const double radius[CLASSES] = { 4, 8, 12, 16, 20 }, wavelength[WAVES] = { 0.45, 0.55, 0.65 };

/* um^2; the wavelengths differ the more the smaller the drops are */
static double c_ext(int k, int w) { return 1e6 * (0.6 + 0.1 * k) * (1 + (0.25 - 0.04 * k) * (w - 1)); }
static double albedo(int k, int w) { return 0.99 - 0.04 * k - 0.02 * w; }
static double asymmetry(int k, int w) { return 0.3 + 0.12 * k - 0.03 * w; }

static float field[CLASSES][SIDE][SIDE][SIDE];

/* Of a cell's extinction (0.55 um) and effective radius, blended linearly between the radii of the classes. */
static void make(void)
{
	for (int z = 0; z < SIDE; z++)
		for (int y = 0; y < SIDE; y++)
			for (int x = 0; x < SIDE; x++) {
				double u = (x + 0.5) / SIDE, v = (y + 0.5) / SIDE, t = (z + 0.5) / SIDE;
				double wave = sin(9 * u + 2 * sin(7 * v)) * cos(8 * t + 3 * u), sigma = DENSEST * fmax(0, 0.3 + 0.7 * wave);
				double r = 4 + 16 * fmin(1, fmax(0, 0.9 * v + 0.2 * sin(20 * u) * sin(17 * t)));
				int k = (int)fmin(CLASSES - 2, (r - radius[0]) / 4);
				double share = (r - radius[k]) / (radius[k + 1] - radius[k]);
				field[k][z][y][x] = (float)((1 - share) * sigma / (c_ext(k, 1) * 1e-12 * CONCENTRATION));
				field[k + 1][z][y][x] = (float)(share * sigma / (c_ext(k + 1, 1) * 1e-12 * CONCENTRATION));
			}
}

static uint64_t state;
static double draw(void)       /* splitmix64 */
{
	uint64_t z = state += 0x9e3779b97f4a7c15u;
	z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
	z = (z ^ z >> 27) * 0x94d049bb133111ebu;
	return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

/* Number densities at a point of the cube, trilinear between the centres of cells, m^-3. */
static void numbers(const double *at, double *n)
{
	int low[3], high[3];
	double share[3];
	for (int a = 0; a < 3; a++) {
		double place = fmin(fmax((at[a] + 1) / 2 * SIDE - 0.5, 0), SIDE - 1);
		low[a] = (int)fmin(place, SIDE - 2);
		high[a] = low[a] + 1;
		share[a] = place - low[a];
	}
	for (int k = 0; k < CLASSES; k++) {
		n[k] = 0;
		for (int c = 0; c < 8; c++) {
			double weight = (c & 1 ? share[0] : 1 - share[0]) * (c & 2 ? share[1] : 1 - share[1]) * (c & 4 ? share[2] : 1 - share[2]);
			n[k] += weight * field[k][c & 4 ? high[2] : low[2]][c & 2 ? high[1] : low[1]][c & 1 ? high[0] : low[0]];
		}
		n[k] *= CONCENTRATION;
	}
}

static int inside(const double *p) { return fabs(p[0]) <= 1 && fabs(p[1]) <= 1 && fabs(p[2]) <= 1; }

/* The path's light: radiance 1 from half of all directions, above and behind the camera, 0 from the others. */
static double path(int w)
{
	double at[3], along[3] = { 0, 0, -1 }, majorant = 0;
	for (int k = 0; k < CLASSES; k++)      /* at most the densest cell's, whatever its drops */
		majorant = fmax(majorant, DENSEST * c_ext(k, w) / c_ext(k, 1) * 1.05);
	/* the camera: far away on z, its image as wide as 1.5 m at the cube's middle */
	at[0] = 1.5 * (draw() - 0.5);
	at[1] = 1.5 * (draw() - 0.5);
	at[2] = 1;
	while (1) {
		double step = -log(1 - draw()) / majorant, n[CLASSES], all = 0, u, sum = 0;
		int k = 0;
		for (int a = 0; a < 3; a++)
			at[a] += step * along[a];
		if (!inside(at))
			return along[1] + 0.5 * along[2] > 0;
		numbers(at, n);
		for (int j = 0; j < CLASSES; j++)
			all += n[j] * c_ext(j, w) * 1e-12;
		u = draw() * majorant;
		if (u >= all)
			continue;
		for (sum = n[0] * c_ext(0, w) * 1e-12; k < CLASSES - 1 && sum <= u;)
			k++, sum += n[k] * c_ext(k, w) * 1e-12;
		if (draw() >= albedo(k, w))
			return 0;
		double g = asymmetry(k, w), s = (1 - g * g) / (1 - g + 2 * g * draw()), cosine = (1 + g * g - s * s) / (2 * g);
		double sine = sqrt(fmax(0, 1 - cosine * cosine)), phi = 2 * M_PI * draw(), x[3], y[3], turned[3];
		int least = fabs(along[0]) < fabs(along[1]) ? 0 : 1;
		double e[3] = { least == 0, least == 1, 0 }, d = along[least], length = sqrt(1 - d * d);
		for (int a = 0; a < 3; a++)
			x[a] = (e[a] - d * along[a]) / length;
		for (int a = 0; a < 3; a++)
			y[a] = along[(a + 1) % 3] * x[(a + 2) % 3] - along[(a + 2) % 3] * x[(a + 1) % 3];
		for (int a = 0; a < 3; a++)
			turned[a] = cosine * along[a] + sine * (cos(phi) * x[a] + sin(phi) * y[a]);
		memcpy(along, turned, sizeof along);
	}
}

int main(int argc, char **argv)
{
	const char *what = argc > 1 ? argv[1] : "";
	make();
	if (!strcmp(what, "field")) {
		char header[118];
		memset(header, ' ', sizeof header);
		int n = snprintf(header, sizeof header, "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d, %d, %d), }", CLASSES, SIDE, SIDE, SIDE);
		header[n] = ' ';
		header[117] = '\n';
		fwrite("\x93NUMPY\x01\x00\x76\x00", 1, 10, stdout);
		fwrite(header, 1, sizeof header, stdout);
		fwrite(field, sizeof field, 1, stdout);
	} else if (!strcmp(what, "xsect")) {
		printf("# wavelength:f64:um\tradius:f64:um\tc_ext:f64:um^2\tc_sca:f64:um^2\n");
		for (int w = 0; w < WAVES; w++)
			for (int k = 0; k < CLASSES; k++)
				printf("%g\t%g\t%.17g\t%.17g\n", wavelength[w], radius[k], c_ext(k, w), albedo(k, w) * c_ext(k, w));
	} else if (!strcmp(what, "phase")) {
		printf("# wavelength:f64:um\tradius:f64:um\ttheta:f64:deg\tp:f64:sr^-1\n");
		for (int w = 0; w < WAVES; w++)
			for (int k = 0; k < CLASSES; k++)
				for (int i = 0; i <= 1800; i++) {
					double g = asymmetry(k, w), theta = 180 * pow(i / 1800., 2), half = sin(theta * M_PI / 360);
					printf("%g\t%g\t%.17g\t%.17g\n", wavelength[w], radius[k], theta,
					       (1 - g * g) / (4 * M_PI * pow((1 - g) * (1 - g) + 4 * g * half * half, 1.5)));
				}
	} else if (!strcmp(what, "mean") && argc == 4) {
		for (int w = 0; w < WAVES; w++) {
			long n = atol(argv[2]);
			double sum = 0, squares = 0;
			state = (uint64_t)atol(argv[3]) * 1000003u + (uint64_t)w;
			for (long i = 0; i < n; i++) {
				double v = path(w);
				sum += v;
				squares += v * v;
			}
			printf("%.6f %.2g\n", sum / (double)n, sqrt((squares / (double)n - pow(sum / (double)n, 2)) / (double)n));
		}
	} else {
		return 2;
	}
	return 0;
}

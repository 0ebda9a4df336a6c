/* The film's integers are exact. With an argument, a spectral image: how far its red, green and blue are from the colours of its
 * wavelengths. With c or opencl and a scene: a film is read and written in mid-run (both used by film.t). */
#include "base/die.h"
#include "format/exr.h"
#include "medium/medium_file.h"
#include "render/backend.h"
#include "render/colour.h"
#include "render/image.h"
#include "render/kern/film.h"
#include "support/tap.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int colours(const char *path)
{
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

static void write_image(const char *path, const struct setup *u, const struct film *f, const struct medium *m, int samples)
{
	struct image image;
	struct out out = out_open(path, 1);
	image_of(&image, &u->scene, f, m, 0, samples, 0, "", "film");
	image_write(&out, &image, 1);
	image_free(&image);
}

/* Four samples, read twice and written twice, as half1.exr and half2.exr; then four more, on the same device, as whole.exr. Returns
 * whether the film is what it was after the first reading, and in the end what C makes of all samples in one go. */
static int mid_run(int opencl, const char *path)
{
	struct scenefile file;
	struct medium_file baked;
	struct setup u;
	struct film f, once, all;
	scenefile_read(path, &file);
	medium_file_open(file.medium, &baked);
	setup_make(&u, &file, &baked.medium, &(struct render_options){ .transport = TRANSPORT_EXPLICIT, .branches = 1, .seed = 1 });
	film_make(&f, &u.scene);
	film_make(&once, &u.scene);
	film_make(&all, &u.scene);
	uint32 pixels = (uint32)(f.width * f.height);
	size_t size = pixels * (size_t)f.n_sums * sizeof *f.sum;
	render_c(&u, &all, 0, pixels, 0, 8, 1);
	struct cl *cl = opencl ? cl_start(&u, &f, -1, 0) : NULL;
	for (uint32 half = 0; half < 2; half++) {
		if (cl) {
			cl_render(cl, 0, pixels, 4 * half, 4);
			cl_read(cl, &f);
		} else {
			render_c(&u, &f, 0, pixels, 4 * half, 4, 1);
		}
		if (half)
			break;
		memcpy(once.sum, f.sum, size);
		write_image("half1.exr", &u, &f, &baked.medium, 4);
		if (cl)
			cl_read(cl, &f);
		write_image("half2.exr", &u, &f, &baked.medium, 4);
		if (!film_holds(&f) || memcmp(once.sum, f.sum, size))
			return 1;
	}
	write_image("whole.exr", &u, &f, &baked.medium, 8);
	int differ = memcmp(f.sum, all.sum, size) || !memcmp(f.sum, once.sum, size);
	if (cl)
		cl_free(cl);
	film_free(&f);
	film_free(&once);
	film_free(&all);
	setup_free(&u);
	medium_file_close(&baked);
	scenefile_free(&file);
	return differ;
}

#define MOST (((int64)1 << 61) - 1)    /* of a sample, less than a quarter of a sum's limit either way */

int main(int argc, char **argv)
{
	if (argc > 2)
		return mid_run(!strcmp(argv[1], "opencl"), argv[2]);
	if (argc > 1)
		return colours(argv[1]);
	static const int64 values[] = { 0, 1, -1, 65535, 1LL << 31, (1LL << 32) - 1, -(1LL << 32), 0x123456789abcdef, MOST, -MOST };
	unsigned __int128 want = 0;
	int64 sum[2] = { 0, 0 }, sums[8] = { 0 };
	uint64 bad = 0;
	for (int k = 0; k < 6; k++)
		for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
			bad |= film_add_square(sum, values[i]);
			want += (unsigned __int128)((__int128)values[i] * values[i]);
		}
	ok(!(bad >> 63) && (uint64)sum[0] == (uint64)want && (uint64)sum[1] == (uint64)(want >> 64), "squares are summed to the last bit");
	int64 full[2] = { -1, INT64_MAX };
	ok(film_add_square(full, 1) >> 63, "a sum of squares beyond 2^127 is told");
	l8 told = { 0 }, n = { MOST, -MOST, 1 };
	for (int k = 0; k < 1000; k++) {
		told |= film_add8(sums, n);
		told |= film_add8(sums, -n);
	}
	ok(!FILM_BEYOND(told[0]) && !FILM_BEYOND(told[1]) && sums[0] == 0 && sums[1] == 0 && sums[2] == 0, "what is just in range may come and go");
	for (int k = 0; k < 9; k++)
		told |= film_add8(sums, n);
	ok(FILM_BEYOND(told[0]) && FILM_BEYOND(told[1]) && !FILM_BEYOND(told[2]), "a sum out of range is told, however far");
	return done_testing();
}

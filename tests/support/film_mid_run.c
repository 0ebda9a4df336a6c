/* film_mid_run c|opencl SCENE: a film is read and written in mid-run, and goes on; used by film.t. */
#include "medium/medium_file.h"
#include "render/backend.h"
#include "render/image.h"

#include <string.h>

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
	medium_file_open(file.medium[0].file, &baked);
	setup_make(&u, &file, (const struct medium *const[]){ &baked.medium }, &(struct render_options){ .transport = { TRANSPORT_EXPLICIT }, .seed = 1 });
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

int main(int argc, char **argv)
{
	return argc == 3 ? mid_run(!strcmp(argv[1], "opencl"), argv[2]) : 2;
}

/* variance_seeds TRANSPORT FIRST SEEDS SCENE..: of each scene, for several ranges of samples: the mean of variance.Y over pixels and
 * seeds by the mean over pixels of the variance over seeds; used by variance.t. */
#include "base/die.h"
#include "medium/medium_file.h"
#include "render/backend.h"
#include "render/kern/film.h"
#include "render/variance.h"

#include <stdlib.h>

static const int range[][2] = { { 0, 8 }, { 0, 16 }, { 3, 50 }, { 0, 64 }, { 0, 256 } };

static double ratio(struct setup *u, const struct medium *medium, int first, int seeds, int from, int to)
{
	size_t pixels = (size_t)u->scene.camera.width * (size_t)u->scene.camera.height;
	double *sum = xalloc(pixels, sizeof *sum), *squares = xalloc(pixels, sizeof *squares), told = 0, really = 0;
	float *one = xalloc(pixels, sizeof *one);
	for (int k = 0; k < seeds; k++) {
		struct film f;
		struct image image;
		u->scene.seed = (uint32)(first + k);
		film_make(&f, &u->scene);
		render_c(u, &f, 0, (uint32)pixels, (uint32)from, (uint32)(to - from), 2);
		image_of(&image, &u->scene, &f, medium, from, to, 0, "", "");
		variance_of(&image, one);
		for (size_t p = 0; p < pixels; p++) {
			double y = (double)f.sum[p * (size_t)f.n_sums + SUM_LUMINANCE] / FILM_UNIT / (to - from);
			sum[p] += y;
			squares[p] += y * y;
			told += (double)one[p] / seeds;
		}
		image_free(&image);
		film_free(&f);
	}
	for (size_t p = 0; p < pixels; p++)
		really += (squares[p] - sum[p] * sum[p] / seeds) / (seeds - 1);
	free(sum);
	free(squares);
	free(one);
	return told / really;
}

int main(int argc, char **argv)
{
	int transport = atoi(argv[1]), first = atoi(argv[2]), seeds = atoi(argv[3]);
	for (int a = 4; a < argc; a++) {
		struct scenefile file;
		struct medium_file baked;
		struct setup u;
		scenefile_read(argv[a], &file);
		medium_file_open(file.medium[0].file, &baked);
		setup_make(&u, &file, (const struct medium *const[]){ &baked.medium }, &(struct render_options){ .transport = { transport } });
		for (size_t k = 0; k < sizeof range / sizeof *range; k++)
			printf("%s, samples %d to %d\t%.3f\n", argv[a], range[k][0], range[k][1] - 1,
			       ratio(&u, &baked.medium, first, seeds, range[k][0], range[k][1]));
		setup_free(&u);
		medium_file_close(&baked);
		scenefile_free(&file);
	}
	return 0;
}

/* image - a film as an OpenEXR image: its finished layers and, where it has a part of the samples only, the exact sums beside
 * them, so that parts can be added later. */
#ifndef RENDER_IMAGE_H
#define RENDER_IMAGE_H

#include "format/exr.h"
#include "medium/medium.h"
#include "render/film.h"

#define IMAGE_SAMPLES 1000000000     /* a pixel, at most */
#define IMAGE_WAVES 320              /* of a spectral image, at most: each takes six channels of a part */

struct image {
	int width, height;
	int n_sums;                  /* of a pixel: see kern/film.h */
	const struct film *film;     /* that has the sums; else they are */
	int64 *sum;                  /* [pixel][n_sums] */
	int coloured;                /* alpha has a colour */
	int n_spectral;              /* sums of a spectral image: radiance at each wavelength, then alpha; else 0 */
	char (*wave)[EXR_NAME];      /* their channels' names */
	int depth_exponent;          /* depths are in units of 2^(depth_exponent - 30) m */
	int n_ranges;                /* of samples: [from, to), ascending, apart from each other */
	long long (*range)[2];
	long long total;             /* samples of the whole image; 0: not known */
	char *history;               /* with --samples where total is known */
};

/* image_range - read "A:B", samples A to B - 1. Returns NULL, or what is wrong. */
const char *image_range(const char *text, long long *from, long long *to);

/* image_of - samples [from, to) as rendered: what the film has whenever the image is written. It must outlive the image.
 * Given: s         the scene that was rendered
 *        total     as above
 *        history   of the medium and the scene
 *        command   vrender's own line without --samples */
void image_of(struct image *out, const struct scene *s, const struct film *f, const struct medium *m, long long from, long long to,
              long long total, const char *history, const char *command);

/* image_read - read an image that has its sums; dies on any other. */
void image_read(const char *path, struct image *out);

/* image_merge - add another part of the same image, read from path; dies, naming it, where it is none, has samples in common,
 * or the sum is out of range. */
void image_merge(struct image *into, const struct image *more, const char *path);

/* image_samples - of a pixel. image_sums - a pixel's, as kern/film.h has them; room[n_sums] may hold them. */
long long image_samples(const struct image *m);
const int64 *image_sums(const struct image *m, size_t pixel, int64 *room);

/* image_whole - can the samples be a whole image: from 0 on without a gap, as many as there are to be where that is known? image_complete -
 * are they all of an image whose number of samples is known, so that none can be added? */
int image_whole(const struct image *m);
int image_complete(const struct image *m);

/* image_write - write the layers, and the sums where asked for. Dies. */
void image_write(struct out *out, const struct image *m, int sums);

void image_free(struct image *m);

#endif

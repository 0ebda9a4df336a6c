/* variance - how far chance moves a pixel. */
#ifndef RENDER_VARIANCE_H
#define RENDER_VARIANCE_H

#include "render/image.h"

/* variance_of - the variance of the luminance of each pixel, a mean of its samples: out[pixel]; 0 of a single sample.
 *
 * The means of the two replicates of the lattice that the samples are (kern/random.h) are independent, and the square of what they are
 * apart is without bias for the variance of the mean of all, but for one of so many of each: exact where they are as many. It is a
 * single square, though. The spread of all samples is known far better, and too large, by a factor that pixels like each other share: it
 * is told by the squares and the spreads of those around that have about the same spread. */
void variance_of(const struct image *m, float *out);

#endif

#include "render/variance.h"

#include "base/die.h"
#include "render/kern/film.h"
#include "render/kern/random.h"

#include <stdlib.h>

#define AROUND 5        /* pixels to each side */
#define ALIKE 4.0       /* largest ratio of spreads */

typedef __int128 int128;
typedef unsigned __int128 uint128;

/* Variance of the mean of n independent samples, from their sum and the sum of their squares: about a whole number near the mean, in
 * integers, so that nothing cancels. 0 of a single sample. */
static double of_spread(const int64 *sum, long long n)
{
	int64 y = sum[SUM_LUMINANCE], mean = y / n, rest = y - mean * n;
	uint128 squares = (uint128)(uint64)sum[SUM_SQUARE + 1] << 64 | (uint64)sum[SUM_SQUARE];
	squares += (uint128)n * (uint128)((int128)mean * mean) - 2 * (uint128)((int128)mean * y);    /* modulo 2^128 */
	double spread = (double)squares - (double)rest * (double)rest / (double)n;
	return n > 1 && spread > 0 ? spread / ((double)n * (double)(n - 1)) / (FILM_UNIT * FILM_UNIT) : 0;
}

/* The same from the means of two replicates of n[0] and n[1] samples. */
static double of_replicates(const int64 *sum, const long long n[2])
{
	double all = (double)(n[0] + n[1]);
	int128 apart = (int128)(sum[SUM_LUMINANCE] - sum[SUM_SECOND]) * n[1] - (int128)sum[SUM_SECOND] * n[0];
	return (double)apart / all * ((double)apart / all) / ((double)n[0] * (double)n[1]) / (FILM_UNIT * FILM_UNIT);
}

/* How many of the samples below n are of the second replicate. */
static long long second_below(long long n)
{
	return n / 2 + (n % 2 ? (long long)replicate_of((uint32)n - 1) : 0);
}

/* The sums over pixels like that at (x, y), of what is in row-major order. */
static double share(const struct image *m, const double *spread, const double *apart, int x, int y)
{
	double own = spread[(size_t)y * (size_t)m->width + (size_t)x], all = 0, really = 0;
	for (int j = y < AROUND ? 0 : y - AROUND; j <= y + AROUND && j < m->height; j++)
		for (int i = x < AROUND ? 0 : x - AROUND; i <= x + AROUND && i < m->width; i++) {
			size_t at = (size_t)j * (size_t)m->width + (size_t)i;
			int alike = spread[at] <= ALIKE * own && own <= ALIKE * spread[at];
			all += alike ? spread[at] : 0;
			really += alike ? apart[at] : 0;
		}
	return all > 0 ? really / all : 0;
}

void variance_of(const struct image *m, float *out)
{
	size_t pixels = (size_t)m->width * (size_t)m->height;
	double *spread = xalloc(pixels, sizeof *spread), *apart = xalloc(pixels, sizeof *apart);
	int64 *room = xalloc((size_t)m->n_sums, sizeof *room);
	long long n = image_samples(m), of[2] = { 0, 0 };
	for (int i = 0; i < m->n_ranges; i++)
		of[1] += second_below(m->range[i][1]) - second_below(m->range[i][0]);
	of[0] = n - of[1];
	int both = of[0] && of[1];
	for (size_t i = 0; i < pixels; i++) {
		const int64 *sum = image_sums(m, i, room);
		spread[i] = of_spread(sum, n);
		apart[i] = both ? of_replicates(sum, of) : 0;
	}
	for (int y = 0; y < m->height; y++)
		for (int x = 0; x < m->width; x++) {
			size_t at = (size_t)y * (size_t)m->width + (size_t)x;
			out[at] = (float)(spread[at] * (both ? share(m, spread, apart, x, y) : 1));
		}
	free(spread);
	free(apart);
	free(room);
}

#include "optics/numerics/nufft.h"

#include "optics/numerics/gauss.h"
#include "optics/numerics/legendre_series_lanes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ROW (2 * NUFFT_SUMS)
#define PAIRS (NUFFT_SUMS / 2)    /* transformed together */
#define NODES (2 * GAUSS)

/* The kernel's transform at frequencies 0 .. n - 1 of a grid of that size, by Gauss-Legendre in two halves. */
static void transform_of_kernel(int size, int n, double *out)
{
	const double half = NUFFT_TAPS / 2.0;
	double now[NODES], before[NODES], twice[NODES], w[NODES];
	for (int i = 0; i < NODES; i++) {
		double z = (i / GAUSS + 0.5 + gauss_node[i % GAUSS] / 2) / 2, c = cos(2 * M_PI * half * z / size);
		w[i] = gauss_weight[i % GAUSS] / 2 * half * exp(NUFFT_SHAPE * (sqrt((1 - z) * (1 + z)) - 1));
		now[i] = 1;
		before[i] = c;
		twice[i] = 2 * c;
	}
	for (int f = 0; f < n; f++) {
		double sum = 0;
		for (int i = 0; i < NODES; i++) {
			sum += w[i] * now[i];
			double next = twice[i] * now[i] - before[i];
			before[i] = now[i];
			now[i] = next;
		}
		out[f] = sum;
	}
}

/* Room for a grid of that size; what was there before is enough where it was no smaller. 0, or -1 when memory ran out. */
static int make_room(struct nufft *s, int size)
{
	size_t rows = (size_t)size + 2 * (NUFFT_TAPS - 1);
	if (size <= s->most)
		return 0;
	nufft_free(s);
	s->room = malloc(11 * (size_t)size * sizeof *s->room);
	s->memory = malloc(rows * ROW * sizeof *s->memory);
	if (!s->room || !s->memory) {
		nufft_free(s);
		return -1;
	}
	s->most = size;
	return 0;
}

int nufft_set(struct nufft *s, int n, const double *const coefficient[NUFFT_SUMS])
{
	const struct legendre_series_lanes *lanes = legendre_series_lanes();
	int size = 16, edge = NUFFT_TAPS - 1;
	while (size < n + n / 2)
		size *= 2;
	if (make_room(s, size))
		return -1;
	s->size = size;
	s->row = s->memory + (size_t)edge * ROW;
	size_t points = 2 * (size_t)size;
	double *wave = s->room, *kernel = wave + points, *re[2] = { kernel + size, kernel + size + points };
	double *im[2] = { re[1] + points, re[1] + 2 * points };
	lanes->waves(size, wave);
	transform_of_kernel(size, n / 2 + 1, kernel);
	for (int pair = 0; pair < PAIRS; pair++) {
		memset(re[0], 0, points * sizeof(double));
		memset(im[0], 0, points * sizeof(double));
		for (int i = 0; i < 2; i++) {
			const double *c = coefficient[2 * pair + i];
			for (int k = 0; c && k < n; k++) {
				int f = k - n / 2, at = 2 * ((f + size) % size) + i;
				re[0][at] = c[2 * k] / kernel[abs(f)];
				im[0][at] = c[2 * k + 1] / kernel[abs(f)];
			}
		}
		int there = lanes->fourier(size, wave, re, im);
		for (int j = 0; j < size; j++)
			for (int i = 0; i < 2; i++) {
				s->row[ROW * (size_t)j + 2 * (size_t)pair + (size_t)i] = re[there][2 * j + i];
				s->row[ROW * (size_t)j + NUFFT_SUMS + 2 * (size_t)pair + (size_t)i] = im[there][2 * j + i];
			}
	}
	memcpy(s->memory, s->row + (size_t)(size - edge) * ROW, (size_t)edge * ROW * sizeof *s->row);
	memcpy(s->row + (size_t)size * ROW, s->row, (size_t)edge * ROW * sizeof *s->row);
	return 0;
}

void nufft_free(struct nufft *s)
{
	free(s->memory);
	free(s->room);
	*s = (struct nufft){ 0 };
}

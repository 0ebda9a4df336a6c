#include "optics/spectrum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ROW (2 * SPECTRUM_SUMS)
#define NODES 16

/* The kernel's transform at frequencies 0 .. n - 1 of a grid of that size, by Gauss-Legendre in two halves. */
static void transform_of_kernel(int size, int n, double *out)
{
	static const double node[4] = { 0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363 };
	static const double weight[4] = { 0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763 };
	const double half = SPECTRUM_TAPS / 2.0;
	double now[NODES], before[NODES], twice[NODES], w[NODES];
	for (int i = 0; i < NODES; i++) {
		int side = i % 2 ? 1 : -1, k = i / 2 % 4;
		double z = (i / 8 + 0.5 + side * node[k] / 2) / 2, c = cos(2 * M_PI * half * z / size);
		w[i] = weight[k] / 2 * half * exp(SPECTRUM_SHAPE * (sqrt((1 - z) * (1 + z)) - 1));
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

/* Sums over k of a[k] e^(2 pi i j k/size) in place, Stockham's order; b is room, the result is in the one returned. */
static double *fourier(int size, double *a, double *b, const double *turn)
{
	for (int n = size, stride = 1; n > 1; n /= 2, stride *= 2) {
		int half = n / 2;
		for (int p = 0; p < half; p++) {
			double c = turn[2 * p * stride], s = turn[2 * p * stride + 1];
			const double *x = a + (size_t)p * stride * ROW, *y = x + (size_t)half * stride * ROW;
			double *u = b + (size_t)2 * p * stride * ROW, *v = u + (size_t)stride * ROW;
			for (int q = 0; q < stride; q++, x += ROW, y += ROW, u += ROW, v += ROW)
#pragma omp simd
				for (int i = 0; i < SPECTRUM_SUMS; i++) {
					double re = x[i] - y[i], im = x[i + SPECTRUM_SUMS] - y[i + SPECTRUM_SUMS];
					u[i] = x[i] + y[i];
					u[i + SPECTRUM_SUMS] = x[i + SPECTRUM_SUMS] + y[i + SPECTRUM_SUMS];
					v[i] = re * c - im * s;
					v[i + SPECTRUM_SUMS] = re * s + im * c;
				}
		}
		double *t = a;
		a = b;
		b = t;
	}
	return a;
}

int spectrum_set(struct spectrum *s, int n, const double *const coefficient[SPECTRUM_SUMS])
{
	int size = 16, edge = SPECTRUM_TAPS - 1;
	while (size < n + n / 2)
		size *= 2;
	size_t rows = (size_t)size + 2 * (size_t)edge;
	if (size > s->most) {
		spectrum_free(s);
		s->room = malloc((rows * ROW + 2 * (size_t)size) * sizeof *s->room);
		s->memory = malloc(rows * ROW * sizeof *s->memory);
		if (!s->room || !s->memory) {
			spectrum_free(s);
			return -1;
		}
		s->most = size;
	}
	s->size = size;
	double *room = s->room;
	double *turn = room + rows * ROW, *kernel = turn + size, *a = s->memory + (size_t)edge * ROW;
	double *b = room + (size_t)edge * ROW;
	transform_of_kernel(size, n / 2 + 1, kernel);
	/* e^(2 pi i p/size) by quarters of the circle */
	for (int p = 0; p < size / 2; p++) {
		double c = 1, t = 0;
		if (p == 0)
			;
		else if (p % 2 == 0) {
			c = turn[2 * (p / 2)] * turn[2 * (p / 2)] - turn[2 * (p / 2) + 1] * turn[2 * (p / 2) + 1];
			t = 2 * turn[2 * (p / 2)] * turn[2 * (p / 2) + 1];
		} else {
			sincos(2 * M_PI * p / size, &t, &c);
		}
		turn[2 * p] = c;
		turn[2 * p + 1] = t;
	}
	memset(a, 0, (size_t)size * ROW * sizeof *a);
	for (int k = 0; k < n; k++) {
		int f = k - n / 2;
		double *at = a + (size_t)((f + size) % size) * ROW, scale = 1 / kernel[abs(f)];
		for (int j = 0; j < SPECTRUM_SUMS; j++)
			if (coefficient[j]) {
				at[j] = coefficient[j][2 * k] * scale;
				at[j + SPECTRUM_SUMS] = coefficient[j][2 * k + 1] * scale;
			}
	}
	double *result = fourier(size, a, b, turn);
	s->row = s->memory + (size_t)edge * ROW;
	if (result != a)
		memcpy(s->row, result, (size_t)size * ROW * sizeof *s->row);
	memcpy(s->memory, s->row + (size_t)(size - edge) * ROW, (size_t)edge * ROW * sizeof *s->row);
	memcpy(s->row + (size_t)size * ROW, s->row, (size_t)edge * ROW * sizeof *s->row);
	return 0;
}

void spectrum_free(struct spectrum *s)
{
	free(s->memory);
	free(s->room);
	*s = (struct spectrum){ 0 };
}

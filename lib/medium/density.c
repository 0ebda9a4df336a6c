#include "medium/density.h"

/* The two voxels around u along an axis of n, and the share of the second. */
static double split(double u, size_t n, size_t *a, size_t *b)
{
	double t = u * (double)n - 0.5;
	if (!(t > 0)) {
		*a = *b = 0;
		return 0;
	}
	if (t >= (double)(n - 1)) {
		*a = *b = n - 1;
		return 0;
	}
	*a = (size_t)t;
	*b = *a + 1;
	return t - (double)*a;
}

double density_at(const struct npy_grid *g, double u, double v, double w)
{
	size_t x[2], y[2], z[2];
	double fx = split(u, g->nx, &x[0], &x[1]), fy = split(v, g->ny, &y[0], &y[1]), fz = split(w, g->nz, &z[0], &z[1]);
	double plane[2], row[2];
	for (int k = 0; k < 2; k++) {
		for (int j = 0; j < 2; j++) {
			const float *p = g->v + (z[k] * g->ny + y[j]) * g->nx;
			row[j] = p[x[0]] + fx * ((double)p[x[1]] - p[x[0]]);
		}
		plane[k] = row[0] + fy * (row[1] - row[0]);
	}
	return plane[0] + fz * (plane[1] - plane[0]);
}

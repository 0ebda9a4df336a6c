/* series_kernels - the parts of series that are compiled for each processor (series_lanes.c). */
#ifndef OPTICS_SERIES_KERNELS_H
#define OPTICS_SERIES_KERNELS_H

#include "optics/series.h"

#define SERIES_PAD 8      /* steps beyond each end of the grid */

struct series {
	int steps;                        /* grid: (j + 1/2) pi / steps, j = -SERIES_PAD .. steps + SERIES_PAD - 1 */
	double *grid;                     /* [steps + 2 SERIES_PAD][SERIES] */
	double poly[20][16];              /* weights of the window (kern/window.h) */
	const struct series_kernels *kernels;
};

struct series_kernels {
	/* fill poly and grid from Legendre coefficients c[n+1]; 0, or -1 when memory ran out */
	int (*prepare)(struct series *s, int n, double (*c)[SERIES]);
	void (*at)(const struct series *s, int count, const double *theta, double (*values)[SERIES]);
};

extern const struct series_kernels series_scalar, series_v2, series_v3, series_v4;

#endif

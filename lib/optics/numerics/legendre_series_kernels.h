/* legendre_series_kernels - the parts of series, and the transform under them, that are compiled for each processor (legendre_series_lanes.c). */
#ifndef OPTICS_LEGENDRE_SERIES_KERNELS_H
#define OPTICS_LEGENDRE_SERIES_KERNELS_H

#include "base/cpu.h"
#include "optics/numerics/legendre_series.h"

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
	/* fourier_waves and fourier of kern/fourier.h */
	void (*waves)(int n, double *wave);
	int (*fourier)(int n, const double *wave, double *re[2], double *im[2]);
};

CPU_DECLARE(const struct series_kernels, legendre_series_lanes);

/* legendre_series_lanes - the build for this processor, by cpu_level. */
const struct series_kernels *legendre_series_lanes(void);

#endif

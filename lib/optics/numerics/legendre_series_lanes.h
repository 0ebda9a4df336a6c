/* legendre_series_lanes - what legendre_series has inside, and its loops, with the Fourier transform under them: compiled for each
 * processor. */
#ifndef OPTICS_LEGENDRE_SERIES_LANES_H
#define OPTICS_LEGENDRE_SERIES_LANES_H

#include "base/cpu.h"
#include "optics/numerics/legendre_series.h"

#define LEGENDRE_SERIES_PAD 8      /* steps beyond each end of the grid */

struct legendre_series {
	int steps;                        /* grid: (j + 1/2) pi / steps, j = -LEGENDRE_SERIES_PAD .. steps + LEGENDRE_SERIES_PAD - 1 */
	double *grid;                     /* [steps + 2 LEGENDRE_SERIES_PAD][LEGENDRE_SERIES_SUMS] */
	double poly[20][16];              /* weights of the window (kern/window.h) */
	const struct legendre_series_lanes *lanes;
};

struct legendre_series_lanes {
	/* fill poly and grid from Legendre coefficients c[n+1]; 0, or -1 when memory ran out */
	int (*prepare)(struct legendre_series *s, int n, double (*c)[LEGENDRE_SERIES_SUMS]);
	/* the same from c[n+1] of cos k theta */
	int (*cosines)(struct legendre_series *s, int n, const double (*c)[LEGENDRE_SERIES_SUMS]);
	void (*at)(const struct legendre_series *s, int count, const double *theta, double (*values)[LEGENDRE_SERIES_SUMS]);
	/* fourier_waves and fourier of kern/fourier.h */
	void (*waves)(int n, double *wave);
	int (*fourier)(int n, const double *wave, double *re[2], double *im[2]);
};

CPU_DECLARE(const struct legendre_series_lanes, legendre_series_lanes);

/* legendre_series_lanes - the build for this processor, by cpu_level. */
const struct legendre_series_lanes *legendre_series_lanes(void);

#endif

/* cam_waves - sums over partial waves and integrals that stand for them, by the asymptotic forms of debye_waves.h. */
#ifndef OPTICS_CAM_WAVES_H
#define OPTICS_CAM_WAVES_H

#include "base/cmplx.h"

/* Where resonances of waves near the edge begin to be summed, in widths s = (x/2)^(1/3) of it: share(lambda) rises from 0 to 1. */
double cam_share(double x, double lambda);

/* cam_mean - absorption and radiation pressure, interference inside averaged out: as if e^(2 i phase) of a wave inside took all values. */
void cam_mean(double x, double complex m, double *abs, double *pr);

/* cam_ripple - what the waves near the edge add to extinction (orders p >= 2), and to the means of cam_mean. */
void cam_ripple(double x, double complex m, double *ext, double *abs, double *pr);

#endif

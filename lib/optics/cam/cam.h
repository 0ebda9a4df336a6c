/* cam - efficiencies of a large sphere without a sum over its partial waves: asymptotics in complex angular momentum. Conventions as in
 * mie.h.
 *
 * Extinction in closed form (Nussenzveig and Wiscombe 1980, Physical Review Letters 45, 1490) and the glories; absorption and radiation
 * pressure, hence g, by an integral over rays and what the edge adds to it, which is tabulated in x for an index as it is needed.
 * back has the rays along the axis alone. sca = ext to the last bit where m is real. */
#ifndef OPTICS_CAM_H
#define OPTICS_CAM_H

#include "optics/mie/mie.h"

/* What depends on m alone. */
struct cam;

/* cam_new - Re m > 0, Im m >= 0; NULL when memory ran out. */
struct cam *cam_new(double complex m);
void cam_free(struct cam *c);

/* cam_reach - compute what cam_at needs for size x. */
void cam_reach(struct cam *c, double x);

/* cam_at - after cam_reach; threads may ask at once. ripple: sum the waves near the edge that run round inside the sphere, 18 (x/2)^(1/3)
 * of them; without, or Re m < 1, ext lacks their ripple, and abs and g have its mean. */
struct efficiencies cam_at(const struct cam *c, double x, int ripple);

/* cam_error - estimate of the larger of the relative errors of ext and sca and the absolute error of g, of cam_at. Resonances and
 * glories beside rainbows exceed it for less than 1 percent of spheres that do not absorb, with ripple or without. abs is within
 * it times ext, which says little where |abs| is less: without ripple abs has the mean of resonances, right over sizes; of one
 * size beside them it is too large by some 2 (2/x)^(2/3) of itself where little is absorbed, of one on them too small; with
 * ripple these stand beside their places by a part of their widths. */
double cam_error(double x, double complex m);

#endif

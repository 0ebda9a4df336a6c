/* method - efficiencies by the method asked for, or by the cheapest one whose estimated error is below a tolerance. Conventions as in
 * mie.h. */
#ifndef OPTICS_METHOD_H
#define OPTICS_METHOD_H

#include "optics/mie/mie.h"

enum method { METHOD_AUTO, METHOD_MIE, METHOD_RAYLEIGH, METHOD_GOA, METHOD_CAM, METHOD_EVANS_FOURNIER };

struct ladder;

/* ladder_new - NULL when memory ran out. tolerance: of METHOD_AUTO, on the larger of the relative errors of ext and sca and the absolute
 * error of g; back is not in it. METHOD_AUTO never takes METHOD_GOA: METHOD_CAM is cheaper and closer. */
struct ladder *ladder_new(enum method method, double tolerance);
void ladder_free(struct ladder *l);

/* ladder_many - n spheres x[n], m[n] (ranges as in mie.h). What METHOD_CAM needs for an index pays only for many sizes: METHOD_AUTO counts
 * what Lorenz-Mie theory has cost and would cost, in this call and those before it, so that which method serves a sphere depends on the
 * others; not on threads.
 * Returned: q[n], error[n] (estimates), used[n]; 0, or -1 when memory ran out */
int ladder_many(struct ladder *l, int n, const double *x, const double complex *m, struct efficiencies *q, double *error,
                enum method *used);

#endif

/* method_selection - efficiencies of many spheres by the method asked for, or by the cheapest one whose estimated error is below a
 * tolerance; which that is, method.c says. Conventions as in mie.h. */
#ifndef OPTICS_METHOD_SELECTION_H
#define OPTICS_METHOD_SELECTION_H

#include "optics/select/method.h"

/* What is known of each index: where methods serve, and what they have prepared. */
struct method_selection;

/* method_selection_new - NULL when memory ran out. tolerance: of METHOD_AUTO, on the larger of the relative errors of ext and sca and the
 * absolute error of g; back is not in it. */
struct method_selection *method_selection_new(enum method method, double tolerance);
/* method_selection_asked - the method it was made for. */
enum method method_selection_asked(const struct method_selection *l);
void method_selection_free(struct method_selection *l);

/* method_selection_many - n spheres. What a method prepares for an index pays only for many sizes: METHOD_AUTO counts what Lorenz-Mie
 * theory has cost and would cost, in this call and those before it, so that which method serves a sphere depends on the others; not on
 * threads.
 * Returned: q[n], error[n] (estimates), used[n]; 0, or -1 when memory ran out */
int method_selection_many(struct method_selection *l, int n, const struct sphere *s, struct efficiencies *q, double *error,
                          enum method *used);

#endif

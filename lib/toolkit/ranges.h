/* ranges - the ranges of sizes that a table's classes stand for. */
#ifndef TOOLKIT_RANGES_H
#define TOOLKIT_RANGES_H

#include "toolkit/class_table.h"
#include "toolkit/size_integral.h"

/* ranges_add - append to an integral the ranges of the classes of a table, each a group of its own, or, together, all as one. A law that
 * is not cut goes on below the first class and above the last, until what is left counts for a thousandth of tolerance at most; together,
 * it is one range. The integrand is known. Returns the share that may be left out. */
double ranges_add(struct size_integral *s, const struct class_table *t, int together, double tolerance);

#endif

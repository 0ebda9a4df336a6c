/* medium_check - whether what renders a medium can rely on it: the one check of a medium, before it is written and when it is read. */
#ifndef MEDIUM_MEDIUM_CHECK_H
#define MEDIUM_MEDIUM_CHECK_H

#include "medium/medium.h"

/* medium_check_sizes - NULL, or what is wrong with the numbers of wavelengths, classes and elements: the sizes of its arrays. */
const char *medium_check_sizes(const struct medium *m);

/* medium_check - the same, and then the ranges of all values: that indices lie within their arrays, that phase functions are normalised,
 * and that sums which stand beside what they sum agree with it. */
const char *medium_check(const struct medium *m);

#endif

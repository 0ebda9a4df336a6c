/* medium_check - whether what renders a medium can rely on it. */
#ifndef MEDIUM_MEDIUM_CHECK_H
#define MEDIUM_MEDIUM_CHECK_H

#include "medium/medium.h"

/* medium_check - the ranges of all values, and that indices lie within their arrays, whose sizes are right. Dies, with the
 * name. */
void medium_check(const char *name, const struct medium *m);

#endif

/* standard - no path, or "-", is standard input or output; what messages call a file. */
#ifndef BASE_STANDARD_H
#define BASE_STANDARD_H

#include <string.h>

static inline int standard(const char *path) { return !path || !strcmp(path, "-"); }
static inline const char *standard_input(const char *path) { return standard(path) ? "standard input" : path; }
static inline const char *standard_output(const char *path) { return standard(path) ? "standard output" : path; }

#endif

/* ascending - order of doubles, for qsort. */
#ifndef BASE_ASCENDING_H
#define BASE_ASCENDING_H

static inline int ascending(const void *a, const void *b)
{
	double x = *(const double *)a, y = *(const double *)b;
	return (x > y) - (x < y);
}

#endif

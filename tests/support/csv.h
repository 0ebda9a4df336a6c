/* Tables of reference values beside the tests. */
#ifndef SUPPORT_CSV_H
#define SUPPORT_CSV_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Relative difference; infinite where it is no number. */
static inline double off(double got, double want)
{
	double e = fabs(got - want) / fabs(want);
	return got == want ? 0 : isnan(e) ? INFINITY : e;
}

/* A row of a CSV file beside the test: fields split in place. Returns their number, 0 at the end. */
static inline int fields(FILE *f, char *line, size_t size, char **field, int max)
{
	if (!fgets(line, (int)size, f))
		return 0;
	line[strcspn(line, "\n")] = 0;
	int n = 0;
	for (char *c = line; c && n < max; n++) {
		field[n] = c;
		c = strchr(c, ',');
		if (c)
			*c++ = 0;
	}
	return n;
}

static inline FILE *open_data(const char *name)
{
	char path[256], line[4096];
	snprintf(path, sizeof path, "tests/data/%s", name);
	FILE *f = fopen(path, "r");
	if (!f || !fgets(line, sizeof line, f)) {
		printf("Bail out! cannot read %s\n", path);
		exit(2);
	}
	return f;
}

#endif

/* size_integral - integrals over sizes of what spheres scatter: each part of the range by as many sizes as it needs. */
#ifndef TOOLKIT_SIZE_INTEGRAL_H
#define TOOLKIT_SIZE_INTEGRAL_H

#include "base/cmplx.h"
#include "optics/sizes/size_quadrature.h"

#include <stddef.h>

#define SIZE_HEADS 8               /* first values of every part, of which the groups' sums are known: at most */

/* A part of a range, with sums of its own number of values. */
struct size_part {
	struct size_range range;
	size_t group, values;          /* parts of a group add up to one result */
	int level;                     /* of the sums; -1: none yet */
	double *sum[SIZE_WAYS];        /* [values], of which sum[way][0] is weight x c_sca */
	double error;                  /* estimate, relative to the group's result */
};

/* What is integrated. */
struct size_integrand {
	void *context;
	double x_of_um;                /* size parameter of a radius of 1 um */
	double complex m;
	int resonates;                 /* the theory has resonances */
	size_t heads;                  /* of the values, SIZE_HEADS at most */
	/* values - how many a part has that reaches up to x */
	size_t (*values)(void *context, double x);
	/* add - sum[way][value] += weight[way][i] times the values at radius[i], n sizes of a part; in order, so that sums do not depend on
	 * threads. Dies. */
	void (*add)(void *context, const struct size_part *part, int ways, size_t n, const double *radius, const double *const weight[SIZE_WAYS],
	            double *const sum[SIZE_WAYS]);
	/* error - how much a change of a part's values changes the group's result: total[heads] are the sums over the group */
	double (*error)(void *context, const struct size_part *part, const double *change, const double *total);
};

struct size_integral {
	const struct size_density *density;
	struct size_integrand integrand;
	size_t n, groups;
	struct size_part *part;
	double (*total)[SIZE_HEADS];   /* [groups], of the first way */
	double *error;                 /* [groups], estimates */
	double work;                   /* size parameters, each counted as 100 at least */
	long sizes;
};

/* size_integral_add - append a range of a group, 0, 1, .., in parts of an octave where x is large. */
void size_integral_add(struct size_integral *s, struct size_range r, size_t group);

/* size_integral_run - refine parts until the estimated error[] of each group is at most tolerance, or the next step would bring the work
 * above most; returns the largest.
 *
 * A change by a doubling is more than what is left of a smooth integrand, and of one that is met by chance, whose error falls as the
 * step does, 2.2 times that in root mean square. Of resonances narrower than the step it says little, since they
 * are met by chance: their share falls as the step does, so that the estimate is at least half of the one before until the step is
 * down to the narrowest resonance, by its width, exp(-2 x (n acosh n - sqrt(n^2 - 1))), or by absorption. A theory without any is
 * smooth. */
double size_integral_run(struct size_integral *s, double tolerance, double most);

void size_integral_free(struct size_integral *s);

#endif

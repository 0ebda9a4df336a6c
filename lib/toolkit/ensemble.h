/* ensemble - what is averaged over by ensemble_average: a table's sizes and classes, and the sums over them. */
#ifndef TOOLKIT_ENSEMBLE_H
#define TOOLKIT_ENSEMBLE_H

#include "optics/sizes/size_quadrature.h"
#include "toolkit/phase_model.h"
#include "toolkit/spheres.h"

/* Of one wavelength. Sums of weight x c_sca x value, c_sca in um^2/pi, and of weight x c_sca. A value is an element at an angle,
 * [PHASE_ELEMENTS][n] of them. */
struct ensemble_mean {
	struct size size;          /* of some particle; others differ by radius, x and x_im */
	double points_weight, weight;
	double *points, *sum;      /* sizes as given; the integral over classes */
	double *value;             /* the mean */
};

struct ensemble {
	struct spheres *in;
	const struct phase_model *model;
	int weight_col, lo_col, hi_col;    /* among what is carried; limits: -1 without */
	struct waves *w;           /* as read */
	size_t nw;
	struct ensemble_mean *mean;
	size_t nmean;
	struct size_quadrature *sub;      /* NULL: none */
	long n;
	double *theta;
	double work;               /* size parameters summed by the levels so far */
};

/* ensemble_path - what to call the table in messages. */
const char *ensemble_path(const struct ensemble *e);

/* ensemble_limited - whether a row is a class with limits, to be integrated over. */
int ensemble_limited(const struct ensemble *e, const struct waves *w);

/* ensemble_mean_of - the mean of a size's wavelength, a new one where there is none. */
size_t ensemble_mean_of(struct ensemble *e, const struct size *size);

/* ensemble_read - all of the table, and its classes. Dies. */
void ensemble_read(struct ensemble *e);

/* ensemble_free - what was read. */
void ensemble_free(struct ensemble *e);

/* ensemble_add_points - add the sizes that are as given to points, at theta[n]. Dies when memory ran out.
 * ensemble_add_level - add those of a level of the quadrature to sum. */
void ensemble_add_points(struct ensemble *e);
void ensemble_add_level(struct ensemble *e, int level);

#endif

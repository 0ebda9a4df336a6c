/* phase_means - phase functions as means over sizes, by c_sca: of the classes of a table, or of all of it. */
#ifndef TOOLKIT_PHASE_MEANS_H
#define TOOLKIT_PHASE_MEANS_H

#include "toolkit/class_table.h"
#include "toolkit/phase_model.h"

/* What means are asked for. */
struct phase_means_request {
	const struct class_table *table;
	const struct phase_model *model;
	int together;              /* one mean of all rows by weight, else one a class */
	double tolerance;          /* half the integral of |dp| */
	long n;                    /* for a model that is asked for given angles: those that decide on the sizes */
	const double *theta;
};

struct phase_means {
	size_t groups;             /* classes, or 1 */
	double x;                  /* the largest size parameter */
	double error, open;        /* the largest of the quadrature's estimates, and of what classes leave open */
	long sizes;
	struct phase_mean *mean;   /* [groups] */
};

/* phase_means_new - at a wavelength; by sizes until the estimated error is at most the tolerance, or 3e8 of size parameters in all, each
 * counted as 100 at least. Dies. */
struct phase_means *phase_means_new(const struct phase_means_request *r, size_t wave);

/* phase_means_of_row - the phase function of one row that is no class. */
struct phase_means *phase_means_of_row(const struct phase_means_request *r, size_t row);

/* phase_means_at - value[PHASE_ELEMENTS][n] of a group; theta is the request's where the model is for given angles. */
void phase_means_at(const struct phase_means *m, size_t group, long n, const double *theta, double *value);

void phase_means_free(struct phase_means *m);

#endif

/* phase_table - what mie-phase and goa-phase share: angles, rows, averages over sizes. A tool adds its model. */
#ifndef TOOLKIT_PHASE_TABLE_H
#define TOOLKIT_PHASE_TABLE_H

#include "toolkit/angle_refinement.h"

/* The options as given; zero-initialised. */
struct phase_options {
	struct reals theta;      /* degrees */
	long long angles;        /* 0: the default grid */
	int average;
	const struct phase_profile *profile;    /* of the model: the default grid then follows p. NULL: it depends on x alone */
	double tolerance;                       /* in L1 of p, taken as linear between the angles of that grid; and of means over sizes */
	int verbose;
};

/* Rows for the option table. */
#define PHASE_OPTIONS(o) \
	{ "--theta", OPT_REAL_STEPS, &(o).theta, 0, 180, "A[,B..]", "scattering angles in degrees, or an inclusive range FROM:TO:STEP", 0 }, \
	{ "--angles", OPT_INT, &(o).angles, 2, 1e7, "N", "N equally spaced angles on [0, 180], instead of a grid refined at the peaks", 0 }, \
	{ "--average", OPT_FLAG, &(o).average, 0, 0, NULL, "one phase function a wavelength, weighted by weight x c_sca", 0 }

/* What a model says about one particle at the angles asked for. */
struct phase_result {
	double complex *s1, *s2;     /* [n], to be filled */
	double norm;                 /* p = (|S1|^2 + |S2|^2) / (2 norm): integral of (|S1|^2 + |S2|^2)/2 over the sphere */
	double q_sca;                /* scattering efficiency */
	const char *method;          /* where a model chooses one for each size, for phase_options.verbose; else NULL */
	double error;                /* its estimate */
};

/* A model; theta[n] in degrees. Several threads call it at once, each with waves of its own, which it may solve.
 * Returns 0, or -1 when memory ran out. */
typedef int phase_model(const void *context, struct waves *w, int n, const double *theta, struct phase_result *out);

/* phase_table - read all of in, write the phase table: wavelength radius (or x) theta s1_re s1_im s2_re s2_im p and what is
 * carried; with --average wavelength theta p. in is left at its end. */
void phase_table(const struct phase_options *o, struct coeffs *in, phase_model *model, const void *context,
                 const char *output, const char *command);

#endif

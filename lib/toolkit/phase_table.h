/* phase_table - what mie-phase and goa-phase share: angles, rows, averages over sizes. A tool adds its model. */
#ifndef TOOLKIT_PHASE_TABLE_H
#define TOOLKIT_PHASE_TABLE_H

#include "toolkit/phase_model.h"
#include "toolkit/spheres.h"

/* The options as given; zero-initialised. */
struct phase_options {
	struct reals theta;      /* degrees */
	long long angles;        /* 0: the default grid, which follows p where the model is for any angles, else x alone */
	int average, at_radius;
	double tolerance;        /* in L1 of p, taken as linear between the angles of the default grid; and of means over sizes */
	int verbose;
};

/* Rows for the option table. */
#define PHASE_OPTIONS(o) \
	{ "--theta", OPT_REAL_STEPS, &(o).theta, 0, 180, "A[,B..]", \
	  "scattering angles in degrees, or an inclusive range FROM:TO:STEP", 0 }, \
	{ "--angles", OPT_INT, &(o).angles, 2, 1e7, "N", \
	  "N equally spaced angles on [0, 180], instead of a grid refined at the peaks", 0 }, \
	{ "--average", OPT_FLAG, &(o).average, 0, 0, NULL, "one phase function a wavelength, weighted by weight x c_sca", 0 }, \
	{ "--at-radius", OPT_FLAG, &(o).at_radius, 0, 0, NULL, "a class with limits is its radius alone", 0 }

/* phase_table - read all of in, write the phase table: wavelength radius (or x) theta s1_re s1_im s2_re s2_im p and what is
 * carried; with --average wavelength theta p. in is left at its end. */
void phase_table(const struct phase_options *o, struct spheres *in, const struct phase_model *model, const char *output,
                 const char *command);

#endif

/* ensemble_average - the mean phase function over the sizes of a table, by weight x c_sca. */
#ifndef TOOLKIT_ENSEMBLE_AVERAGE_H
#define TOOLKIT_ENSEMBLE_AVERAGE_H

#include "toolkit/phase_table.h"

/* ensemble_average_table - read all of in, write columns wavelength theta p, at theta[n] (degrees, ascending) or, with n = 0,
 * at angles of its own. Classes with limits (columns radius_lo, radius_hi) are integrated over sizes within them
 * (optics/sizes/size_quadrature.h), ever more, 257 or above, until twice as many change no wavelength's p by half the
 * tolerance; the other half is for the angles. Or, with a line on stderr, until the next doubling would bring the sum of their
 * size parameters, each counted as 100 at least, above 3e8. Where coefficients are read, or there are no limits, a class is its
 * radius. */
void ensemble_average_table(const struct phase_options *o, struct spheres *in, const struct phase_model *model, long n,
                            const double *theta, const char *output, const char *command);

#endif

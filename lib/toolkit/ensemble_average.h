/* ensemble_average - phase functions that are means over sizes, as tables. */
#ifndef TOOLKIT_ENSEMBLE_AVERAGE_H
#define TOOLKIT_ENSEMBLE_AVERAGE_H

#include "toolkit/class_table.h"
#include "toolkit/phase_table.h"

/* ensemble_average_table - the mean over all of a table, by weight x c_sca: columns wavelength theta p, at theta[n] (degrees, ascending)
 * or, with n = 0, at angles of its own. ensemble_class_table - the mean over each class with limits: columns wavelength radius theta p
 * and what is carried; a row without limits is its radius. Of the tolerance one half is the sizes', the other the angles'. Where more is
 * left a line on stderr says so. */
void ensemble_average_table(const struct phase_options *o, const struct class_table *table, const struct phase_model *model, long n,
                            const double *theta, const char *output, const char *command);
void ensemble_class_table(const struct phase_options *o, const struct class_table *table, const struct phase_model *model, long n,
                          const double *theta, const char *output, const char *command);

#endif

/* classes - the optical half of a medium, from tables: cross sections and phase functions of its classes. */
#ifndef MEDIUM_CLASSES_H
#define MEDIUM_CLASSES_H

#include "format/tab.h"
#include "medium/medium.h"

/* classes_cross_sections - read wavelength, radius, c_ext, c_sca; sets the classes and wavelengths of the medium.
 * Refuses c_ext <= 0 and c_sca > c_ext (1 + 1e-9). Dies. Returns the table's history. */
char *classes_cross_sections(const char *path, struct medium *m);

/* classes_phase_functions - read wavelength, [radius,] theta, p for every class and wavelength (without radius: one for all
 * classes), normalise each on its own grid, and build the common grids, the CDFs and the mixture by count x c_sca. count must
 * be set. Refuses a phase function off by more than 1 %. Dies. Returns the table's history. */
char *classes_phase_functions(const char *path, struct medium *m);

/* classes_find - the class that a particle of this radius (um) belongs to: nearest in log radius and within half the gap to the
 * neighbouring class (outermost: the same gap outwards; a single class: 1e-6). Dies, with the row of t, if it fits none. */
int classes_find(const struct medium *m, const struct tab *t, double radius);

/* classes_exact - whether a radius is the class's own, within 1e-9. */
int classes_exact(const struct medium *m, int class, double radius);

#endif

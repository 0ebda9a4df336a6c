/* rayleigh - efficiencies of a sphere small against the wavelength. Conventions as in mie.h. */
#ifndef OPTICS_RAYLEIGH_H
#define OPTICS_RAYLEIGH_H

#include "optics/mie/mie.h"

/* rayleigh_error - estimate of the largest of the relative errors of ext, sca and abs and the absolute error of g. */
double rayleigh_error(double x, double complex m);

/* rayleigh_efficiencies - electric dipole, magnetic dipole and electric quadrupole as series in x; the same to the last bit for sca and
 * ext where m is real.
 * Source: Wiscombe 1980, Applied Optics 19, 1505, the small-particle limit (for the other time factor). */
struct efficiencies rayleigh_efficiencies(double x, double complex m);

#endif

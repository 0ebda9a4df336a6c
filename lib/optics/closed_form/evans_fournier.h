/* evans_fournier - efficiencies of a sphere of any size by a closed formula: coarse. Conventions as in mie.h. */
#ifndef OPTICS_EVANS_FOURNIER_H
#define OPTICS_EVANS_FOURNIER_H

#include "optics/mie/mie.h"

/* evans_fournier_error - estimate of the larger of the relative errors of ext and sca and the absolute error of g; 1 far from the indices that
 * the fit was made for. */
double evans_fournier_error(double x, double complex m);

/* evans_fournier_efficiencies - extinction between Rayleigh's and van de Hulst's anomalous diffraction; made for Re m in [1, 2], and taken
 * at |Re m - 1| below. Absorption is that of anomalous diffraction, g a curve between its limits, back that of the two faces on the axis:
 * the fit has none of these. sca = ext to the last bit where m is real.
 * Source: Evans and Fournier 1990, Applied Optics 29, 4666. */
struct efficiencies evans_fournier_efficiencies(double x, double complex m);

#endif

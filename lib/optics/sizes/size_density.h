/* size_density - how many particles there are of each size: as a law says, or as classes leave it open. */
#ifndef OPTICS_SIZE_DENSITY_H
#define OPTICS_SIZE_DENSITY_H

#include "optics/sizes/psd.h"

/* Where a law is not known the density is rebuilt in two ways, both of which give every class its weight; what the classes leave open is
 * SIZE_OPEN times what integrals over them differ by, since both may be off to the same side. */
#define SIZE_OPEN 2
#define SIZE_WAYS 2

struct size_density;

/* size_density_of_law - normalised to 1 between its min and max, or everywhere. size_density_of_classes - of n classes in any order,
 * lo < radius < hi, that may overlap, or stand apart; they are sorted by their limits. NULL when memory ran out. c remains the caller's.
 *
 * The first way: the number of particles below a radius is known at the limits of classes that join. Between them it is a cubic of ln r,
 * with slopes from the quartic through the five nearest limits, held in [0, 3] times the mean of either class, which makes it
 * monotone (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980, 238): the density is continuous where classes join. The second: each
 * class is a power law with the mean volume of its radius. A class that joins no other is the latter both times, in the second way
 * with the mean of r^2. */
struct size_density *size_density_of_law(const struct psd *law);
struct size_density *size_density_of_classes(int n, struct psd_class *c);
void size_density_free(struct size_density *d);

/* size_density_ways - 1 or SIZE_WAYS. */
int size_density_ways(const struct size_density *d);

/* size_density_at - number by ln r at y = ln r (r in um), in class k; way < size_density_ways. The law's is the same in all classes,
 * and holds beyond them. */
double size_density_at(const struct size_density *d, int k, int way, double y);

#endif

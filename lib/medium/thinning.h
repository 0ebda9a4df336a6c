/* thinning - a medium with no more classes, and no more angles of their phase functions, than a tolerance needs. */
#ifndef MEDIUM_THINNING_H
#define MEDIUM_THINNING_H

#include "medium/medium.h"

struct thinned {
	int classes;                    /* before */
	size_t nodes;                   /* before */
	double classes_error;           /* what merging classes did, thinning_classes */
	double nodes_error;             /* largest half-L1 distance of a phase function to what it was */
};

/* thinning_classes - merge neighbouring classes as long as the mean over particles of what that does to one, weighted by its extinction
 * or its scattering, stays within a tolerance at every wavelength: of the relative change of c_ext, and of the half-L1 distance of its
 * phase function (1/2 int |p - p'| dOmega, the share of scattered light that goes elsewhere). The sums over all particles (extinction,
 * scattering, the mixture's phase function) stay what they are. Of a medium without particles only these matter, so that one class is
 * left. Before particle_grid_build. */
void thinning_classes(struct medium *m, double tolerance, struct thinned *t);

/* thinning_nodes - leave out angles of each phase function as long as it, linear between those left and normalised, stays within the
 * half-L1 distance of what it was at every wavelength. Intervals stay within MEDIUM_INTERVAL. */
void thinning_nodes(struct medium *m, double tolerance, struct thinned *t);

#endif

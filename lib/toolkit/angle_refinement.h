/* angle_refinement - tables whose angles are chosen by the phase functions themselves, so that these may be taken as linear
 * between them. */
#ifndef TOOLKIT_ANGLE_REFINEMENT_H
#define TOOLKIT_ANGLE_REFINEMENT_H

#include "toolkit/phase_model.h"

/* The wavelengths of a size, and angles that serve them all. */
struct angle_refinement {
	struct waves *w;
	size_t nwaves;
	struct phase_sphere **sphere;    /* [nwaves], open */
	long n;
	double *theta;                   /* [n], degrees */
};

/* angle_refinement_find - open w[nwaves] by a model for any angles and find their angles; the error of each phase function in
 * L1 is at most tolerance. 0, or -1 when memory ran out, or 1 where
 * these are more values than ANGLE_REFINEMENT_MOST, before they take time and memory. */
#define ANGLE_REFINEMENT_MOST 0x1p28
int angle_refinement_find(const struct phase_model *model, double tolerance, struct angle_refinement *a);

/* angle_refinement_free - close the spheres and forget the angles. */
void angle_refinement_free(const struct phase_model *model, struct angle_refinement *a);

#endif

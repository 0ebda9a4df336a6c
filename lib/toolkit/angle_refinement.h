/* angle_refinement - tables whose angles are chosen by the phase functions themselves, so that these may be taken as linear between them. */
#ifndef TOOLKIT_ANGLE_REFINEMENT_H
#define TOOLKIT_ANGLE_REFINEMENT_H

#include "toolkit/coeffs.h"

/* What is known of one particle once its waves are opened; a model puts more behind it. */
struct phase_state {
	double norm;                 /* p = (|S1|^2 + |S2|^2) / (2 norm): integral of (|S1|^2 + |S2|^2)/2 over the sphere */
	double q_sca;                /* scattering efficiency */
};

/* A model that can be asked again and again for angles of one particle. Several threads use it at once, each with waves and a
 * state of its own. */
struct phase_profile {
	/* open - get ready for some so many angles; may drop the coefficients of w, which has to stay. NULL when memory ran out. */
	struct phase_state *(*open)(const void *context, struct waves *w, size_t angles);
	/* at - amplitudes at theta[n] (degrees); 0, or -1 when memory ran out */
	int (*at)(const struct phase_state *s, int n, const double *theta, double complex *s1, double complex *s2);
	void (*close)(struct phase_state *s);
};

/* The wavelengths of a size, and angles that serve them all. */
struct adapted {
	struct waves *w;
	size_t nwaves;
	struct phase_state **state;  /* [nwaves] */
	long n;
	double *theta;               /* [n], degrees */
};

/* adapt - open w[nwaves] and find their angles; the error of each p in L1 is at most tolerance. 0, or -1 when memory ran out. */
int adapt(const struct phase_profile *profile, const void *context, double tolerance, struct adapted *a);

/* adapt_power - p[n] from amplitudes. */
void adapt_power(double norm, long n, const double complex *s1, const double complex *s2, double *p);

/* adapt_p - phase function at theta[n]; 0, or -1 when memory ran out. */
int adapt_p(const struct phase_profile *profile, const struct phase_state *s, long n, const double *theta, double *p);

/* adapt_free - close the waves and forget the angles. */
void adapt_free(const struct phase_profile *profile, struct adapted *a);

#endif

/* phase_model - how a sphere scatters, as the tools ask a theory for it: a sphere is opened, asked for angles, and closed. A
 * theory is a file of its own (phase_model_mie, phase_model_goa); what asks (phase_table, ensemble_average, angle_refinement)
 * knows none. */
#ifndef TOOLKIT_PHASE_MODEL_H
#define TOOLKIT_PHASE_MODEL_H

#include "toolkit/waves.h"

#include <stddef.h>

/* An open sphere; a theory puts more behind it. */
struct phase_sphere {
	/* good once the sphere was asked for angles: */
	double norm;             /* p = (|S1|^2 + |S2|^2) / (2 norm): integral of (|S1|^2 + |S2|^2)/2 over the sphere */
	double q_sca;            /* scattering efficiency */
	const char *method;      /* where the theory chooses one for each size, to be told; else NULL */
	double error;            /* its estimate */
};

struct phase_model {
	void *context;           /* the theory's */
	/* Whether an open sphere may be asked again and again, by several threads at once, for any angles. If not, it is asked once, for
	 * the angles it was opened for, and closed before its thread opens another. */
	int any_angles;
	int blurs;               /* whether it minds waves.blur */
	/* open - get ready for n angles theta[n] (degrees), of which only the number may be known (theta NULL) where any_angles. It
	 * may solve w and drop its coefficients; w has to stay. Threads open spheres at once. NULL when memory ran out. */
	struct phase_sphere *(*open)(void *context, struct waves *w, size_t n, const double *theta);
	/* at - amplitudes at theta[n]; 0, or -1 when memory ran out */
	int (*at)(struct phase_sphere *s, int n, const double *theta, double complex *s1, double complex *s2);
	void (*close)(struct phase_sphere *s);
};

/* What is tabulated, averaged and resolved by angles: elements of the phase matrix, sr^-1, by whose norm p integrates to 1 over
 * the sphere. For n angles they are held as value[element][n]. */
enum { PHASE_P, PHASE_ELEMENTS };

/* phase_model_elements - of amplitudes at n angles, value[PHASE_ELEMENTS][stride]. */
void phase_model_elements(double norm, int n, const double complex *s1, const double complex *s2, size_t stride, double *value);

/* phase_model_values - the same of an open sphere at theta[n]; 0, or -1 when memory ran out. */
int phase_model_values(const struct phase_model *model, struct phase_sphere *s, long n, const double *theta, size_t stride,
                       double *value);

/* phase_model_once - amplitudes of w at theta[n], and in *known what an open sphere would say; 0, or -1 when memory ran out. */
int phase_model_once(const struct phase_model *model, struct waves *w, int n, const double *theta, double complex *s1,
                     double complex *s2, struct phase_sphere *known);

#endif

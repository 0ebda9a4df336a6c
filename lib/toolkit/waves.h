/* waves - the partial waves of one sphere at one wavelength: read from a table, or to be computed. */
#ifndef TOOLKIT_WAVES_H
#define TOOLKIT_WAVES_H

#include "optics/mie/mie.h"
#include "toolkit/size.h"

struct waves {
	struct size size;            /* m is NaN where the waves were read */
	double blur;                 /* not 0: only the mean over neighbouring sizes is wanted, in which does not interfere what parts
	                              * by so many rad as x grows by 1; a theory may leave it out */
	double *carried;             /* values of the columns that are carried through, see spheres_carried */
	int lossless;                /* the particle does not absorb; n, a, b, lossless are good after waves_solve */
	int n;
	double complex *a, *b;       /* [n+1]; NULL: not solved yet */
};

/* waves_solve - have the coefficients; nothing to do where they were read. 0, or -1 when memory ran out. Threads may solve
 * different waves at once. */
int waves_solve(struct waves *w);

/* waves_efficiencies - of solved waves; *error, unless NULL, as of mie_efficiencies or, in a host that absorbs,
 * mie_host_efficiencies.
 * waves_norm - the integral of (|S1|^2 + |S2|^2)/2 over the sphere, given Q_sca. */
struct efficiencies waves_efficiencies(const struct waves *w, double *error);
double waves_norm(const struct waves *w, double q_sca);

/* waves_terms - how many partial waves there are, or will be. */
int waves_terms(const struct waves *w);

/* waves_drop - give back the coefficients; waves_free - these and the rest. */
void waves_drop(struct waves *w);
void waves_free(struct waves *w);

#endif

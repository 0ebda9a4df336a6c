/* method - which method when: Lorenz-Mie theory or an approximation that costs less. One table has the methods for efficiencies, one what
 * amplitudes cost; each cost with its origin (method.c). A method more is a row more. */
#ifndef OPTICS_METHOD_H
#define OPTICS_METHOD_H

#include "optics/mie/mie.h"

#include <stddef.h>

/* In the order of xsect's column. METHOD_AUTO: the first that serves, else METHOD_MIE. */
enum method { METHOD_AUTO, METHOD_MIE, METHOD_RAYLEIGH, METHOD_GOA, METHOD_CAM, METHOD_EVANS_FOURNIER, METHODS };

/* A homogeneous sphere in a host that does not absorb: size parameter, relative refractive index; ranges as in mie.h. */
struct sphere {
	double x;
	double complex m;
};

/* Sizes for which METHOD_AUTO may take a method: none; those up to, or from, the one at which its error reaches the tolerance. */
enum method_serves { METHOD_NEVER, METHOD_SMALL, METHOD_LARGE };

struct method_row {
	const char *name;            /* as in options */
	enum method_serves serves;
	double cost;                 /* of a sphere, in terms of Lorenz-Mie series: about the size from which on that costs more */
	double first, first_absorbing;    /* of prepare and all that extend does for an index, in the same */
	/* estimate of the larger of the relative errors of ext and sca and the absolute error of g: grows with x for small spheres, falls for
	 * large ones */
	double (*error)(double x, double complex m);
	/* prepared: of this index, where the method prepares anything; asked: by its name, not for what it costs. *error: the estimate,
	 * infinite when memory ran out */
	struct efficiencies (*efficiencies)(const struct sphere *s, const void *prepared, int asked, double *error);
	/* what is kept of an index, or NULL: made (NULL when memory ran out), made good for a size, freed */
	void *(*prepare)(double complex m);
	void (*extend)(void *prepared, double x);
	void (*forget)(void *prepared);
};

extern const struct method_row method_table[METHODS];

/* Amplitudes at many angles: Lorenz-Mie theory by sums or by a transform (mie_fast_amplitudes.h), or GOA+. */

#define METHOD_GOA_PLUS_ANGLES 100000    /* at most, by the memory its rays take */

/* method_transform_pays - whether a transform is expected to take less time than sums, for so many partial waves. */
int method_transform_pays(int terms, size_t angles);

/* method_goa_plus_pays - whether GOA+ serves a sphere within an error in L1 (goa_plus_error), and is expected to take less time than
 * Lorenz-Mie theory, rays being found once for some sizes of an index. It does not know how many there are: a size is computed alike
 * alone and among others. *error: the estimate, where it does. */
int method_goa_plus_pays(const struct sphere *s, int angles, double tolerance, double *error);

#endif

/* airy - the Airy functions and their derivatives. */
#ifndef OPTICS_AIRY_H
#define OPTICS_AIRY_H

#include "base/cmplx.h"

struct airy {
	double ai, aip, bi, bip;      /* Ai, Ai', Bi, Bi' */
};

/* airy_real - for real z. Error below 1e-7 of the modulus (Ai^2 + Bi^2)^(1/2) where z < 0, of the function where z > 0; Bi is
 * infinite beyond z = 100.
 * Source: Maclaurin series; Abramowitz and Stegun 10.4.59 - 10.4.67 for large |z|. */
struct airy airy_real(double z);

/* airy_ratio - Ai'/Ai for complex z. Error as above. Source: the same. */
double complex airy_ratio(double complex z);

#endif

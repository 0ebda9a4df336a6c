/* ior - refractive indices: a number, or a material by name. */
#ifndef OPTICS_IOR_H
#define OPTICS_IOR_H

#include <complex.h>
#include <stddef.h>

/* A table of data/materials, compiled in. */
struct material {
	const char *name, *source;
	const char *outside;         /* what ior_at says of a wavelength that the table does not reach; it gives the range */
	size_t n;
	const double *wavelength;    /* um, ascending */
	const double *re, *im;
};

extern const struct material materials[];
extern const size_t n_materials;
extern const char materials_unknown[];     /* what ior_parse says of an unknown name; it lists the known ones */

struct ior {
	const struct material *material;   /* NULL: a number */
	double complex value;
};

/* ior_parse - "1.33", "1.5+0.1i" or "1.5+0.1j", "1.5-0.1i" (refused, the message names the sign convention) or a material's name, in
 * upper or lower case. Returns NULL, or what is wrong. Re > 0, Im >= 0, both finite. */
const char *ior_parse(const char *text, struct ior *out);

/* ior_at - the index at a vacuum wavelength in um, linear in wavelength between the material's rows (the imaginary part
 * logarithmically where both ends are positive). Returns NULL, or what is wrong (outside the material's data). */
const char *ior_at(const struct ior *ior, double wavelength, double complex *out);

#endif

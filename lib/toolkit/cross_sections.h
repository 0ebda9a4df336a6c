/* cross_sections - cross sections of spheres, one by one and as means over sizes. */
#ifndef TOOLKIT_CROSS_SECTIONS_H
#define TOOLKIT_CROSS_SECTIONS_H

#include "optics/select/method_selection.h"
#include "toolkit/class_table.h"

struct cross_section {
	struct efficiencies q;     /* of a mean: over pi radius^2 of the size that it is a class of, or of an effective radius */
	double error;              /* estimate, the larger of the relative errors of ext and sca and the absolute error of g */
	enum method method;
};

/* cross_sections_of - n sizes. Those whose coefficients were read, and those in a host that absorbs, are for Lorenz-Mie theory, one
 * by one. Dies when memory ran out. */
void cross_sections_of(struct method_selection *selection, int n, struct waves *w, struct cross_section *out);

/* A mean over sizes: um^2, g weighted by sca, um^2 sr^-1. */
struct mean_section {
	double ext, sca, abs, g, back;
	double area, volume;       /* means of pi r^2 (um^2) and 4/3 pi r^3 (um^3) */
	double error;              /* as above; with what the quadrature and the classes leave open */
	double open;               /* that part of it which is the classes' */
	enum method method;        /* that served the largest size */
	long sizes;
};

/* cross_sections_classes - the mean of each class at a wavelength, out[classes]. cross_sections_average - that of all, by weight; where
 * the law is known it is the law's. Sizes are taken until the estimated error is at most tolerance, or 3e9 of size parameters. Return the
 * largest error of the quadrature alone. */
double cross_sections_classes(const struct class_table *t, size_t wave, struct method_selection *selection, double tolerance,
                              struct mean_section *out);
double cross_sections_average(const struct class_table *t, size_t wave, struct method_selection *selection, double tolerance,
                              struct mean_section *out);

#endif

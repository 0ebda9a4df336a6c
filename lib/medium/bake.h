/* bake - what a medium is filled with: a density and a size distribution, or particles. The classes must be set, and the shape
 * where it is given. All die on bad input, with the table and its row. */
#ifndef MEDIUM_BAKE_H
#define MEDIUM_BAKE_H

#include "medium/medium.h"

/* A density, or one of each class, and their integrals over the medium in m^3. */
struct bake_matter {
	size_t n;
	double *integral;
};

/* bake_density - the relative density of a .npy grid (path NULL: 1 everywhere), or those of classes.
 * longest: average it to so many voxels along the longest side; 0: as it is. The shape must be given. */
struct bake_matter bake_density(const char *path, int longest, struct medium *m);

/* bake_psd - expected counts by class from a table of radius (um) and weight (sum 1), at a concentration (m^-3) where the density
 * is 1, or of each class where its own is; of what bake_density gave, named density. Densities of classes are scaled to the integral that
 * struct medium wants. *exact: whether all radii are the classes' own. Returns the table's history. */
char *bake_psd(const char *path, double concentration, const struct bake_matter *matter, const char *density, struct medium *m, int *exact);

/* bake_visibility - the concentration (m^-3) of which things are seen so far away, where the density is 1, or by classes in the mean over the
 * medium: Koschmieder's law (1924) with a contrast of 2 %, extinction 3.912 / visibility at 550 nm, of which the host takes its part; linear
 * between wavelengths, or at the nearest one. After bake_psd with a concentration of 1, whose counts become those of the one returned. Sets
 * *wavelength (um) to where. Dies where there is no extinction, or the host alone takes more. */
double bake_visibility(double metres, struct medium *m, double *wavelength);

/* bake_particles - particles from a table of x, y, z (m) and radius (um), path NULL: standard input. bounded: the shape is
 * given, about the origin, and none may lie outside; else it becomes the bounding box, and the centre its middle. Returns the table's
 * history. */
char *bake_particles(const char *path, int bounded, struct medium *m);

#endif

/* class_table - a table of sizes read whole: its rows, and the size distribution of which they are classes. */
#ifndef TOOLKIT_CLASS_TABLE_H
#define TOOLKIT_CLASS_TABLE_H

#include "optics/sizes/size_density.h"
#include "toolkit/spheres.h"

struct class_row {
	struct waves w;
	double weight;
	int class;                 /* among the classes; -1: the size as it is */
	size_t wave;               /* among the wavelengths */
};

struct class_table {
	struct spheres *in;
	int ncarried;
	struct tab_col carried[TAB_COLS];  /* the columns that the rows carry */
	size_t n, waves;
	struct class_row *row;     /* [n], in the order of the table */
	struct size *wave;         /* [waves]: some size of each wavelength; others differ by radius, x and x_im */
	int classes;
	struct psd_class *class;   /* [classes], sorted by their limits */
	int has_law;
	struct psd law;
	struct size_density *density;      /* NULL: no classes */
};

/* class_table_in - whether a table's rows are classes: it has columns weight, radius_lo and radius_hi beside radius, and no coefficients,
 * which are those of the radius alone. */
int class_table_in(const struct spheres *in);

/* class_table_need - die unless there is a table with weights, radii and wavelengths, for --average. */
void class_table_need(const struct spheres *in);

/* class_table_read - read all. carried: as of spheres_carried, which has been asked. A row is a class where its limits differ, and its
 * weight is not 0; at_radius: none is. Dies where a row cannot be, where a class reaches out of a theory's range, or where a law does
 * not fit the rows. */
struct class_table *class_table_read(struct spheres *in, int ncarried, const struct tab_col *carried, int at_radius);
void class_table_free(struct class_table *t);

/* class_table_size - the size of a radius at a wavelength. */
struct size class_table_size(const struct class_table *t, size_t wave, double radius);

/* class_table_path - what to call it in messages. */
const char *class_table_path(const struct class_table *t);

#endif

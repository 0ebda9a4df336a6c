/* spheres - the input of an optics tool: one (size, wavelength) after the other, with the columns of its table that are carried
 * through, and its waves where coefficients are read. What can do with either (xsect, mie-phase) need not know which.
 * Everything dies at the first error. */
#ifndef TOOLKIT_SPHERES_H
#define TOOLKIT_SPHERES_H

#include "toolkit/sizes.h"
#include "toolkit/waves.h"

struct spheres;

/* spheres_open - the input of a tool that takes sizes or coefficients; for the latter, options of the former are refused.
 * spheres_open_sizes - the same for a tool that takes sizes only. */
struct spheres *spheres_open(const struct sizes_options *o, const char *operand);
struct spheres *spheres_open_sizes(const struct sizes_options *o, const char *operand);

/* spheres_table - the table in use, NULL where the options give the sizes. spheres_coeffs - its name where coefficients are
 * read, else NULL. spheres_history - its cmd lines, "" without one. spheres_law - as tab_law. */
struct tab *spheres_table(const struct spheres *s);
const char *spheres_coeffs(const struct spheres *s);
const char *spheres_history(const struct spheres *s);
const char *spheres_law(const struct spheres *s);

/* spheres_by_x - whether the key is x, not wavelength and radius. spheres_key_columns - the key's columns into cols;
 * spheres_key - its values into row. Return how many. */
int spheres_by_x(const struct spheres *s);
int spheres_key_columns(const struct spheres *s, struct tab_col *cols);
int spheres_key(const struct spheres *s, const struct size *size, double *row);

/* spheres_carried - the columns to carry into cols: the table's, less those named in own[nown], which the tool writes itself, and
 * coefficients; returns how many. Decides what waves.carried holds. spheres_carry - their values into row. */
int spheres_carried(struct spheres *s, int nown, const struct tab_col *own, struct tab_col *cols);
void spheres_carry(const struct spheres *s, const struct waves *w, double *row);

/* spheres_next - the next waves; 0 at the end. To be freed by waves_free. */
int spheres_next(struct spheres *s, struct waves *out);

/* spheres_batch - up to SPHERES_BATCH next waves, fewer where x is large, so that their coefficients together stay bounded in
 * memory; returns how many, 0 at the end. */
#define SPHERES_BATCH 2048
int spheres_batch(struct spheres *s, struct waves out[SPHERES_BATCH]);

/* spheres_extent - of the spheres read so far: the largest size parameter (its modulus); where mean, the root of the mean of its
 * square, weighted by the column weight, if there is one, and r^2: what counts for the forward peak of their mean. */
double spheres_extent(const struct spheres *s, int mean);

/* spheres_warn_classes - a line where coefficients that were read are of classes with limits: they are those of a class's
 * radius alone. */
void spheres_warn_classes(const struct spheres *s);

void spheres_close(struct spheres *s);

#endif

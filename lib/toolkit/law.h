/* law - the size distribution of which a table says that its rows are classes, tab(5). */
#ifndef TOOLKIT_LAW_H
#define TOOLKIT_LAW_H

#include "format/tab.h"
#include "optics/sizes/psd.h"

/* law_fits - the law of a table with classes, n of them, which are sorted, each once; 0 if it has none. Dies where it is no law, or not
 * that of the classes (psd_fits). */
int law_fits(const struct tab *t, struct psd *law, int *n, struct psd_class *c);

/* law_check - the same for who reads a table row by row, and sums over them: begin before the first, row after each, end after the last.
 * Without a law, or without the columns of classes, there is nothing to check. */
struct law_check;
struct law_check *law_check_begin(const struct tab *t);
void law_check_row(struct law_check *c, const double *row);
void law_check_end(struct law_check *c);

#endif

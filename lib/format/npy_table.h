/* npy_table - tables as NumPy structured arrays. */
#ifndef FORMAT_NPY_TABLE_H
#define FORMAT_NPY_TABLE_H

#include "format/tab.h"

#include <stdio.h>

/* npy_table_write - all rows of a table, of the n columns index[n], in format 1.0. Its header holds the number of rows, so the
 * rows wait in a temporary file. Dies where that fails. */
void npy_table_write(FILE *f, struct tab *t, int n, const int *index);

#endif

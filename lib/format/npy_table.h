/* npy_table - tables as NumPy structured arrays of one dimension, a field for each column. Everything dies at the first error. */
#ifndef FORMAT_NPY_TABLE_H
#define FORMAT_NPY_TABLE_H

#include "format/tab.h"

#include <stdio.h>

/* npy_table_write - all rows of a table, of the n columns index[n], in format 1.0. Its header holds the number of rows, so the
 * rows wait in a temporary file. Dies where that fails. */
void npy_table_write(FILE *f, struct tab *t, int n, const int *index);

struct npy_table;

/* npy_table_open - begin to read; f remains the caller's, path is for messages. Fields are numbers: integers of 1 to 8 bytes,
 * floats of 4 or 8, little-endian. */
struct npy_table *npy_table_open(FILE *f, const char *path);

/* npy_table_columns - what the fields name, n: i32 and f32 where that holds them all, else f64; units are "1", for the caller to
 * know better. */
struct tab_col *npy_table_columns(struct npy_table *t, int *n);

/* npy_table_next - the next row; 0 at the end. Dies where an integer has no double. */
int npy_table_next(struct npy_table *t, double *row);

void npy_table_close(struct npy_table *t);

#endif

/* csv - tables as comma-separated values: a first line of names, then rows of numbers. Fields may stand in double quotes, "" for a
 * quote, or have blanks around them; lines end in CR LF or LF, the last one, too. A byte order mark is the caller's to skip.
 * Everything dies at the first error, with its line and column. */
#ifndef FORMAT_CSV_H
#define FORMAT_CSV_H

#include "format/tab.h"

#include <stdio.h>

struct csv;

/* csv_open - begin to read; f remains the caller's, path is for messages. A first line that names no columns is refused: each name
 * is a column's (tab.h), and not a number. NULL where it is "ply", after which a PLY file goes on. */
struct csv *csv_open(FILE *f, const char *path);

/* csv_columns - what the first line names, n, as f64; units are "1", for the caller to know better. */
struct tab_col *csv_columns(struct csv *t, int *n);

/* csv_next - the next row; 0 at the end. */
int csv_next(struct csv *t, double *row);

void csv_close(struct csv *t);

#endif

/* ply - the vertices of a PLY file (Turk 1994) as a table: ASCII, or binary of either order of bytes. Their properties are its columns;
 * lists among them, elements before them and all that comes after them are passed over. Everything dies at the first error. */
#ifndef FORMAT_PLY_H
#define FORMAT_PLY_H

#include "format/tab.h"

#include <stdio.h>

struct ply;

/* ply_open - begin to read behind the first line, "ply"; f remains the caller's, path is for messages. */
struct ply *ply_open(FILE *f, const char *path);

/* ply_columns - the properties, n; units are "1", for the caller to know better. */
struct tab_col *ply_columns(struct ply *t, int *n);

/* ply_next - the next vertex; 0 at the end. Dies where there are fewer than the file says, or an integer has no double. */
int ply_next(struct ply *t, double *row);

void ply_close(struct ply *t);

#endif

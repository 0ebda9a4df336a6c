/* tab_import - tables as other programs hand them over: the text of tabtxt, CSV, NumPy or PLY, told apart by how they begin ('#', the
 * magic number of NumPy, a line "ply", anything else is CSV; a UTF-8 byte order mark is skipped). Everything dies at the first error. */
#ifndef FORMAT_TAB_IMPORT_H
#define FORMAT_TAB_IMPORT_H

#include "format/tab.h"

struct tab_import;

/* tab_import_open - begin to read (path NULL or "-": standard input).
 * Given: units  NAME=UNIT,.. for columns of CSV, NumPy and PLY, which have none of their own; or NULL. A column that it leaves out has
 *               the unit of format/columns.h, where x is a size parameter unless y or z stands beside it; others have 1. */
struct tab_import *tab_import_open(const char *path, const char *units);

const struct tab_col *tab_import_columns(const struct tab_import *t, int *n);

/* tab_import_law - the law of the text of tabtxt, or NULL. */
const char *tab_import_law(const struct tab_import *t);

/* tab_import_next - the next row; 0 at the end. */
int tab_import_next(struct tab_import *t, double *row);

void tab_import_close(struct tab_import *t);

#endif

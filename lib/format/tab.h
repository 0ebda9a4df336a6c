/* tab - the table stream of tab(5), both directions. Memory does not grow with the rows.
 *
 * Rows are handed over as doubles, one a column, whatever the type in the stream (f64, f32 and i32 all fit exactly).
 * Everything dies at the first error. */
#ifndef FORMAT_TAB_H
#define FORMAT_TAB_H

#include "format/limits.h"

#include <stddef.h>
#include <stdint.h>

enum tab_type { TAB_I32, TAB_F32, TAB_F64 };

struct tab_col {
	char name[TAB_NAME];     /* letters, digits, _ */
	enum tab_type type;
	char unit[TAB_NAME];     /* "1" if none */
};

struct tab;

/* tab_open - open a table (path NULL or "-": standard input) and read its header. Tables up to 1 MiB are verified whole here. */
struct tab *tab_open(const char *path);

/* tab_path - what to call it in messages. */
const char *tab_path(const struct tab *t);

/* tab_history - the cmd lines, oldest first, each ending in a newline. */
const char *tab_history(const struct tab *t);

/* tab_law - the line that names the size distribution of which the rows are classes, as psd_print writes it (optics/sizes/psd_text.h);
 * NULL if there is none. */
const char *tab_law(const struct tab *t);

int tab_ncols(const struct tab *t);
const struct tab_col *tab_cols(const struct tab *t);

/* tab_find - index of the column of that name, -1 if there is none; dies when its unit is another. */
int tab_find(const struct tab *t, const struct tab_col *col);

/* tab_need - the same, dies when there is none. */
int tab_need(const struct tab *t, const struct tab_col *col);

/* tab_next - the next row into row[tab_ncols]; 0 at the end of a table that is whole. */
int tab_next(struct tab *t, double *row);

/* tab_row - number of the row last read, from 1, for messages. */
uint64_t tab_row(const struct tab *t);

void tab_close(struct tab *t);

/* tab_join - the lines of several histories (the last argument is NULL), each once, each ending in a newline: tables that meet
 * again share their first programs. Dies where there are more than HISTORY_LINES. */
char *tab_join(const char *first, ...) __attribute__((sentinel));

struct tab_out;

/* tab_create - begin a table (path NULL or "-": standard output).
 * Given: history  earlier cmd lines, each ending in a newline (several tables' may be joined), or ""
 *        command  this program's own line
 *        law      that of the rows handed through, or NULL */
struct tab_out *tab_create(const char *path, const char *history, const char *command, const char *law, int ncols,
                           const struct tab_col *cols);

/* tab_put - append a row; dies when a value does not fit an i32 or f32 column. */
void tab_put(struct tab_out *t, const double *row);

/* tab_finish - write the end mark and close. */
void tab_finish(struct tab_out *t);

/* tab_type_name - "i32", "f32", "f64"; tab_type_parse - the type, or -1. */
const char *tab_type_name(enum tab_type type);
int tab_type_parse(const char *name);
static inline size_t tab_type_size(enum tab_type type) { return type == TAB_F64 ? 8 : 4; }

/* tab_law_valid - NULL, or what is wrong with a line for a law: it is printable text, not empty, without tabs. */
const char *tab_law_valid(const char *law);

/* tab_col_valid - NULL, or what is wrong with a column's name or unit. */
const char *tab_col_valid(const struct tab_col *col);

#endif

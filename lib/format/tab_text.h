/* tab_text - tables as text: "# name:type:unit" for each column in the first line, there too "law=.." where the table has one, then
 * the rows, all with tabs between; or CSV, which has the names alone. Everything dies at the first error, with its line. */
#ifndef FORMAT_TAB_TEXT_H
#define FORMAT_TAB_TEXT_H

#include "format/tab.h"

#include <stdio.h>

/* tab_text_write - all rows of a table, of the n columns index[n]. Numbers are the shortest that are read back to the same
 * bits. */
void tab_text_write(FILE *f, struct tab *t, int n, const int *index, int csv);

struct tab_text;

/* tab_text_open - begin to read a text, not CSV; f remains the caller's, path is for messages. tab_text_columns - what its first
 * line names, n. */
struct tab_text *tab_text_open(FILE *f, const char *path);
const struct tab_col *tab_text_columns(const struct tab_text *t, int *n);

/* tab_text_law - the law there, or NULL. */
const char *tab_text_law(const struct tab_text *t);

/* tab_text_next - the next row; 0 at the end. */
int tab_text_next(struct tab_text *t, double *row);

void tab_text_close(struct tab_text *t);

#endif

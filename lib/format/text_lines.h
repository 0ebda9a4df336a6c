/* text_lines - a text of numbers line by line, for readers of tables. Everything dies at the first error, with its line. */
#ifndef FORMAT_TEXT_LINES_H
#define FORMAT_TEXT_LINES_H

#include <stddef.h>
#include <stdio.h>

struct text_lines {
	FILE *f;
	const char *path;        /* for messages */
	char *line;              /* without its newline; from malloc */
	size_t room;
	long number;             /* of the line, from 1 */
};

/* text_lines_next - read the next line; 0 at the end of the file. Dies where a line has a NUL byte or no newline. */
int text_lines_next(struct text_lines *t);

/* text_lines_number - the number that a word is, all of it, in C notation; inf and nan, too. Dies, with line and column. */
double text_lines_number(const struct text_lines *t, const char *column, const char *word);

#endif

#include "format/text_lines.h"

#include "base/die.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

int text_lines_next(struct text_lines *t)
{
	ssize_t length = getline(&t->line, &t->room, t->f);
	if (length < 0) {
		if (!feof(t->f))           /* also where there is no memory for a line */
			die(t->path, "cannot read:");
		return 0;
	}
	t->number++;
	if (memchr(t->line, 0, (size_t)length))
		die(t->path, "line %ld: has a NUL byte", t->number);
	if (!length || t->line[length - 1] != '\n')
		die(t->path, "line %ld: is cut short (no newline)", t->number);
	t->line[length - 1] = 0;
	return 1;
}

double text_lines_number(const struct text_lines *t, const char *column, const char *word)
{
	char *end;
	errno = 0;
	double v = strtod(word, &end);
	if (end == word || *end || *word == ' ' || strpbrk(word, "xX"))
		die(t->path, "line %ld: column %s: '%s' is not a number", t->number, column, word);
	if (isinf(v) && errno == ERANGE)
		die(t->path, "line %ld: column %s: '%s' is too large", t->number, column, word);
	return v;
}

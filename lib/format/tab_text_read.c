#include "format/tab_text.h"

#include "base/die.h"
#include "base/standard.h"
#include "format/limits.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct tab_text {
	FILE *f;
	const char *path;        /* for messages */
	int n;
	struct tab_col cols[TAB_COLS];
	char *law;
	char *line;
	size_t room;
	long number;             /* of the line */
};

/* "# name:type:unit<TAB>name:type:unit...<TAB>law=..", the law if there is one. */
static int columns(const char *path, char *line, struct tab_col *cols, char **law)
{
	int n = 0;
	char *save = NULL;
	if (strncmp(line, "# ", 2))
		die(path, "line 1: must name the columns, like '# radius:f64:um<TAB>weight:f64:1'");
	for (char *word = strtok_r(line + 2, "\t", &save); word; word = strtok_r(NULL, "\t", &save), n++) {
		if (!strncmp(word, "law=", 4)) {
			const char *bad = *law ? "a law stands twice" : tab_law_valid(word + 4);
			if (bad)
				die(path, "line 1: %s", bad);
			*law = xtext("%s", word + 4);
			n--;
			continue;
		}
		char *type = strchr(word, ':'), *unit = type ? strchr(type + 1, ':') : NULL;
		if (n == TAB_COLS)
			die(path, "line 1: more than %d columns", TAB_COLS);
		if (!unit)
			die(path, "line 1: '%s' is not name:type:unit", word);
		*type++ = *unit++ = 0;
		int code = tab_type_parse(type);
		if (code < 0)
			die(path, "line 1: column %s: type '%s' is none of i32, f32, f64", word, type);
		if (strlen(word) >= TAB_NAME || strlen(unit) >= TAB_NAME)
			die(path, "line 1: column %s: name or unit too long", word);
		cols[n].type = (enum tab_type)code;
		strcpy(cols[n].name, word);
		strcpy(cols[n].unit, unit);
		const char *bad = tab_col_valid(&cols[n]);
		if (bad)
			die(path, "line 1: column %s: %s", word, bad);
	}
	if (!n)
		die(path, "line 1: names no columns");
	return n;
}

static void values(const char *path, long number, char *line, int n, const struct tab_col *cols, double *out)
{
	char *c = line;
	for (int i = 0; i < n; i++) {
		char *tab = strchr(c, '\t'), *end;
		if (!tab != (i == n - 1))
			die(path, "line %ld: %s than %d columns", number, tab ? "more" : "fewer", n);
		if (tab)
			*tab = 0;
		errno = 0;
		out[i] = strtod(c, &end);
		if (end == c || *end || *c == ' ' || strpbrk(c, "xX"))
			die(path, "line %ld: column %s: '%s' is not a number", number, cols[i].name, c);
		if (isinf(out[i]) && errno == ERANGE)
			die(path, "line %ld: column %s: '%s' is too large", number, cols[i].name, c);
		c = tab + 1;
	}
}

/* The next line, without its end; 0 at the end of the file. */
static int next_line(struct tab_text *t)
{
	ssize_t length = getline(&t->line, &t->room, t->f);
	if (length < 0) {
		if (ferror(t->f))
			die(t->path, "cannot read:");
		return 0;
	}
	t->number++;
	if (memchr(t->line, 0, (size_t)length))
		die(t->path, "line %ld: has a NUL byte", t->number);
	if (!length || t->line[length - 1] != '\n')
		die(t->path, "line %ld: is cut short (no newline)", t->number);
	t->line[length - 1] = 0;
	if (length > 1 && t->line[length - 2] == '\r')
		die(t->path, "line %ld: ends in a carriage return; lines end in a newline alone", t->number);
	return 1;
}

struct tab_text *tab_text_open(const char *path)
{
	struct tab_text *t = xalloc(1, sizeof *t);
	t->path = standard_input(path);
	t->f = standard(path) ? stdin : fopen(path, "r");
	if (!t->f)
		die(t->path, "cannot open:");
	if (!next_line(t))
		die(t->path, "is empty");
	t->n = columns(t->path, t->line, t->cols, &t->law);
	return t;
}

const struct tab_col *tab_text_columns(const struct tab_text *t, int *n)
{
	*n = t->n;
	return t->cols;
}

const char *tab_text_law(const struct tab_text *t) { return t->law; }

int tab_text_next(struct tab_text *t, double *row)
{
	if (!next_line(t))
		return 0;
	values(t->path, t->number, t->line, t->n, t->cols, row);
	return 1;
}

void tab_text_close(struct tab_text *t)
{
	if (t->f != stdin)
		fclose(t->f);
	free(t->law);
	free(t->line);
	free(t);
}

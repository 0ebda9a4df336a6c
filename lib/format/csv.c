#include "format/csv.h"

#include "base/die.h"
#include "format/limits.h"
#include "format/text_lines.h"

#include <stdlib.h>
#include <string.h>

#define BLANKS " \t"

struct csv {
	struct text_lines in;
	int n;
	struct tab_col cols[TAB_COLS];
};

/* The next field of a line, unquoted in place, and *rest: what follows its comma, or NULL behind the last. */
static char *field(const struct text_lines *in, int number, char *c, char **rest)
{
	c += strspn(c, BLANKS);
	char *start = c, *end = c;
	if (*c == '"') {
		for (c++; *c && (*c != '"' || c[1] == '"'); c++) {
			c += *c == '"';
			*end++ = *c;
		}
		if (!*c)
			die(in->path, "line %ld: column %d: its quote does not end", in->number, number);
		c++;
		c += strspn(c, BLANKS);
		if (*c && *c != ',')
			die(in->path, "line %ld: column %d: has text after its quote", in->number, number);
	} else {
		c += strcspn(c, ",");
		for (end = c; end > start && strchr(BLANKS, end[-1]); end--)
			;
	}
	*rest = *c ? c + 1 : NULL;
	*end = 0;
	return start;
}

static int next_line(struct text_lines *t)
{
	if (!text_lines_next(t))
		return 0;
	size_t length = strlen(t->line);
	if (length && t->line[length - 1] == '\r')
		t->line[length - 1] = 0;
	return 1;
}

static void name(struct csv *t, const char *word)
{
	struct tab_col *col = &t->cols[t->n];
	char *end;
	strtod(word, &end);
	if (*word && !*end)
		die(t->in.path, "line 1: must name the columns; '%s' is a number", word);
	if (t->n == TAB_COLS)
		die(t->in.path, "line 1: more than %d columns", TAB_COLS);
	if (strlen(word) >= TAB_NAME)
		die(t->in.path, "line 1: must name the columns; column %d: name too long", t->n + 1);
	col->type = TAB_F64;
	strcpy(col->name, word);
	strcpy(col->unit, "1");
	const char *bad = tab_col_valid(col);
	if (bad)
		die(t->in.path, "line 1: must name the columns, as CSV or like '# radius:f64:um<TAB>weight:f64:1'; column %d, '%s': %s", t->n + 1,
		    word, bad);
	for (int i = 0; i < t->n; i++)
		if (!strcmp(t->cols[i].name, word))
			die(t->in.path, "line 1: column %s stands twice", word);
	t->n++;
}

struct csv *csv_open(FILE *f, const char *path)
{
	struct csv *t = xalloc(1, sizeof *t);
	t->in = (struct text_lines){ .f = f, .path = path };
	if (!next_line(&t->in))
		die(path, "is empty");
	if (!strcmp(t->in.line, "ply")) {
		csv_close(t);
		return NULL;
	}
	for (char *rest = t->in.line; rest;)
		name(t, field(&t->in, t->n + 1, rest, &rest));
	return t;
}

struct tab_col *csv_columns(struct csv *t, int *n)
{
	*n = t->n;
	return t->cols;
}

int csv_next(struct csv *t, double *row)
{
	if (!next_line(&t->in))
		return 0;
	char *rest = t->in.line;
	for (int i = 0; i < t->n; i++) {
		if (!rest)
			die(t->in.path, "line %ld: fewer than %d columns: no %s", t->in.number, t->n, t->cols[i].name);
		char *word = field(&t->in, i + 1, rest, &rest);
		if (!*word)
			die(t->in.path, "line %ld: column %s: is empty", t->in.number, t->cols[i].name);
		row[i] = text_lines_number(&t->in, t->cols[i].name, word);
	}
	if (rest)
		die(t->in.path, "line %ld: more than %d columns", t->in.number, t->n);
	return 1;
}

void csv_close(struct csv *t)
{
	free(t->in.line);
	free(t);
}

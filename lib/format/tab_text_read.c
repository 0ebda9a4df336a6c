#include "format/tab_text.h"

#include "base/die.h"
#include "format/limits.h"
#include "format/text_lines.h"

#include <stdlib.h>
#include <string.h>

struct tab_text {
	struct text_lines in;
	int n;
	struct tab_col cols[TAB_COLS];
	char *law;
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

static int next_line(struct text_lines *t)
{
	if (!text_lines_next(t))
		return 0;
	size_t length = strlen(t->line);
	if (length && t->line[length - 1] == '\r')
		die(t->path, "line %ld: ends in a carriage return; lines end in a newline alone", t->number);
	return 1;
}

struct tab_text *tab_text_open(FILE *f, const char *path)
{
	struct tab_text *t = xalloc(1, sizeof *t);
	t->in = (struct text_lines){ .f = f, .path = path };
	next_line(&t->in);
	t->n = columns(path, t->in.line, t->cols, &t->law);
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
	if (!next_line(&t->in))
		return 0;
	char *c = t->in.line;
	for (int i = 0; i < t->n; i++) {
		char *tab = strchr(c, '\t');
		if (!tab != (i == t->n - 1))
			die(t->in.path, "line %ld: %s than %d columns", t->in.number, tab ? "more" : "fewer", t->n);
		if (tab)
			*tab = 0;
		row[i] = text_lines_number(&t->in, t->cols[i].name, c);
		c = tab + 1;
	}
	return 1;
}

void tab_text_close(struct tab_text *t)
{
	free(t->law);
	free(t->in.line);
	free(t);
}

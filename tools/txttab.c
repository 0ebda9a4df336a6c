/* txttab - text to a table: what tabtxt prints, read back. */
#include "base/die.h"
#include "base/opt.h"
#include "format/tab.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* "# name:type:unit<TAB>name:type:unit..." */
static int columns(const char *path, char *line, struct tab_col *cols)
{
	int n = 0;
	char *save = NULL;
	if (strncmp(line, "# ", 2))
		die(path, "line 1: must name the columns, like '# radius:f64:um<TAB>weight:f64:1'");
	for (char *word = strtok_r(line + 2, "\t", &save); word; word = strtok_r(NULL, "\t", &save), n++) {
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

static void row(const char *path, long number, char *line, int n, const struct tab_col *cols, double *out)
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

int main(int argc, char **argv)
{
	const char *output = NULL;
	const struct opt opts[] = { OPT_OUTPUT(&output), OPT_END };
	const struct opt_tool tool = { "[-o FILE] [TEXT]", "Read a table as text, as tabtxt writes it.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one input at most");
	const char *path = args.n && strcmp(args.operand[0], "-") ? args.operand[0] : NULL;
	FILE *f = path ? fopen(path, "r") : stdin;
	if (!path)
		path = "standard input";
	if (!f)
		die(path, "cannot open:");

	char *line = NULL;
	size_t size = 0;
	struct tab_out *out = NULL;
	struct tab_col cols[TAB_COLS];
	double values[TAB_COLS];
	int n = 0;
	long number = 0;
	for (ssize_t length; (length = getline(&line, &size, f)) >= 0;) {
		if (memchr(line, 0, (size_t)length))
			die(path, "line %ld: has a NUL byte", number + 1);
		if (!length || line[length - 1] != '\n')
			die(path, "line %ld: is cut short (no newline)", number + 1);
		line[length - 1] = 0;
		if (length > 1 && line[length - 2] == '\r')
			die(path, "line %ld: ends in a carriage return; lines end in a newline alone", number + 1);
		if (!number++) {
			n = columns(path, line, cols);
			out = tab_create(output, "", args.history, n, cols);
			continue;
		}
		row(path, number, line, n, cols, values);
		tab_put(out, values);
	}
	if (ferror(f))
		die(path, "cannot read:");
	if (!out)
		die(path, "is empty");
	tab_finish(out);
	free(line);
	return 0;
}

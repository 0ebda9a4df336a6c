#include "format/tab.h"

#include "base/die.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static const char *const type_names[] = { "i32", "f32", "f64" };

const char *tab_type_name(enum tab_type type)
{
	return type_names[type];
}

int tab_type_parse(const char *name)
{
	for (int i = 0; i < 3; i++)
		if (!strcmp(name, type_names[i]))
			return i;
	return -1;
}

const char *tab_col_valid(const struct tab_col *col)
{
	if (!col->name[0] || col->name[strspn(col->name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_")])
		return "a column's name is letters, digits and _";
	if (!col->unit[0])
		return "a column needs a unit (1 if it has none)";
	for (const char *c = col->unit; *c; c++)
		if (*c <= ' ' || *c > '~' || *c == ':')
			return "a unit is printable, without spaces or colons";
	return NULL;
}

const char *tab_law_valid(const char *law)
{
	for (const char *c = law; *c; c++)
		if (*c < ' ' || *c > '~')
			return "a law is printable text";
	return *law ? NULL : "a law is not empty";
}

char *tab_join(const char *first, ...)
{
	char *kept = xtext("\n");
	int lines = 0;
	va_list args;
	va_start(args, first);
	for (const char *text = first; text; text = va_arg(args, const char *)) {
		char *copy = xtext("%s", text), *save = NULL;
		for (char *line = strtok_r(copy, "\n", &save); line; line = strtok_r(NULL, "\n", &save)) {
			char *framed = xtext("\n%s\n", line);
			if (!strstr(kept, framed)) {
				if (++lines > HISTORY_LINES)
					die("history", "is of more than %d commands", HISTORY_LINES);
				xappend(&kept, "%s\n", line);
			}
			free(framed);
		}
		free(copy);
	}
	va_end(args);
	memmove(kept, kept + 1, strlen(kept));
	return kept;
}

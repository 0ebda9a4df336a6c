#include "format/ply.h"

#include "base/die.h"
#include "format/binary_number.h"
#include "format/text_lines.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PROPERTIES 256           /* of all elements */
#define ELEMENTS 64

enum order { ASCII, LITTLE, BIG };

struct property {
	char name[TAB_NAME];
	int list;
	struct binary_number count, value;    /* count: of a list's values */
};

struct element {
	char name[TAB_NAME];
	uint64_t number;
	int first, n;                /* properties */
};

struct ply {
	struct text_lines in;
	enum order order;
	int n_elements, n_properties, n_cols;
	struct element element[ELEMENTS];
	struct property property[PROPERTIES];
	struct tab_col cols[TAB_COLS];
	const struct element *vertices;
	uint64_t at;
};

static struct binary_number number_of(const struct ply *t, const char *word)
{
	static const struct { const char *name[2]; struct binary_number number; } types[] = {
		{ { "char", "int8" }, { 'i', 1 } }, { { "uchar", "uint8" }, { 'u', 1 } }, { { "short", "int16" }, { 'i', 2 } },
		{ { "ushort", "uint16" }, { 'u', 2 } }, { { "int", "int32" }, { 'i', 4 } }, { { "uint", "uint32" }, { 'u', 4 } },
		{ { "float", "float32" }, { 'f', 4 } }, { { "double", "float64" }, { 'f', 8 } },
	};
	for (size_t i = 0; word && i < sizeof types / sizeof *types; i++)
		if (!strcmp(word, types[i].name[0]) || !strcmp(word, types[i].name[1]))
			return types[i].number;
	die(t->in.path, "line %ld: '%s' is no type of a property", t->in.number, word ? word : "");
}

static void name_into(const struct ply *t, const char *word, char name[TAB_NAME])
{
	if (!word || strlen(word) >= TAB_NAME)
		die(t->in.path, "line %ld: needs a name of at most %d bytes", t->in.number, TAB_NAME - 1);
	strcpy(name, word);
}

static void format(struct ply *t, const char *word)
{
	static const char *const names[] = { "ascii", "binary_little_endian", "binary_big_endian" };
	for (int i = 0; word && i < 3; i++)
		if (!strcmp(word, names[i])) {
			t->order = (enum order)i;
			return;
		}
	die(t->in.path, "line %ld: the format is ascii, binary_little_endian or binary_big_endian", t->in.number);
}

static void element(struct ply *t, const char *name, const char *number)
{
	char *end;
	if (t->n_elements == ELEMENTS)
		die(t->in.path, "line %ld: more than %d elements", t->in.number, ELEMENTS);
	struct element *e = &t->element[t->n_elements++];
	name_into(t, name, e->name);
	if (!number || strspn(number, "0123456789") != strlen(number) || !*number || strlen(number) > 18)
		die(t->in.path, "line %ld: how many of element %s?", t->in.number, e->name);
	e->number = strtoull(number, &end, 10);
	e->first = t->n_properties;
}

static void property(struct ply *t, char **save)
{
	const char *type = strtok_r(NULL, " \t", save);
	if (!t->n_elements)
		die(t->in.path, "line %ld: a property of no element", t->in.number);
	if (t->n_properties == PROPERTIES)
		die(t->in.path, "line %ld: more than %d properties", t->in.number, PROPERTIES);
	struct property *p = &t->property[t->n_properties++];
	p->list = type && !strcmp(type, "list");
	if (p->list) {
		p->count = number_of(t, strtok_r(NULL, " \t", save));
		type = strtok_r(NULL, " \t", save);
		if (p->count.kind == 'f')
			die(t->in.path, "line %ld: a list's length is a whole number", t->in.number);
	}
	p->value = number_of(t, type);
	name_into(t, strtok_r(NULL, " \t", save), p->name);
	t->element[t->n_elements - 1].n++;
}

static void header(struct ply *t)
{
	int known = 0;
	while (text_lines_next(&t->in)) {
		char *save = NULL;
		t->in.line[strcspn(t->in.line, "\r")] = 0;
		const char *word = strtok_r(t->in.line, " \t", &save);
		if (!word || !strcmp(word, "comment") || !strcmp(word, "obj_info"))
			continue;
		if (!strcmp(word, "end_header")) {
			if (!known)
				die(t->in.path, "has no line with its format");
			return;
		}
		if (!strcmp(word, "format")) {
			format(t, strtok_r(NULL, " \t", &save));
			known = 1;
		} else if (!strcmp(word, "element")) {
			const char *name = strtok_r(NULL, " \t", &save);
			element(t, name, strtok_r(NULL, " \t", &save));
		} else if (!strcmp(word, "property")) {
			property(t, &save);
		} else {
			die(t->in.path, "line %ld: '%.20s' is unknown in a header", t->in.number, word);
		}
	}
	die(t->in.path, "its header has no end");
}

/* The vertices' properties as columns. */
static void columns(struct ply *t)
{
	for (int i = 0; i < t->n_elements && !t->vertices; i++)
		if (!strcmp(t->element[i].name, "vertex"))
			t->vertices = &t->element[i];
	if (!t->vertices)
		die(t->in.path, "has no vertices");
	for (int i = 0; i < t->vertices->n; i++) {
		const struct property *p = &t->property[t->vertices->first + i];
		if (p->list)
			continue;
		if (t->n_cols == TAB_COLS)
			die(t->in.path, "vertices have more than %d properties", TAB_COLS);
		struct tab_col *col = &t->cols[t->n_cols];
		strcpy(col->name, p->name);
		strcpy(col->unit, "1");
		col->type = binary_number_column(p->value);
		const char *bad = tab_col_valid(col);
		if (bad)
			die(t->in.path, "property '%s': %s", p->name, bad);
		for (int k = 0; k < t->n_cols; k++)
			if (!strcmp(t->cols[k].name, p->name))
				die(t->in.path, "property %s stands twice", p->name);
		t->n_cols++;
	}
	if (!t->n_cols)
		die(t->in.path, "its vertices have no properties");
}

static void cut_short(const struct ply *t, const struct element *e, uint64_t at)
{
	die(t->in.path, "is cut short: it says %llu of element %s, and has %llu", (unsigned long long)e->number, e->name, (unsigned long long)at);
}

/* A number of a binary file. */
static double take(struct ply *t, const struct element *e, uint64_t at, const struct property *p, struct binary_number n)
{
	unsigned char bytes[8];
	double v = 0;
	if (fread(bytes, (size_t)n.bytes, 1, t->in.f) != 1) {
		if (ferror(t->in.f))
			die(t->in.path, "cannot read:");
		cut_short(t, e, at);
	}
	if (!binary_number_value(n, bytes, t->order == BIG, &v))
		die(t->in.path, "%s %llu: %s: an integer beyond 2^53", e->name, (unsigned long long)at + 1, p->name);
	return v;
}

static void read_binary(struct ply *t, const struct element *e, uint64_t at, double *row)
{
	for (int i = 0; i < e->n; i++) {
		const struct property *p = &t->property[e->first + i];
		if (!p->list) {
			double v = take(t, e, at, p, p->value);
			if (row)
				*row++ = v;
			continue;
		}
		double length = take(t, e, at, p, p->count);
		if (length < 0)
			die(t->in.path, "%s %llu: list %s has a length of %g", e->name, (unsigned long long)at + 1, p->name, length);
		for (double k = 0; k < length; k++)
			take(t, e, at, p, p->value);
	}
}

static void read_ascii(struct ply *t, const struct element *e, uint64_t at, double *row)
{
	if (!text_lines_next(&t->in))
		cut_short(t, e, at);
	char *save = NULL, *line = t->in.line;
	if (!row)                        /* passed over, whatever it has */
		return;
	line[strcspn(line, "\r")] = 0;
	const char *word = strtok_r(line, " \t", &save);
	for (int i = 0; i < e->n; i++) {
		const struct property *p = &t->property[e->first + i];
		double v = text_lines_number(&t->in, p->name, word ? word : "");
		if (!p->list)
			*row++ = v;
		else if (!(v >= 0 && v == floor(v)))
			die(t->in.path, "line %ld: list %s has a length of %g", t->in.number, p->name, v);
		for (double k = 0; p->list && k < v; k++)
			if (!(word = strtok_r(NULL, " \t", &save)))
				die(t->in.path, "line %ld: list %s is cut short", t->in.number, p->name);
		word = strtok_r(NULL, " \t", &save);
	}
	if (word)
		die(t->in.path, "line %ld: has more than the %d properties of a vertex", t->in.number, e->n);
}

static void take_element(struct ply *t, const struct element *e, uint64_t at, double *row)
{
	if (t->order == ASCII)
		read_ascii(t, e, at, row);
	else
		read_binary(t, e, at, row);
}

struct ply *ply_open(FILE *f, const char *path)
{
	struct ply *t = xalloc(1, sizeof *t);
	t->in = (struct text_lines){ .f = f, .path = path, .number = 1 };
	header(t);
	columns(t);
	for (const struct element *e = t->element; e < t->vertices; e++)
		for (uint64_t i = 0; i < e->number && (e->n || t->order == ASCII); i++)    /* without properties there are no bytes, but lines */
			take_element(t, e, i, NULL);
	return t;
}

struct tab_col *ply_columns(struct ply *t, int *n)
{
	*n = t->n_cols;
	return t->cols;
}

int ply_next(struct ply *t, double *row)
{
	if (t->at == t->vertices->number)
		return 0;
	take_element(t, t->vertices, t->at++, row);
	return 1;
}

void ply_close(struct ply *t)
{
	free(t->in.line);
	free(t);
}

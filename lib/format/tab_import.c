#include "format/tab_import.h"

#include "base/die.h"
#include "base/standard.h"
#include "format/columns.h"
#include "format/csv.h"
#include "format/npy_table.h"
#include "format/ply.h"
#include "format/tab_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct tab_import {
	FILE *f;
	int n;
	const struct tab_col *cols;
	struct tab_text *text;    /* one of these reads */
	struct csv *csv;
	struct npy_table *npy;
	struct ply *ply;
};

static int find(int n, const struct tab_col *cols, const char *name)
{
	int i = 0;
	while (i < n && strcmp(cols[i].name, name))
		i++;
	return i < n ? i : -1;
}

/* The units that the tools' own columns have. */
static void usual_units(int n, struct tab_col *cols)
{
	static const struct tab_col *const known[] = { COLUMNS };
	int placed = find(n, cols, "y") >= 0 || find(n, cols, "z") >= 0;
	for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
		int i = find(n, cols, known[k]->name);
		if (i >= 0)
			strcpy(cols[i].unit, known[k]->unit);
	}
	int x = find(n, cols, column_size_parameter.name);
	if (x >= 0)
		strcpy(cols[x].unit, placed ? column_position[0].unit : column_size_parameter.unit);
}

static void given_units(const char *path, const char *units, int n, struct tab_col *cols)
{
	char *copy = xtext("%s", units), *save = NULL;
	for (char *word = strtok_r(copy, ",", &save); word; word = strtok_r(NULL, ",", &save)) {
		char *unit = strchr(word, '=');
		if (!unit)
			die("--units", "'%s' is not NAME=UNIT", word);
		*unit++ = 0;
		int i = find(n, cols, word);
		if (i < 0)
			die(path, "has no column %s (--units)", word);
		if (strlen(unit) >= TAB_NAME)
			die("--units", "column %s: unit too long", word);
		strcpy(cols[i].unit, unit);
		const char *bad = tab_col_valid(&cols[i]);
		if (bad)
			die("--units", "column %s: %s", word, bad);
	}
	free(copy);
}

/* The first byte, which remains to be read, after a byte order mark. */
static int first_byte(FILE *f, const char *path)
{
	int c = getc(f);
	if (c == 0xef && (getc(f) != 0xbb || getc(f) != 0xbf))
		die(path, "is none of text, CSV, NumPy and PLY");
	else if (c == 0xef)
		c = getc(f);
	if (c == EOF && ferror(f))
		die(path, "cannot read:");
	if (c == EOF)
		die(path, "is empty");
	ungetc(c, f);
	return c;
}

struct tab_import *tab_import_open(const char *path, const char *units)
{
	struct tab_import *t = xalloc(1, sizeof *t);
	const char *name = standard_input(path);
	t->f = standard(path) ? stdin : fopen(path, "rb");
	if (!t->f)
		die(name, "cannot open:");
	int first = first_byte(t->f, name);
	if (first == '#') {
		if (units)
			die("--units", "is for CSV, NumPy and PLY; %s has units of its own", name);
		t->text = tab_text_open(t->f, name);
		t->cols = tab_text_columns(t->text, &t->n);
		return t;
	}
	struct tab_col *cols;
	if (first == 0x93) {
		t->npy = npy_table_open(t->f, name);
		cols = npy_table_columns(t->npy, &t->n);
	} else if ((t->csv = csv_open(t->f, name))) {
		cols = csv_columns(t->csv, &t->n);
	} else {
		t->ply = ply_open(t->f, name);
		cols = ply_columns(t->ply, &t->n);
	}
	usual_units(t->n, cols);
	if (units)
		given_units(name, units, t->n, cols);
	t->cols = cols;
	return t;
}

const struct tab_col *tab_import_columns(const struct tab_import *t, int *n)
{
	*n = t->n;
	return t->cols;
}

const char *tab_import_law(const struct tab_import *t) { return t->text ? tab_text_law(t->text) : NULL; }

int tab_import_next(struct tab_import *t, double *row)
{
	return t->text ? tab_text_next(t->text, row) : t->csv ? csv_next(t->csv, row) : t->npy ? npy_table_next(t->npy, row) : ply_next(t->ply, row);
}

void tab_import_close(struct tab_import *t)
{
	if (t->text)
		tab_text_close(t->text);
	else if (t->csv)
		csv_close(t->csv);
	else if (t->npy)
		npy_table_close(t->npy);
	else
		ply_close(t->ply);
	if (t->f != stdin)
		fclose(t->f);
	free(t);
}

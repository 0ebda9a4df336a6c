#include "format/npy_table.h"

#include "base/die.h"
#include "format/binary_number.h"
#include "format/limits.h"
#include "format/npy_header.h"

#include <stdlib.h>
#include <string.h>

#define ROW_MAX (8 * TAB_COLS)

/* How a field is written. */
static const struct { const char *descr; struct binary_number number; } numbers[] = {
	{ "|b1", { 'u', 1 } }, { "|i1", { 'i', 1 } }, { "<i2", { 'i', 2 } }, { "<i4", { 'i', 4 } }, { "<i8", { 'i', 8 } }, { "|u1", { 'u', 1 } },
	{ "<u2", { 'u', 2 } }, { "<u4", { 'u', 4 } }, { "<u8", { 'u', 8 } }, { "<f4", { 'f', 4 } }, { "<f8", { 'f', 8 } },
};

struct npy_table {
	struct npy_source in;
	int n;
	struct tab_col cols[TAB_COLS];
	struct binary_number number[TAB_COLS];
	size_t row_size, at, rows;
};

/* A Python string in single quotes at *c, copied to text; 0 where there is none, or it does not fit. */
static int word(const char **c, char text[TAB_NAME])
{
	*c += strspn(*c, " ");
	if (**c != '\'')
		return 0;
	size_t n = strcspn(++*c, "'");
	if (n >= TAB_NAME || !(*c)[n])
		return 0;
	memcpy(text, *c, n);
	text[n] = 0;
	*c += n + 1;
	*c += strspn(*c, " ");
	return 1;
}

/* [('name', '<f8'), ('name', '<i4'), ..] */
static void fields(struct npy_table *t, const char *c)
{
	char descr[TAB_NAME];
	if (*c++ != '[')
		die(t->in.name, "its rows have no named fields; a table is a structured array, dtype=[('radius', '<f8'), ..]");
	for (c += strspn(c, " "); *c == '('; c += strspn(c, ", ")) {
		if (t->n == TAB_COLS)
			die(t->in.name, "more than %d fields", TAB_COLS);
		struct tab_col *col = &t->cols[t->n];
		c++;
		if (!word(&c, col->name) || *c++ != ',')
			die(t->in.name, "field %d: a name of at most %d bytes is needed", t->n + 1, TAB_NAME - 1);
		strcpy(col->unit, "1");
		const char *bad = tab_col_valid(col);
		if (bad)
			die(t->in.name, "field %d, '%s': %s", t->n + 1, col->name, bad);
		const struct binary_number *number = NULL;
		if (word(&c, descr) && *c++ == ')')
			for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
				if (!strcmp(descr, numbers[i].descr))
					number = &numbers[i].number;
		if (!number)
			die(t->in.name, "field %s: is not one little-endian number (i1 to i8, u1 to u8, f4, f8)", col->name);
		for (int i = 0; i < t->n; i++)
			if (!strcmp(t->cols[i].name, col->name))
				die(t->in.name, "field %s stands twice", col->name);
		col->type = binary_number_column(*number);
		t->number[t->n++] = *number;
		t->row_size += (size_t)number->bytes;
	}
	if (!t->n || *c != ']')
		die(t->in.name, "damaged array: bad fields");
}

struct npy_table *npy_table_open(FILE *f, const char *path)
{
	struct npy_table *t = xalloc(1, sizeof *t);
	size_t n[4];
	t->in = (struct npy_source){ f, path };
	char *header = npy_header(&t->in);
	fields(t, npy_entry(&t->in, header, "descr"));
	int dims = npy_shape(&t->in, header, n);
	if (dims != 1)
		die(path, "has %d dimensions; a table has 1", dims);
	t->rows = n[0];
	free(header);
	return t;
}

struct tab_col *npy_table_columns(struct npy_table *t, int *n)
{
	*n = t->n;
	return t->cols;
}

int npy_table_next(struct npy_table *t, double *row)
{
	unsigned char bytes[ROW_MAX];
	if (t->at == t->rows) {
		npy_end(&t->in);
		return 0;
	}
	npy_take(&t->in, bytes, t->row_size);
	t->at++;
	for (int i = 0, at = 0; i < t->n; at += t->number[i++].bytes)
		if (!binary_number_value(t->number[i], bytes + at, 0, &row[i]))
			die(t->in.name, "row %zu: column %s: an integer beyond 2^53", t->at, t->cols[i].name);
	return 1;
}

void npy_table_close(struct npy_table *t)
{
	free(t);
}

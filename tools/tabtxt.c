/* tabtxt - a table as text: TSV with a line that names the columns, CSV, or NumPy. */
#include "base/die.h"
#include "base/opt.h"
#include "base/out.h"
#include "format/tab.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The shortest decimal that strtod (and a cast, for f32) reads back to the same bits. Up to DBL_DIG (FLT_DIG) digits survive
 * the way into a normal number and back, and %g drops trailing zeros, so that only subnormals need the full search. */
static void shortest(char *text, size_t size, enum tab_type type, double v)
{
	if (type == TAB_I32) {
		snprintf(text, size, "%.0f", v);
		return;
	}
	if (isnan(v)) {
		snprintf(text, size, "nan");
		return;
	}
	int single = type == TAB_F32, normal = fabs(v) >= (single ? (double)FLT_MIN : DBL_MIN);
	for (int digits = !normal ? 1 : single ? FLT_DIG : DBL_DIG; digits <= DBL_DECIMAL_DIG; digits++) {
		snprintf(text, size, "%.*g", digits, v);
		double back = strtod(text, NULL);
		if (single ? (float)back == (float)v : back == v)
			return;
	}
}

static int pick(const struct tab *t, const char *names, int *index)
{
	int n = 0;
	if (!names) {
		for (; n < tab_ncols(t); n++)
			index[n] = n;
		return n;
	}
	char *copy = xtext("%s", names), *save = NULL;
	for (char *word = strtok_r(copy, ",", &save); word; word = strtok_r(NULL, ",", &save)) {
		int i = 0;
		while (i < tab_ncols(t) && strcmp(tab_cols(t)[i].name, word))
			i++;
		if (i == tab_ncols(t))
			die(tab_path(t), "has no column %s", word);
		if (n == TAB_COLS)
			die("--columns", "more than %d columns", TAB_COLS);
		index[n++] = i;
	}
	if (!n)
		die("--columns", "names no column");
	free(copy);
	return n;
}

static void as_text(struct tab *t, FILE *f, int n, const int *index, int csv)
{
	const struct tab_col *cols = tab_cols(t);
	double row[TAB_COLS];
	char text[64];
	for (int i = 0; i < n; i++) {
		const struct tab_col *c = &cols[index[i]];
		if (csv)
			fprintf(f, "%s%s", i ? "," : "", c->name);
		else
			fprintf(f, "%s%s:%s:%s", i ? "\t" : "# ", c->name, tab_type_name(c->type), c->unit);
	}
	putc('\n', f);
	while (tab_next(t, row))
		for (int i = 0; i < n; i++) {
			shortest(text, sizeof text, cols[index[i]].type, row[index[i]]);
			fputs(text, f);
			putc(i == n - 1 ? '\n' : csv ? ',' : '\t', f);
		}
}

/* A structured array, format 1.0. Its header holds the number of rows, so the rows wait in a temporary file. */
static void as_npy(struct tab *t, FILE *f, int n, const int *index)
{
	const struct tab_col *cols = tab_cols(t);
	FILE *rows = tmpfile();
	double row[TAB_COLS];
	if (!rows)
		die("temporary file", "cannot create:");
	uint64_t count = 0;
	for (; tab_next(t, row); count++)
		for (int i = 0; i < n; i++) {
			double v = row[index[i]];
			switch (cols[index[i]].type) {
			case TAB_I32: fwrite(&(int32_t){ (int32_t)v }, 4, 1, rows); break;
			case TAB_F32: fwrite(&(float){ (float)v }, 4, 1, rows); break;
			case TAB_F64: fwrite(&v, 8, 1, rows); break;
			}
		}
	char *dict = xtext("{'descr': [");
	for (int i = 0; i < n; i++) {
		const struct tab_col *c = &cols[index[i]];
		xappend(&dict, "('%s', '<%s'), ", c->name, c->type == TAB_I32 ? "i4" : c->type == TAB_F32 ? "f4" : "f8");
	}
	xappend(&dict, "], 'fortran_order': False, 'shape': (%llu,), }", (unsigned long long)count);
	size_t length = (strlen(dict) + 1 + 10 + 63) / 64 * 64 - 10;    /* data starts on a multiple of 64 bytes */
	fwrite("\x93NUMPY\x01\x00", 1, 8, f);
	putc((int)(length & 255), f);
	putc((int)(length >> 8), f);
	fprintf(f, "%-*s\n", (int)length - 1, dict);
	free(dict);
	rewind(rows);
	char buffer[1 << 16];
	for (size_t got; (got = fread(buffer, 1, sizeof buffer, rows)) > 0;)
		fwrite(buffer, 1, got, f);
	if (ferror(rows) || fclose(rows))
		die("temporary file", "cannot write or read back:");
}

int main(int argc, char **argv)
{
	int csv = 0, npy = 0, index[TAB_COLS];
	const char *names = NULL, *output = NULL;
	const struct opt opts[] = {
		{ "--columns", OPT_TEXT, &names, 0, 0, "A[,B..]", "print these columns, in this order", 0 },
		{ "--csv", OPT_FLAG, &csv, 0, 0, NULL, "comma-separated, the first line the names alone", 0 },
		{ "--npy", OPT_FLAG, &npy, 0, 0, NULL, "NumPy structured array (binary)", 0 },
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [TABLE]", "Print a table as text.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one table at most");
	if (csv && npy)
		die("--npy", "excludes --csv");
	struct tab *t = tab_open(args.n ? args.operand[0] : NULL);
	int n = pick(t, names, index);
	struct out out = out_open(output, npy);
	if (npy)
		as_npy(t, out.f, n, index);
	else
		as_text(t, out.f, n, index, csv);
	tab_close(t);
	out_close(&out);
	return 0;
}

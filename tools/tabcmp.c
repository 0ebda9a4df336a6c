/* tabcmp - how two tables differ, column by column. */
#include "base/die.h"
#include "base/opt.h"
#include "base/out.h"
#include "base/standard.h"
#include "format/tab.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct column {
	const char *name;
	int a, b;                /* where it stands */
	double abs, rel;         /* the largest differences */
	uint64_t abs_row, rel_row, beyond;
};

static int find(const struct tab *t, const char *name)
{
	for (int i = 0; i < tab_ncols(t); i++)
		if (!strcmp(tab_cols(t)[i].name, name))
			return i;
	return -1;
}

/* Pair the columns by name; those that have no partner are told, and counted into *alone. */
static int pair(const struct tab *a, const struct tab *b, FILE *f, struct column *columns, int *alone)
{
	int n = 0;
	for (int i = 0; i < tab_ncols(a); i++) {
		const struct tab_col *c = &tab_cols(a)[i];
		int j = find(b, c->name);
		if (j < 0) {
			fprintf(f, "column %s: only in %s\n", c->name, tab_path(a));
			++*alone;
		} else if (strcmp(c->unit, tab_cols(b)[j].unit)) {
			fprintf(f, "column %s: in '%s' in %s, in '%s' in %s\n", c->name, c->unit, tab_path(a),
			        tab_cols(b)[j].unit, tab_path(b));
			++*alone;
		} else {
			columns[n++] = (struct column){ .name = c->name, .a = i, .b = j };
		}
	}
	for (int j = 0; j < tab_ncols(b); j++)
		if (find(a, tab_cols(b)[j].name) < 0) {
			fprintf(f, "column %s: only in %s\n", tab_cols(b)[j].name, tab_path(b));
			++*alone;
		}
	return n;
}

static void compare(struct column *c, double a, double b, uint64_t row, double abs, double rel)
{
	if (a == b || (isnan(a) && isnan(b)))
		return;
	double d = fabs(a - b), size = fmax(fabs(a), fabs(b));
	double r = isnan(d) || isinf(d) ? INFINITY : d / size;
	if (isnan(d))
		d = INFINITY;
	if (d > c->abs) {
		c->abs = d;
		c->abs_row = row;
	}
	if (r > c->rel) {
		c->rel = r;
		c->rel_row = row;
	}
	c->beyond += isinf(d) || !(d <= abs + rel * size);
}

int main(int argc, char **argv)
{
	double rel = 0, abs = 0;
	const struct opt opts[] = {
		{ "--rel", OPT_REAL, &rel, 0, DBL_MAX, "E", "let values differ by E times the larger of the two", 0 },
		{ "--abs", OPT_REAL, &abs, 0, DBL_MAX, "E", "let values differ by E, in the column's unit", 0 },
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. A B", "Compare two tables: exit 0 if they agree, 1 if they differ.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n != 2)
		die(NULL, "needs two tables; see tabcmp --help");
	if (standard(args.operand[0]) && standard(args.operand[1]))
		die(NULL, "only one of the tables can be standard input");
	struct tab *a = tab_open(args.operand[0]), *b = tab_open(args.operand[1]);
	struct out out = out_open(NULL, 0);
	struct column columns[TAB_COLS];
	double x[TAB_COLS], y[TAB_COLS];
	int alone = 0, n = pair(a, b, out.f, columns, &alone), more_a, more_b;

	for (;;) {
		more_a = tab_next(a, x);
		more_b = tab_next(b, y);
		if (!more_a || !more_b)
			break;
		for (int i = 0; i < n; i++)
			compare(&columns[i], x[columns[i].a], y[columns[i].b], tab_row(a), abs, rel);
	}
	int longer = more_a || more_b;
	while (more_a && tab_next(a, x))
		;
	while (more_b && tab_next(b, y))
		;
	if (longer)
		fprintf(out.f, "rows: %llu in %s, %llu in %s\n", (unsigned long long)tab_row(a), tab_path(a),
		        (unsigned long long)tab_row(b), tab_path(b));
	int differ = alone || longer;
	if (n)
		fprintf(out.f, "%-15s %12s %8s %12s %8s %8s\n", "column", "max_abs", "row", "max_rel", "row", "beyond");
	for (int i = 0; i < n; i++) {
		const struct column *c = &columns[i];
		fprintf(out.f, "%-15s %12.6g %8llu %12.6g %8llu %8llu\n", c->name, c->abs, (unsigned long long)c->abs_row,
		        c->rel, (unsigned long long)c->rel_row, (unsigned long long)c->beyond);
		differ |= c->beyond > 0;
	}
	tab_close(a);
	tab_close(b);
	out_close(&out);
	return differ;
}

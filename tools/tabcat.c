/* tabcat - tables of the same columns end to end. */
#include "base/die.h"
#include "base/opt.h"
#include "base/standard.h"
#include "format/tab.h"

#include <stdlib.h>
#include <string.h>

/* Where the columns of a stand in b, which has to have the same. A column that two tables hold in different types becomes f64. */
static void match(const struct tab *a, const struct tab *b, struct tab_col *cols, int *index)
{
	for (int i = 0; i < tab_ncols(a); i++) {
		index[i] = tab_need(b, &cols[i]);
		if (tab_cols(b)[index[i]].type != cols[i].type)
			cols[i].type = TAB_F64;
	}
	for (int j = 0; j < tab_ncols(b); j++) {
		int i = 0;
		while (i < tab_ncols(a) && strcmp(tab_cols(a)[i].name, tab_cols(b)[j].name))
			i++;
		if (i == tab_ncols(a))
			die(tab_path(b), "has a column %s, which %s has not", tab_cols(b)[j].name, tab_path(a));
	}
}

int main(int argc, char **argv)
{
	const char *output = NULL;
	const struct opt opts[] = { OPT_OUTPUT(&output), OPT_END };
	const struct opt_tool tool = { "[-o FILE] [TABLE]..", "Put tables of the same columns end to end.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	int n = args.n ? args.n : 1, standards = 0;
	struct input { struct tab *t; int index[TAB_COLS]; } *in = xalloc((size_t)n, sizeof *in);
	struct tab_col cols[TAB_COLS];
	char *history = xtext("%s", "");
	double row[TAB_COLS], put[TAB_COLS];
	for (int k = 0; k < n; k++) {
		const char *path = args.n ? args.operand[k] : NULL;
		standards += standard(path);
		if (standards > 1)
			die(NULL, "only one of the tables can be standard input");
		in[k].t = tab_open(path);
		if (k == 0)
			memcpy(cols, tab_cols(in->t), (size_t)tab_ncols(in->t) * sizeof *cols);
		match(in->t, in[k].t, cols, in[k].index);
		char *joined = tab_join(history, tab_history(in[k].t), NULL);
		free(history);
		history = joined;
	}
	int ncols = tab_ncols(in->t);
	const char *law = tab_law(in->t);    /* that of all, or none */
	for (int k = 1; k < n; k++)
		law = law && tab_law(in[k].t) && !strcmp(law, tab_law(in[k].t)) ? law : NULL;
	struct tab_out *out = tab_create(output, history, args.history, law, ncols, cols);
	for (int k = 0; k < n; k++) {
		while (tab_next(in[k].t, row)) {
			for (int i = 0; i < ncols; i++)
				put[i] = row[in[k].index[i]];
			tab_put(out, put);
		}
	}
	for (int k = 0; k < n; k++)
		tab_close(in[k].t);
	tab_finish(out);
	free(history);
	free(in);
	return 0;
}

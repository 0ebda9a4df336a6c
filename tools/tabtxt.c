/* tabtxt - a table as text: TSV with a line that names the columns, CSV, or NumPy. */
#include "base/die.h"
#include "base/opt.h"
#include "base/out.h"
#include "format/npy_table.h"
#include "format/tab_text.h"

#include <stdlib.h>
#include <string.h>

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
		npy_table_write(out.f, t, n, index);
	else
		tab_text_write(out.f, t, n, index, csv);
	tab_close(t);
	out_close(&out);
	return 0;
}

/* txttab - text, CSV, NumPy or PLY to a table: what tabtxt prints, read back, and what other programs write. */
#include "base/die.h"
#include "base/opt.h"
#include "format/tab_import.h"

#include <stddef.h>

int main(int argc, char **argv)
{
	const char *output = NULL, *units = NULL;
	const struct opt opts[] = {
		{ "--units", OPT_TEXT, &units, 0, 0, "A=U[,B=V..]", "units of columns of CSV, NumPy and PLY, like x=m,radius=um", 0 },
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [TEXT]", "Read a table as text, CSV, NumPy or PLY, as tabtxt and others write it.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one input at most");
	struct tab_import *in = tab_import_open(args.n ? args.operand[0] : NULL, units);
	int n;
	const struct tab_col *cols = tab_import_columns(in, &n);
	struct tab_out *out = tab_create(output, "", args.history, tab_import_law(in), n, cols);
	double row[TAB_COLS];
	while (tab_import_next(in, row))
		tab_put(out, row);
	tab_finish(out);
	tab_import_close(in);
	return 0;
}

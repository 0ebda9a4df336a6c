/* txttab - text to a table: what tabtxt prints, read back. */
#include "base/die.h"
#include "base/opt.h"
#include "format/tab_text.h"

#include <stddef.h>

int main(int argc, char **argv)
{
	const char *output = NULL;
	const struct opt opts[] = { OPT_OUTPUT(&output), OPT_END };
	const struct opt_tool tool = { "[-o FILE] [TEXT]", "Read a table as text, as tabtxt writes it.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one input at most");
	struct tab_text *in = tab_text_open(args.n ? args.operand[0] : NULL);
	int n;
	const struct tab_col *cols = tab_text_columns(in, &n);
	struct tab_out *out = tab_create(output, "", args.history, tab_text_law(in), n, cols);
	double row[TAB_COLS];
	while (tab_text_next(in, row))
		tab_put(out, row);
	tab_finish(out);
	tab_text_close(in);
	return 0;
}

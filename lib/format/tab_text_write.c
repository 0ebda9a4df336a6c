#include "format/tab_text.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

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

void tab_text_write(FILE *f, struct tab *t, int n, const int *index, int csv)
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
	if (!csv && tab_law(t))
		fprintf(f, "\tlaw=%s", tab_law(t));
	putc('\n', f);
	while (tab_next(t, row))
		for (int i = 0; i < n; i++) {
			shortest(text, sizeof text, cols[index[i]].type, row[index[i]]);
			fputs(text, f);
			putc(i == n - 1 ? '\n' : csv ? ',' : '\t', f);
		}
}

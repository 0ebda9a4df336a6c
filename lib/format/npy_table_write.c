#include "format/npy_table.h"

#include "base/die.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

void npy_table_write(FILE *f, struct tab *t, int n, const int *index)
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
	if (fflush(rows) || ferror(rows))    /* rewind forgets it */
		die("temporary file", "cannot write:");
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
		die("temporary file", "cannot read back:");
}

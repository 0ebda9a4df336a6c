#include "format/tab.h"

#include "base/die.h"
#include "base/out.h"
#include "base/standard.h"
#include "format/limits.h"
#include "format/tab_layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#define WRITE_BLOCK (1u << 16)

struct tab_out {
	struct out out;
	int ncols;
	struct tab_col cols[TAB_COLS];
	size_t row_size, used;
	unsigned char *block;
	uint64_t rows;
	uint32_t crc;
};

static void put32(unsigned char *p, uint32_t v)
{
	for (int i = 0; i < 4; i++)
		p[i] = (unsigned char)(v >> 8 * i);
}

static void put64(unsigned char *p, uint64_t v)
{
	put32(p, (uint32_t)v);
	put32(p + 4, (uint32_t)(v >> 32));
}

static void emit(struct tab_out *t, const void *p, size_t n)
{
	t->crc = (uint32_t)crc32(t->crc, p, (unsigned)n);
	if (fwrite(p, 1, n, t->out.f) != n)
		die(standard_output(t->out.path), "cannot write:");
}

static void flush_block(struct tab_out *t)
{
	unsigned char length[4];
	if (!t->used)
		return;
	put32(length, (uint32_t)t->used);
	emit(t, length, 4);
	emit(t, t->block, t->used);
	t->used = 0;
}

struct tab_out *tab_create(const char *path, const char *history, const char *command, const char *law, int ncols,
                           const struct tab_col *cols)
{
	struct tab_out *t = xalloc(1, sizeof *t);
	if (ncols < 1 || ncols > TAB_COLS)
		die(NULL, "a table has 1 to %d columns", TAB_COLS);
	t->out = out_open(path, 1);
	t->ncols = ncols;
	memcpy(t->cols, cols, (size_t)ncols * sizeof *cols);
	t->block = xalloc(WRITE_BLOCK, 1);
	t->crc = (uint32_t)crc32(0, NULL, 0);
	size_t header = strlen(TAB_MAGIC) + 1;
	emit(t, TAB_MAGIC, strlen(TAB_MAGIC));
	char *lines = tab_join(history, command, NULL), *save = NULL;
	for (char *line = strtok_r(lines, "\n", &save); line; line = strtok_r(NULL, "\n", &save)) {
		char *text = xtext("cmd\t%s\n", line);
		header += strlen(text);
		emit(t, text, strlen(text));
		free(text);
	}
	free(lines);
	if (law) {
		char *text = xtext("law\t%s\n", law);
		emit(t, text, strlen(text));
		free(text);
	}
	for (int i = 0; i < ncols; i++) {
		const char *bad = tab_col_valid(&cols[i]);
		if (bad)
			die(cols[i].name, "%s", bad);
		for (int j = 0; j < i; j++)
			if (!strcmp(cols[i].name, cols[j].name))
				die(cols[i].name, "a column of this name stands twice");
		char *text = xtext("col\t%s\t%s\t%s\n", cols[i].name, tab_type_name(cols[i].type), cols[i].unit);
		header += strlen(text);
		emit(t, text, strlen(text));
		free(text);
		t->row_size += tab_type_size(cols[i].type);
	}
	emit(t, "\n", 1);
	if (header > TAB_HEADER_MAX)
		die(standard_output(t->out.path), "its history is too long: no header is above %u bytes", TAB_HEADER_MAX);
	return t;
}

void tab_put(struct tab_out *t, const double *row)
{
	if (t->used + t->row_size > WRITE_BLOCK)
		flush_block(t);
	unsigned char *p = t->block + t->used;
	for (int i = 0; i < t->ncols; i++) {
		uint64_t bits;
		uint32_t half;
		float f;
		switch (t->cols[i].type) {
		case TAB_I32:
			if (!(row[i] >= INT32_MIN && row[i] <= INT32_MAX) || row[i] != (int32_t)row[i])
				die(t->cols[i].name, "%g does not fit an i32 column", row[i]);
			put32(p, (uint32_t)(int32_t)row[i]);
			break;
		case TAB_F32:
			f = (float)row[i];
			if (isinf(f) && !isinf(row[i]))
				die(t->cols[i].name, "%g does not fit an f32 column", row[i]);
			memcpy(&half, &f, 4);
			put32(p, half);
			break;
		case TAB_F64:
			memcpy(&bits, &row[i], 8);
			put64(p, bits);
			break;
		}
		p += tab_type_size(t->cols[i].type);
	}
	t->used += t->row_size;
	t->rows++;
}

void tab_finish(struct tab_out *t)
{
	unsigned char mark[TAB_END_SIZE - 4], crc[4];
	flush_block(t);
	put32(mark, 0);
	put64(mark + 4, t->rows);
	emit(t, mark, sizeof mark);
	put32(crc, t->crc);
	emit(t, crc, 4);
	out_close(&t->out);
	free(t->block);
	free(t);
}

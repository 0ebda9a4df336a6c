#include "format/tab.h"

#include "base/die.h"
#include "base/out.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#define MAGIC "#?MOTES-TAB 1\n"
#define BLOCK_MAX (1u << 20)
#define HEADER_MAX (1u << 20)
#define WINDOW (2u * BLOCK_MAX + 64)    /* a block with its length and the end mark fit */
#define WRITE_BLOCK (1u << 16)
#define END_SIZE 16

static const char *const type_names[] = { "i32", "f32", "f64" };

const char *tab_type_name(enum tab_type type)
{
	return type_names[type];
}

int tab_type_parse(const char *name)
{
	for (int i = 0; i < 3; i++)
		if (!strcmp(name, type_names[i]))
			return i;
	return -1;
}

size_t tab_type_size(enum tab_type type)
{
	return type == TAB_F64 ? 8 : 4;
}

const char *tab_col_valid(const struct tab_col *col)
{
	if (!col->name[0] || col->name[strspn(col->name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_")])
		return "a column's name is letters, digits and _";
	if (!col->unit[0])
		return "a column needs a unit (1 if it has none)";
	for (const char *c = col->unit; *c; c++)
		if (*c <= ' ' || *c > '~' || *c == ':')
			return "a unit is printable, without spaces or colons";
	return NULL;
}

/* -------------------------------------------------------------------- reading */

struct tab {
	int fd;
	char *path, *history;
	int ncols;
	struct tab_col cols[TAB_COLS];
	size_t row_size;
	unsigned char *window;   /* raw bytes: [at, filled) are not used yet */
	size_t at, filled;
	int eof;
	size_t block;            /* bytes left of the block at hand */
	uint64_t rows;
	uint32_t crc;
	int ended;
};

static uint32_t get32(const unsigned char *p)
{
	return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static uint64_t get64(const unsigned char *p)
{
	return get32(p) | (uint64_t)get32(p + 4) << 32;
}

/* Have at least want bytes at hand, if the input has them. */
static size_t fill(struct tab *t, size_t want)
{
	if (want > WINDOW)
		want = WINDOW;
	if (t->filled - t->at < want && !t->eof) {
		memmove(t->window, t->window + t->at, t->filled - t->at);
		t->filled -= t->at;
		t->at = 0;
		while (t->filled < want && !t->eof) {
			ssize_t n = read(t->fd, t->window + t->filled, WINDOW - t->filled);
			if (n < 0 && errno == EINTR)
				continue;
			if (n < 0)
				die(t->path, "cannot read:");
			t->eof = n == 0;
			t->filled += (size_t)n;
		}
	}
	return t->filled - t->at;
}

static const unsigned char *take(struct tab *t, size_t n)
{
	const unsigned char *p = t->window + t->at;
	t->crc = (uint32_t)crc32(t->crc, p, (unsigned)n);
	t->at += n;
	return p;
}

static void damaged(const struct tab *t, const char *what)
{
	die(t->path, "damaged table: %s", what);
}

static void cut(const struct tab *t)
{
	die(t->path, "the table is cut short (no end mark); the program before may have failed");
}

/* Check the end mark at p, of which crc is the CRC-32 of all before its last 4 bytes. */
static void check_end(const struct tab *t, const unsigned char *p, uint64_t rows, uint32_t crc)
{
	if (get32(p + 12) != crc)
		damaged(t, "checksum does not match");
	if (get64(p + 4) != rows)
		damaged(t, "row count does not match");
}

static void column(struct tab *t, char *line)
{
	char *type = strchr(line, '\t'), *unit = type ? strchr(type + 1, '\t') : NULL;
	if (!unit || strchr(unit + 1, '\t'))
		damaged(t, "bad column line");
	*type++ = *unit++ = 0;
	if (t->ncols == TAB_COLS)
		damaged(t, "too many columns");
	struct tab_col *c = &t->cols[t->ncols];
	if (strlen(line) >= TAB_NAME || strlen(unit) >= TAB_NAME)
		damaged(t, "column name or unit too long");
	strcpy(c->name, line);
	strcpy(c->unit, unit);
	int code = tab_type_parse(type);
	if (code < 0 || tab_col_valid(c))
		damaged(t, "bad column line");
	for (int i = 0; i < t->ncols; i++)
		if (!strcmp(t->cols[i].name, c->name))
			damaged(t, "a column stands twice");
	c->type = (enum tab_type)code;
	t->row_size += tab_type_size(c->type);
	t->ncols++;
}

static void header(struct tab *t)
{
	size_t have = fill(t, HEADER_MAX), magic = strlen(MAGIC);
	if (!have)
		die(t->path, "is empty, not a table; the program before may have failed");
	if (have < magic || memcmp(t->window, MAGIC, magic))
		die(t->path, "is not a motes table");
	take(t, magic);
	for (;;) {
		unsigned char *p = t->window + t->at, *nl = memchr(p, '\n', t->filled - t->at);
		if (!nl)
			t->eof ? cut(t) : damaged(t, "header too long");
		size_t n = (size_t)(nl - p);
		if (memchr(p, 0, n))
			damaged(t, "bad header line");
		take(t, n + 1);
		if (!n)
			break;
		*nl = 0;
		char *line = (char *)p;
		if (!strncmp(line, "cmd\t", 4)) {
			char *longer = xtext("%s%s\n", t->history, line + 4);
			free(t->history);
			t->history = longer;
		} else if (!strncmp(line, "col\t", 4)) {
			column(t, line + 4);
		} else {
			damaged(t, "bad header line");
		}
	}
	if (!t->ncols)
		damaged(t, "no columns");
}

/* Where the whole rest is in the window, verify it before the first row is handed out. */
static void verify_ahead(const struct tab *t)
{
	size_t at = t->at, n;
	uint64_t rows = 0;
	uint32_t crc = t->crc;
	for (; t->filled - at >= 4 && (n = get32(t->window + at)) != 0; at += 4 + n) {
		if (n > BLOCK_MAX || n % t->row_size)
			damaged(t, "bad block length");
		if (t->filled - at - 4 < n)
			cut(t);
		crc = (uint32_t)crc32(crc, t->window + at, (unsigned)n + 4);
		rows += n / t->row_size;
	}
	if (t->filled - at < END_SIZE)
		cut(t);
	check_end(t, t->window + at, rows, (uint32_t)crc32(crc, t->window + at, END_SIZE - 4));
	if (t->filled - at > END_SIZE)
		damaged(t, "bytes after the end mark");
}

struct tab *tab_open(const char *path)
{
	struct tab *t = xalloc(1, sizeof *t);
	int standard = !path || !strcmp(path, "-");
	t->path = xtext("%s", standard ? "standard input" : path);
	t->history = xtext("%s", "");
	t->window = xalloc(WINDOW, 1);
	t->crc = (uint32_t)crc32(0, NULL, 0);
	if (standard && isatty(STDIN_FILENO))
		die(t->path, "is a terminal; a table comes from a file or a pipe");
	t->fd = standard ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
	if (t->fd < 0)
		die(t->path, "cannot open:");
	header(t);
	fill(t, BLOCK_MAX);
	fill(t, t->filled - t->at + 1);
	if (t->eof)
		verify_ahead(t);
	return t;
}

const char *tab_path(const struct tab *t) { return t->path; }
const char *tab_history(const struct tab *t) { return t->history; }
int tab_ncols(const struct tab *t) { return t->ncols; }
const struct tab_col *tab_cols(const struct tab *t) { return t->cols; }
uint64_t tab_row(const struct tab *t) { return t->rows; }

int tab_find(const struct tab *t, const char *name, const char *unit)
{
	for (int i = 0; i < t->ncols; i++)
		if (!strcmp(t->cols[i].name, name)) {
			if (strcmp(t->cols[i].unit, unit))
				die(t->path, "column %s is in '%s'; '%s' is needed", name, t->cols[i].unit, unit);
			return i;
		}
	return -1;
}

int tab_need(const struct tab *t, const char *name, const char *unit)
{
	int i = tab_find(t, name, unit);
	if (i < 0)
		die(t->path, "has no column %s", name);
	return i;
}

static void end(struct tab *t)
{
	if (fill(t, END_SIZE) < END_SIZE)
		cut(t);
	const unsigned char *p = take(t, END_SIZE - 4);
	check_end(t, p, t->rows, t->crc);
	t->at += 4;
	if (fill(t, 1))
		damaged(t, "bytes after the end mark");
	t->ended = 1;
}

int tab_next(struct tab *t, double *row)
{
	if (t->ended)
		return 0;
	if (!t->block) {
		if (fill(t, 4) < 4)
			cut(t);
		t->block = get32(t->window + t->at);
		if (!t->block) {
			end(t);
			return 0;
		}
		if (t->block > BLOCK_MAX || t->block % t->row_size)
			damaged(t, "bad block length");
		if (fill(t, 4 + t->block) < 4 + t->block)
			cut(t);
		t->crc = (uint32_t)crc32(t->crc, t->window + t->at, (unsigned)t->block + 4);
		t->at += 4;
	}
	const unsigned char *p = t->window + t->at;
	for (int i = 0; i < t->ncols; i++) {
		uint32_t bits = get32(p);
		float f;
		switch (t->cols[i].type) {
		case TAB_I32:
			row[i] = (int32_t)bits;
			break;
		case TAB_F32:
			memcpy(&f, &bits, 4);
			row[i] = f;
			break;
		case TAB_F64:
			memcpy(&row[i], &(uint64_t){ get64(p) }, 8);
			break;
		}
		p += tab_type_size(t->cols[i].type);
	}
	t->at += t->row_size;
	t->block -= t->row_size;
	t->rows++;
	return 1;
}

void tab_close(struct tab *t)
{
	if (t->fd != STDIN_FILENO)
		close(t->fd);
	free(t->window);
	free(t->history);
	free(t->path);
	free(t);
}

/* -------------------------------------------------------------------- writing */

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
		die(!strcmp(t->out.path, "-") ? "standard output" : t->out.path, "cannot write:");
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

char *tab_join(const char *first, ...)
{
	char *kept = xtext("\n");
	va_list args;
	va_start(args, first);
	for (const char *text = first; text; text = va_arg(args, const char *)) {
		char *copy = xtext("%s", text), *save = NULL;
		for (char *line = strtok_r(copy, "\n", &save); line; line = strtok_r(NULL, "\n", &save)) {
			char *framed = xtext("\n%s\n", line), *longer;
			if (!strstr(kept, framed)) {
				longer = xtext("%s%s\n", kept, line);
				free(kept);
				kept = longer;
			}
			free(framed);
		}
		free(copy);
	}
	va_end(args);
	memmove(kept, kept + 1, strlen(kept));
	return kept;
}

struct tab_out *tab_create(const char *path, const char *history, const char *command, int ncols, const struct tab_col *cols)
{
	struct tab_out *t = xalloc(1, sizeof *t);
	if (ncols < 1 || ncols > TAB_COLS)
		die(NULL, "a table has 1 to %d columns", TAB_COLS);
	t->out = out_open(path, 1);
	t->ncols = ncols;
	memcpy(t->cols, cols, (size_t)ncols * sizeof *cols);
	t->block = xalloc(WRITE_BLOCK, 1);
	t->crc = (uint32_t)crc32(0, NULL, 0);
	emit(t, MAGIC, strlen(MAGIC));
	char *lines = tab_join(history, command, NULL), *save = NULL;
	for (char *line = strtok_r(lines, "\n", &save); line; line = strtok_r(NULL, "\n", &save)) {
		char *text = xtext("cmd\t%s\n", line);
		emit(t, text, strlen(text));
		free(text);
	}
	free(lines);
	for (int i = 0; i < ncols; i++) {
		const char *bad = tab_col_valid(&cols[i]);
		if (bad)
			die(cols[i].name, "%s", bad);
		for (int j = 0; j < i; j++)
			if (!strcmp(cols[i].name, cols[j].name))
				die(cols[i].name, "a column of this name stands twice");
		char *text = xtext("col\t%s\t%s\t%s\n", cols[i].name, tab_type_name(cols[i].type), cols[i].unit);
		emit(t, text, strlen(text));
		free(text);
		t->row_size += tab_type_size(cols[i].type);
	}
	emit(t, "\n", 1);
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
	unsigned char mark[END_SIZE - 4], crc[4];
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

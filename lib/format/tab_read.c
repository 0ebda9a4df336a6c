#include "format/tab.h"

#include "base/die.h"
#include "base/standard.h"
#include "format/limits.h"
#include "format/tab_layout.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#define WINDOW (2u * TAB_BLOCK_MAX + 64)    /* a block with its length and the end mark fit */

struct tab {
	int fd;
	char *path, *history, *law;
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
	size_t have = fill(t, TAB_HEADER_MAX), magic = strlen(TAB_MAGIC);
	int commands = 0;
	if (!have)
		die(t->path, "is empty, not a table; the program before may have failed");
	if (have < magic || memcmp(t->window, TAB_MAGIC, magic))
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
			if (++commands > HISTORY_LINES)
				damaged(t, "its history is of too many commands");
			xappend(&t->history, "%s\n", line + 4);
		}
		else if (!strncmp(line, "col\t", 4))
			column(t, line + 4);
		else if (!strncmp(line, "law\t", 4) && !t->law && !tab_law_valid(line + 4))
			t->law = xtext("%s", line + 4);
		else
			damaged(t, "bad header line");
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
		if (n > TAB_BLOCK_MAX || n % t->row_size)
			damaged(t, "bad block length");
		if (t->filled - at - 4 < n)
			cut(t);
		crc = (uint32_t)crc32(crc, t->window + at, (unsigned)n + 4);
		rows += n / t->row_size;
	}
	if (t->filled - at < TAB_END_SIZE)
		cut(t);
	check_end(t, t->window + at, rows, (uint32_t)crc32(crc, t->window + at, TAB_END_SIZE - 4));
	if (t->filled - at > TAB_END_SIZE)
		damaged(t, "bytes after the end mark");
}

struct tab *tab_open(const char *path)
{
	struct tab *t = xalloc(1, sizeof *t);
	t->path = xtext("%s", standard_input(path));
	t->history = xtext("%s", "");
	t->window = xalloc(WINDOW, 1);
	t->crc = (uint32_t)crc32(0, NULL, 0);
	if (standard(path) && isatty(STDIN_FILENO))
		die(t->path, "is a terminal; a table comes from a file or a pipe");
	t->fd = standard(path) ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
	if (t->fd < 0)
		die(t->path, "cannot open:");
	header(t);
	fill(t, TAB_BLOCK_MAX);
	fill(t, t->filled - t->at + 1);
	if (t->eof)
		verify_ahead(t);
	return t;
}

const char *tab_path(const struct tab *t) { return t->path; }
const char *tab_history(const struct tab *t) { return t->history; }
const char *tab_law(const struct tab *t) { return t->law; }
int tab_ncols(const struct tab *t) { return t->ncols; }
const struct tab_col *tab_cols(const struct tab *t) { return t->cols; }
uint64_t tab_row(const struct tab *t) { return t->rows; }

int tab_find(const struct tab *t, const struct tab_col *col)
{
	for (int i = 0; i < t->ncols; i++)
		if (!strcmp(t->cols[i].name, col->name)) {
			if (strcmp(t->cols[i].unit, col->unit))
				die(t->path, "column %s is in '%s'; '%s' is needed", col->name, t->cols[i].unit, col->unit);
			return i;
		}
	return -1;
}

int tab_need(const struct tab *t, const struct tab_col *col)
{
	int i = tab_find(t, col);
	if (i < 0)
		die(t->path, "has no column %s", col->name);
	return i;
}

static void end(struct tab *t)
{
	if (fill(t, TAB_END_SIZE) < TAB_END_SIZE)
		cut(t);
	const unsigned char *p = take(t, TAB_END_SIZE - 4);
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
		if (t->block > TAB_BLOCK_MAX || t->block % t->row_size)
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
	free(t->law);
	free(t->path);
	free(t);
}

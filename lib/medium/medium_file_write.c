#include "medium/medium_file.h"

#include "base/die.h"
#include "base/out.h"
#include "format/limits.h"
#include "medium/medium_check.h"
#include "medium/medium_layout.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

struct sink {
	FILE *f;
	const char *path;
	uint64_t at;
	uint32_t crc;
};

static void emit(struct sink *s, const void *p, size_t n)
{
	for (const char *c = p; n > 0;) {
		unsigned part = n < 1u << 30 ? (unsigned)n : 1u << 30;
		s->crc = (uint32_t)crc32(s->crc, (const unsigned char *)c, part);
		if (fwrite(c, 1, part, s->f) != part)
			die(s->path, "cannot write:");
		s->at += part;
		c += part;
		n -= part;
	}
}

static void align(struct sink *s)
{
	static const char zeros[MEDIUM_ALIGN];
	emit(s, zeros, (size_t)(-s->at % MEDIUM_ALIGN));
}

static void header(struct sink *s, const struct medium *m, const uint64_t *n)
{
	char *text = xtext("%s", MEDIUM_MAGIC), *history = xtext("%s", m->history), *save = NULL;
	for (char *line = strtok_r(history, "\n", &save); line; line = strtok_r(NULL, "\n", &save))
		xappend(&text, "cmd\t%s\n", line);
	xappend(&text, "shape\t%s\t%.17g\t%.17g\t%.17g\n", m->round ? "sphere" : "box", m->half[0], m->half[1], m->half[2]);
	if (m->centre[0] != 0 || m->centre[1] != 0 || m->centre[2] != 0)
		xappend(&text, "centre\t%.17g\t%.17g\t%.17g\n", m->centre[0], m->centre[1], m->centre[2]);
	xappend(&text, "grid\t%d\t%d\t%d\t%.9g\t%.9g\t%.9g\t%.9g\t%.9g\t%.9g\n", m->cells[0], m->cells[1], m->cells[2],
	        m->low[0], m->low[1], m->low[2], m->cell[0], m->cell[1], m->cell[2]);
	xappend(&text, "voxels\t%d\t%d\t%d\t%.17g\t%.17g\n", m->voxels[0], m->voxels[1], m->voxels[2], m->voxel, m->matter);
	if (m->host) {
		xappend(&text, "host");
		for (int w = 0; w < m->n_waves; w++)
			xappend(&text, "\t%.17g", m->host[w]);
		xappend(&text, "\n");
	}
	for (int i = 0; i < N_SECTIONS; i++)
		xappend(&text, "section\t%s\t%llu\n", medium_layout[i].name, (unsigned long long)n[i]);
	xappend(&text, "\n");
	if (strlen(text) > MEDIUM_HEADER_MAX)
		die(s->path, "the commands that made it are too long for a medium's header (%u bytes)", MEDIUM_HEADER_MAX);
	emit(s, text, strlen(text));
	free(history);
	free(text);
}

void medium_file_write(const char *path, const struct medium *m)
{
	const char *wrong = medium_check(m);
	if (wrong)
		die(path, "is not written: %s", wrong);
	struct out out = out_open(path, 1);
	struct sink s = { out.f, path, 0, (uint32_t)crc32(0, NULL, 0) };
	uint64_t n[N_SECTIONS];
	medium_layout_counts(m, n);
	header(&s, m, n);
	for (int i = 0; i < N_SECTIONS; i++) {
		align(&s);
		emit(&s, *(void *const *)(const void *)((const char *)m + medium_layout[i].offset), (size_t)n[i] * medium_layout[i].size);
	}
	align(&s);
	uint64_t size = s.at + MEDIUM_TRAILER;
	emit(&s, &size, 8);
	uint32_t tail[2] = { s.crc, 0 };
	emit(&s, tail, 8);
	out_close(&out);
}

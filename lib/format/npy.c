#include "format/npy.h"

#include "base/die.h"
#include "base/standard.h"
#include "format/limits.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK 65536              /* voxels read at a time: memory follows the bytes that are there, not what the header claims */

struct source {
	FILE *f;
	const char *name;
};

static void take(const struct source *s, void *p, size_t n)
{
	if (fread(p, 1, n, s->f) == n)
		return;
	if (ferror(s->f))
		die(s->name, "cannot read:");
	die(s->name, "the array is cut short");
}

/* What follows 'key': in the header's dictionary. */
static const char *entry(const struct source *s, const char *header, const char *key)
{
	char *quoted = xtext("'%s':", key);
	const char *at = strstr(header, quoted);
	if (!at)
		die(s->name, "damaged array: its header has no %s", key);
	at += strlen(quoted);
	free(quoted);
	return at + strspn(at, " ");
}

static void shape(const struct source *s, const char *text, size_t n[3])
{
	int dims = 0;
	if (*text++ != '(')
		die(s->name, "damaged array: bad shape");
	for (text += strspn(text, " "); *text != ')';) {
		size_t digits = strspn(text, "0123456789");
		if (!digits || digits > 18)
			die(s->name, "damaged array: bad shape");
		if (dims < 3)
			n[dims] = strtoull(text, NULL, 10);
		dims++;
		text += digits;
		text += strspn(text, " ");
		if (*text == ',')
			text++;
		else if (*text != ')')
			die(s->name, "damaged array: bad shape");
		text += strspn(text, " ");
	}
	if (dims != 3)
		die(s->name, "has %d dimensions; a density grid has 3, [z][y][x]", dims);
	if (!n[0] || !n[1] || !n[2])
		die(s->name, "is an empty array");
	if (n[0] > NPY_VOXELS_MAX || n[1] > NPY_VOXELS_MAX / n[0] || n[2] > NPY_VOXELS_MAX / n[0] / n[1])
		die(s->name, "has too many voxels");
}

/* The header; returns the bytes of a voxel. */
static size_t open_array(const struct source *s, size_t n[3])
{
	unsigned char lead[12];
	take(s, lead, 10);
	if (memcmp(lead, "\x93NUMPY", 6))
		die(s->name, "is not a NumPy array (.npy)");
	if (lead[6] < 1 || lead[6] > 3)
		die(s->name, "is a NumPy array of unknown version %d", lead[6]);
	size_t length = lead[8] | (size_t)lead[9] << 8;
	if (lead[6] > 1) {
		take(s, lead + 10, 2);
		length |= (size_t)lead[10] << 16 | (size_t)lead[11] << 24;
	}
	if (length > NPY_HEADER_MAX)
		die(s->name, "damaged array: its header is too long");
	char *header = xalloc(length + 1, 1);
	take(s, header, length);
	static const struct { const char *descr; size_t bytes; } types[] = {
		{ "'|u1'", 1 }, { "'u1'", 1 }, { "'<u1'", 1 }, { "'<f4'", 4 }, { "'<f8'", 8 },
	};
	const char *descr = entry(s, header, "descr");
	size_t bytes = 0;
	for (size_t i = 0; i < sizeof types / sizeof *types; i++)
		if (!strncmp(descr, types[i].descr, strlen(types[i].descr)))
			bytes = types[i].bytes;
	size_t type = strcspn(descr, ",}\n");
	if (!bytes)
		die(s->name, "has type %.*s; a density grid is |u1, <f4 or <f8", type > 32 ? 32 : (int)type, descr);
	if (strncmp(entry(s, header, "fortran_order"), "False", 5))
		die(s->name, "is in Fortran order; a density grid is in C order");
	shape(s, entry(s, header, "shape"), n);
	free(header);
	return bytes;
}

static float value(const unsigned char *p, size_t bytes)
{
	uint64_t bits = 0;
	float f;
	double d;
	if (bytes == 1)
		return *p / 255.0f;
	for (size_t i = bytes; i-- > 0;)
		bits = bits << 8 | p[i];
	if (bytes == 4) {
		memcpy(&f, &(uint32_t){ (uint32_t)bits }, 4);
		return f;
	}
	memcpy(&d, &bits, 8);
	return fabs(d) > 3e38 ? INFINITY : (float)d;
}

struct npy_grid npy_density(const char *path)
{
	struct source s = { standard(path) ? stdin : fopen(path, "rb"), standard_input(path) };
	size_t n[3] = { 0 }, have = 0, room = 0;
	if (!s.f)
		die(path, "cannot open:");
	size_t bytes = open_array(&s, n), total = n[0] * n[1] * n[2];
	unsigned char *chunk = xalloc(CHUNK, bytes);
	struct npy_grid g = { n[2], n[1], n[0], NULL };
	while (have < total) {
		size_t count = total - have < CHUNK ? total - have : CHUNK;
		take(&s, chunk, count * bytes);
		if (have + count > room) {
			room = total < 2 * (have + count) ? total : 2 * (have + count);
			g.v = xgrow(g.v, room, sizeof *g.v);
		}
		for (size_t i = 0; i < count; i++, have++) {
			float v = value(chunk + i * bytes, bytes);
			if (!(v >= 0 && isfinite(v)))
				die(s.name, "voxel [%zu][%zu][%zu] is not a finite density >= 0", have / n[2] / n[1], have / n[2] % n[1], have % n[2]);
			g.v[have] = v;
		}
	}
	if (getc(s.f) != EOF)
		die(s.name, "has bytes after the array");
	free(chunk);
	if (s.f != stdin)
		fclose(s.f);
	return g;
}

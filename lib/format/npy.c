#include "format/npy.h"

#include "base/die.h"
#include "base/standard.h"
#include "format/limits.h"
#include "format/npy_header.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK 65536              /* voxels read at a time: memory follows the bytes that are there, not what the header claims */

/* The header: n[4], of three dimensions 1 before them. Returns the bytes of a voxel. */
static size_t open_array(const struct npy_source *s, int by_class, size_t n[4])
{
	char *header = npy_header(s);
	static const struct { const char *descr; size_t bytes; } types[] = {
		{ "'|u1'", 1 }, { "'u1'", 1 }, { "'<u1'", 1 }, { "'<f4'", 4 }, { "'<f8'", 8 },
	};
	const char *descr = npy_entry(s, header, "descr");
	size_t bytes = 0;
	for (size_t i = 0; i < sizeof types / sizeof *types; i++)
		if (!strncmp(descr, types[i].descr, strlen(types[i].descr)))
			bytes = types[i].bytes;
	size_t type = strcspn(descr, ",}\n");
	if (!bytes)
		die(s->name, "has type %.*s; a density grid is |u1, <f4 or <f8", type > 32 ? 32 : (int)type, descr);
	int dims = npy_shape(s, header, n);
	if (dims != 3 && !(by_class && dims == 4))
		die(s->name, "has %d dimensions; a density grid has 3, [z][y][x]%s", dims, by_class ? ", or 4, [class][z][y][x]" : "");
	if (dims == 3) {
		memmove(n + 1, n, 3 * sizeof *n);
		n[0] = 1;
	}
	size_t all = 1;
	for (int i = 0; i < 4; i++) {
		if (!n[i])
			die(s->name, "is an empty array");
		if (n[i] > NPY_VOXELS_MAX / all)
			die(s->name, "has too many voxels");
		all *= n[i];
	}
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

struct npy_grid npy_density(const char *path, size_t *classes)
{
	struct npy_source s = { standard(path) ? stdin : fopen(path, "rb"), standard_input(path) };
	size_t n[4] = { 0 }, have = 0, room = 0;
	if (!s.f)
		die(path, "cannot open:");
	size_t bytes = open_array(&s, classes != NULL, n), total = n[0] * n[1] * n[2] * n[3];
	unsigned char *chunk = xalloc(CHUNK, bytes);
	struct npy_grid g = { n[3], n[2], n[1], NULL };
	if (classes)
		*classes = n[0];
	while (have < total) {
		size_t count = total - have < CHUNK ? total - have : CHUNK;
		npy_take(&s, chunk, count * bytes);
		if (have + count > room) {
			room = total < 2 * (have + count) ? total : 2 * (have + count);
			g.v = xgrow(g.v, room, sizeof *g.v);
		}
		for (size_t i = 0; i < count; i++, have++) {
			float v = value(chunk + i * bytes, bytes);
			if (!(v >= 0 && isfinite(v)) && n[0] > 1)
				die(s.name, "voxel [%zu][%zu][%zu][%zu] is not a finite density >= 0", have / n[3] / n[2] / n[1], have / n[3] / n[2] % n[1],
				    have / n[3] % n[2], have % n[3]);
			if (!(v >= 0 && isfinite(v)))
				die(s.name, "voxel [%zu][%zu][%zu] is not a finite density >= 0", have / n[3] / n[2] % n[1], have / n[3] % n[2], have % n[3]);
			g.v[have] = v;
		}
	}
	npy_end(&s);
	free(chunk);
	if (s.f != stdin)
		fclose(s.f);
	return g;
}

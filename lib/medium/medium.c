#include "medium/medium.h"

#include "base/die.h"
#include "base/out.h"
#include "medium/particle_grid.h"
#include "medium/particle_counts.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#define MAGIC "#?MOTES-MEDIUM 1\n"
#define HEADER_MAX (1 << 20)
#define ALIGN 64
#define TRAILER 16    /* u64 file size, u32 CRC-32 of all before, u32 0 */

/* One array of the file: where it lies in struct medium, and its element. */
struct section {
	const char *name;
	size_t offset, size;
};

#define SECTION(name, type) { #name, offsetof(struct medium, name), sizeof(type) }

static const struct section sections[] = {
	SECTION(wavelength, double), SECTION(radius, double), SECTION(count, double), SECTION(c_ext, double),
	SECTION(c_sca, double), SECTION(node, int32_t), SECTION(theta, float), SECTION(p, float), SECTION(cdf, uint32_t),
	SECTION(particle, float), SECTION(first, uint32_t), SECTION(voxel_count, uint32_t), SECTION(density, float),
};
#define N_SECTIONS ((int)(sizeof sections / sizeof *sections))

double medium_volume(const struct medium *m)
{
	return m->round ? 4 * M_PI / 3 * m->half[0] * m->half[0] * m->half[0] : 8 * m->half[0] * m->half[1] * m->half[2];
}

double medium_depth(const struct medium *m)
{
	double c = 0;
	for (int k = 0; k < m->n_classes; k++)
		c += m->count[k] * m->c_ext[k * m->n_waves];
	return c * 1e-12 / medium_volume(m) * 2 * fmin(m->half[0], fmin(m->half[1], m->half[2]));
}

static void *const *array_of(const struct medium *m, int i)
{
	return (void *const *)(const void *)((const char *)m + sections[i].offset);
}

/* -------------------------------------------------------------------- writing */

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
	static const char zeros[ALIGN];
	emit(s, zeros, (size_t)(-s->at % ALIGN));
}

static void counts_of(const struct medium *m, uint64_t *n)
{
	uint64_t waves = (uint64_t)m->n_waves, classes = (uint64_t)m->n_classes;
	const uint64_t counts[] = { waves, classes, classes, classes * waves, classes * waves, 2 * (classes + 1), m->n_nodes,
		m->n_nodes * waves, m->n_nodes * waves, 4 * m->n_particles, m->n_first, m->n_voxel_count, m->n_density };
	memcpy(n, counts, sizeof counts);
}

void medium_write(const char *path, const struct medium *m)
{
	struct out out = out_open(path, 1);
	struct sink s = { out.f, path, 0, (uint32_t)crc32(0, NULL, 0) };
	uint64_t n[N_SECTIONS];
	counts_of(m, n);
	emit(&s, MAGIC, strlen(MAGIC));
	char *history = xtext("%s", m->history), *save = NULL;
	for (char *line = strtok_r(history, "\n", &save); line; line = strtok_r(NULL, "\n", &save)) {
		emit(&s, "cmd\t", 4);
		emit(&s, line, strlen(line));
		emit(&s, "\n", 1);
	}
	char *text = xtext("shape\t%s\t%.17g\t%.17g\t%.17g\ngrid\t%d\t%d\t%d\t%.9g\t%.9g\t%.9g\t%.9g\t%.9g\t%.9g\n"
	                   "voxels\t%d\t%d\t%d\t%.17g\t%.17g\n",
	                   m->round ? "sphere" : "box", m->half[0], m->half[1], m->half[2], m->cells[0], m->cells[1], m->cells[2],
	                   m->low[0], m->low[1], m->low[2], m->cell[0], m->cell[1], m->cell[2], m->voxels[0], m->voxels[1],
	                   m->voxels[2], m->voxel, m->matter);
	emit(&s, text, strlen(text));
	free(text);
	free(history);
	for (int i = 0; i < N_SECTIONS; i++) {
		text = xtext("section\t%s\t%llu\n", sections[i].name, (unsigned long long)n[i]);
		emit(&s, text, strlen(text));
		free(text);
	}
	emit(&s, "\n", 1);
	for (int i = 0; i < N_SECTIONS; i++) {
		align(&s);
		emit(&s, *array_of(m, i), (size_t)n[i] * sections[i].size);
	}
	align(&s);
	uint64_t size = s.at + TRAILER;
	emit(&s, &size, 8);
	uint32_t tail[2] = { s.crc, 0 };
	emit(&s, tail, 8);
	out_close(&out);
}

/* -------------------------------------------------------------------- reading */

static void damaged(const char *path, const char *what)
{
	die(path, "damaged medium: %s", what);
}

/* Read the whole file once, in order: the checksum is right, or it is refused. Returns its size. */
static size_t verify(const char *path, int fd, uint32_t *file_crc)
{
	size_t block = 1 << 20, size = 0;
	unsigned char *buffer = xalloc(block + TRAILER, 1);
	size_t held = 0;           /* the last TRAILER bytes read are not in the CRC yet */
	uint32_t crc = (uint32_t)crc32(0, NULL, 0);
	for (ssize_t n; (n = read(fd, buffer + held, block)) != 0;) {
		if (n < 0)
			die(path, "cannot read:");
		if (!size && ((size_t)n < strlen(MAGIC) || memcmp(buffer, MAGIC, strlen(MAGIC))))
			die(path, "is not a medium");
		size += (size_t)n;
		held += (size_t)n;
		if (held > TRAILER) {
			crc = (uint32_t)crc32(crc, buffer, (unsigned)(held - TRAILER));
			memmove(buffer, buffer + held - TRAILER, TRAILER);
			held = TRAILER;
		}
	}
	uint64_t stated;
	uint32_t tail[2];
	if (!size)
		die(path, "is empty, not a medium");
	if (held < TRAILER)
		damaged(path, "cut short");
	memcpy(&stated, buffer, 8);
	memcpy(tail, buffer + 8, 8);
	crc = (uint32_t)crc32(crc, buffer, 8);
	if (stated != size || tail[0] != crc || tail[1])
		damaged(path, "cut short or changed (size or checksum does not match)");
	free(buffer);
	*file_crc = crc;
	return size;
}

/* Fields of a header line behind its keyword. */
static int fields(char *line, char **field, int most)
{
	int n = 0;
	for (char *save = NULL, *c = strtok_r(line, "\t", &save); c; c = strtok_r(NULL, "\t", &save))
		if (n < most)
			field[n++] = c;
	return n;
}

static void shape(const char *path, struct medium *m, char *line)
{
	char *f[5];
	if (fields(line, f, 5) != 5 || (strcmp(f[1], "box") && strcmp(f[1], "sphere")))
		damaged(path, "bad shape line");
	m->round = !strcmp(f[1], "sphere");
	for (int a = 0; a < 3; a++) {
		m->half[a] = strtod(f[2 + a], NULL);
		if (!(m->half[a] > 0 && m->half[a] < 1e9))
			damaged(path, "bad shape line");
	}
}

static void grid(const char *path, struct medium *m, char *line)
{
	char *f[10];
	if (fields(line, f, 10) != 10)
		damaged(path, "bad grid line");
	for (int a = 0; a < 3; a++) {
		m->cells[a] = (int32_t)strtol(f[1 + a], NULL, 10);
		m->low[a] = strtof(f[4 + a], NULL);
		m->cell[a] = strtof(f[7 + a], NULL);
		if (m->cells[a] < 0 || m->cells[a] > GRID_SIDE || !isfinite(m->low[a]) || !isfinite(m->cell[a]))
			damaged(path, "bad grid line");
	}
}

static void voxels(const char *path, struct medium *m, char *line)
{
	char *f[6];
	if (fields(line, f, 6) != 6)
		damaged(path, "bad voxels line");
	for (int a = 0; a < 3; a++) {
		m->voxels[a] = (int32_t)strtol(f[1 + a], NULL, 10);
		if (m->voxels[a] < 1 || m->voxels[a] > VOXELS_SIDE)
			damaged(path, "bad voxels line");
	}
	m->voxel = strtod(f[4], NULL);
	m->matter = strtod(f[5], NULL);
	if (!(m->voxel >= 0 && m->voxel < 1e9) || !(m->matter >= 0 && m->matter < 1e30))
		damaged(path, "bad voxels line");
}

static void header(const char *path, struct medium *m, uint64_t *n)
{
	size_t most = m->map_size < HEADER_MAX ? m->map_size : HEADER_MAX, at = strlen(MAGIC);
	const char *text = m->map;
	int section = 0, lines = 0;
	m->history = xtext("%s", "");
	for (;;) {
		const char *nl = memchr(text + at, '\n', most - at);
		if (!nl)
			damaged(path, "header without an end");
		size_t length = (size_t)(nl - text) - at;
		char *line = xalloc(length + 1, 1);
		memcpy(line, text + at, length);
		at += length + 1;
		if (!length) {
			free(line);
			break;
		}
		if (!strncmp(line, "cmd\t", 4)) {
			char *longer = xtext("%s%s\n", m->history, line + 4);
			free(m->history);
			m->history = longer;
		} else if (!strncmp(line, "shape\t", 6)) {
			shape(path, m, line);
			lines |= 1;
		} else if (!strncmp(line, "grid\t", 5)) {
			grid(path, m, line);
			lines |= 2;
		} else if (!strncmp(line, "voxels\t", 7)) {
			voxels(path, m, line);
			lines |= 4;
		} else {
			char *f[3];
			if (fields(line, f, 3) != 3 || strcmp(f[0], "section") || section == N_SECTIONS || strcmp(f[1], sections[section].name))
				damaged(path, "bad header line");
			n[section++] = strtoull(f[2], NULL, 10);
		}
		free(line);
	}
	if (section != N_SECTIONS || lines != 7)
		damaged(path, "header not complete");
	for (int i = 0; i < N_SECTIONS; i++) {
		at = (at + ALIGN - 1) / ALIGN * ALIGN;
		if (n[i] > m->map_size / sections[i].size || at + n[i] * sections[i].size > m->map_size - TRAILER)
			damaged(path, "a section does not fit the file");
		*(void **)(void *)((char *)m + sections[i].offset) = (char *)m->map + at;
		at += (size_t)n[i] * sections[i].size;
	}
}

static void counts_in(const char *path, struct medium *m, const uint64_t *n)
{
	uint64_t want[N_SECTIONS];
	if (n[0] < 1 || n[0] > MEDIUM_WAVES || n[1] < 1 || n[1] > MEDIUM_CLASSES || n[6] > INT32_MAX || n[9] / 4 > INT32_MAX)
		damaged(path, "counts out of range");
	m->n_waves = (int)n[0];
	m->n_classes = (int)n[1];
	m->n_nodes = (size_t)n[6];
	m->n_particles = (size_t)n[9] / 4;
	m->n_first = (size_t)n[10];
	m->n_voxel_count = (size_t)n[10 + 1];
	m->n_density = (size_t)n[12];
	/* the kernels index nodes, cells and voxels by int */
	if ((double)n[6] * (double)n[0] > INT32_MAX || n[10] > INT32_MAX || n[11] > INT32_MAX || n[12] > INT32_MAX)
		damaged(path, "too large");
	counts_of(m, want);
	if (memcmp(want, n, sizeof want))
		damaged(path, "sections do not agree");
}

static void check_optics(const char *path, const struct medium *m)
{
	for (int w = 0; w < m->n_waves; w++)
		if (!(m->wavelength[w] > (w ? m->wavelength[w - 1] : 0)) || !isfinite(m->wavelength[w]))
			damaged(path, "wavelengths out of order");
	for (int k = 0; k < m->n_classes; k++)
		if (!(m->radius[k] > (k ? m->radius[k - 1] : 0)) || !isfinite(m->radius[k]) || !(m->count[k] >= 0) || !isfinite(m->count[k]))
			damaged(path, "classes out of order");
	for (int i = 0; i < m->n_classes * m->n_waves; i++)
		if (!(m->c_ext[i] > 0 && m->c_ext[i] < 1e30) || !(m->c_sca[i] >= 0 && m->c_sca[i] <= m->c_ext[i] * (1 + 1e-9)))
			damaged(path, "cross sections out of range");
	for (int k = 0; k <= m->n_classes; k++) {
		int32_t at = m->node[2 * k], n = m->node[2 * k + 1];
		if (at < 0 || n < 2 || (size_t)at + (size_t)n > m->n_nodes || m->theta[at] != 0)
			damaged(path, "phase table out of range");
		for (int32_t i = at + 1; i < at + n; i++)
			if (!(m->theta[i] > m->theta[i - 1] && m->theta[i] < 3.1416f))
				damaged(path, "angles out of order");
	}
	for (size_t i = 0; i < m->n_nodes * (size_t)m->n_waves; i++)
		if (!(m->p[i] >= 0 && m->p[i] < 1e30f))
			damaged(path, "phase function out of range");
}

static void check_particles(const char *path, const struct medium *m)
{
	if (!m->n_particles) {
		if (m->n_first || m->n_voxel_count)
			damaged(path, "a grid without particles");
		return;
	}
	if ((double)m->cells[0] * m->cells[1] * m->cells[2] + 1 != (double)m->n_first || m->first[0]
	    || m->first[m->n_first - 1] != m->n_particles)
		damaged(path, "grid does not agree with its cells");
	for (int a = 0; a < 3; a++)
		if (!(m->cell[a] > 0))
			damaged(path, "bad grid line");
	for (size_t c = 1; c < m->n_first; c++)
		if (m->first[c] < m->first[c - 1])
			damaged(path, "grid out of order");
	for (size_t i = 0; i < m->n_particles; i++) {
		int32_t class;
		const float *q = m->particle + 4 * i;
		memcpy(&class, &q[3], 4);
		if (class < 0 || class >= m->n_classes || !(fabsf(q[0]) < 1e9f) || !(fabsf(q[1]) < 1e9f) || !(fabsf(q[2]) < 1e9f))
			damaged(path, "a particle out of range");
	}
}

static void check_voxels(const char *path, const struct medium *m)
{
	if (m->n_particles) {
		if (m->n_density || !(m->voxel > 0) || voxels_size(m->voxels) * (size_t)m->n_classes != m->n_voxel_count)
			damaged(path, "voxels do not agree with their number");
		for (int a = 0; a < 3; a++)
			if (!(m->voxel * (m->voxels[a] - 1) < 2 * m->half[a]))
				damaged(path, "voxels larger than the medium");
		return;
	}
	if ((double)m->voxels[0] * m->voxels[1] * m->voxels[2] != (double)m->n_density)
		damaged(path, "density does not agree with its voxels");
	for (size_t i = 0; i < m->n_density; i++)
		if (!(m->density[i] >= 0 && m->density[i] < 1e30f))
			damaged(path, "density out of range");
}

void medium_open(const char *path, struct medium *m)
{
	uint64_t n[N_SECTIONS];
	*m = (struct medium){ 0 };
	int fd = open(path, O_RDONLY | O_CLOEXEC);
	struct stat st;
	if (fd < 0)
		die(path, "cannot open:");
	if (fstat(fd, &st) || !S_ISREG(st.st_mode))
		die(path, "is not a regular file");
	m->map_size = verify(path, fd, &m->crc);
	m->map = mmap(NULL, m->map_size, PROT_READ, MAP_PRIVATE, fd, 0);
	if (m->map == MAP_FAILED)
		die(path, "cannot map:");
	close(fd);
	header(path, m, n);
	counts_in(path, m, n);
	check_optics(path, m);
	check_particles(path, m);
	check_voxels(path, m);
}

void medium_close(struct medium *m)
{
	munmap(m->map, m->map_size);
	free(m->history);
}

void medium_free(struct medium *m)
{
	void *const own[] = { m->history, m->wavelength, m->radius, m->count, m->c_ext, m->c_sca, m->node, m->theta, m->p, m->cdf,
		m->particle, m->first, m->voxel_count, m->density };
	for (size_t i = 0; i < sizeof own / sizeof *own; i++)
		free(own[i]);
}

#include "medium/medium_file.h"

#include "base/die.h"
#include "format/limits.h"
#include "medium/medium_check.h"
#include "medium/medium_layout.h"

#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

static void damaged(const char *path, const char *what)
{
	die(path, "damaged medium: %s", what);
}

/* Read the whole file once, in order: the checksum is right, or it is refused. Returns its size. */
static size_t verify(const char *path, int fd, uint32_t *file_crc)
{
	size_t block = 1 << 20, size = 0;
	unsigned char *buffer = xalloc(block + MEDIUM_TRAILER, 1);
	size_t held = 0;           /* the last MEDIUM_TRAILER bytes read are not in the CRC yet */
	uint32_t crc = (uint32_t)crc32(0, NULL, 0);
	for (ssize_t n; (n = read(fd, buffer + held, block)) != 0;) {
		if (n < 0)
			die(path, "cannot read:");
		if (!size && ((size_t)n < strlen(MEDIUM_MAGIC) || memcmp(buffer, MEDIUM_MAGIC, strlen(MEDIUM_MAGIC))))
			die(path, "is not a medium");
		size += (size_t)n;
		held += (size_t)n;
		if (held > MEDIUM_TRAILER) {
			crc = (uint32_t)crc32(crc, buffer, (unsigned)(held - MEDIUM_TRAILER));
			memmove(buffer, buffer + held - MEDIUM_TRAILER, MEDIUM_TRAILER);
			held = MEDIUM_TRAILER;
		}
	}
	uint64_t stated;
	uint32_t tail[2];
	if (!size)
		die(path, "is empty, not a medium");
	if (held < MEDIUM_TRAILER)
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

/* A whole number; -1 where an int32 does not hold it. */
static int32_t whole(const char *text)
{
	long long v = strtoll(text, NULL, 10);
	return v < 0 || v > INT32_MAX ? -1 : (int32_t)v;
}

static void shape(const char *path, struct medium *m, char *line)
{
	char *f[5];
	if (fields(line, f, 5) != 5 || (strcmp(f[1], "box") && strcmp(f[1], "sphere")))
		damaged(path, "bad shape line");
	m->round = !strcmp(f[1], "sphere");
	for (int a = 0; a < 3; a++) {
		m->half[a] = strtod(f[2 + a], NULL);
	}
}

static void centre(const char *path, struct medium *m, char *line)
{
	char *f[4], *end;
	if (fields(line, f, 4) != 4)
		damaged(path, "bad centre line");
	for (int a = 0; a < 3; a++) {
		m->centre[a] = strtod(f[1 + a], &end);
		if (end == f[1 + a] || *end || !(fabs(m->centre[a]) <= 1e9))
			damaged(path, "bad centre line");
	}
}

/* A number a wavelength, of which it is not yet known how many there are: returns how many it has. */
static int host(const char *path, struct medium *m, char *line)
{
	char *f[MEDIUM_WAVES + 2], *end;
	int n = fields(line, f, MEDIUM_WAVES + 2) - 1;
	if (n < 1 || n > MEDIUM_WAVES || m->host)
		damaged(path, "bad host line");
	m->host = xalloc((size_t)n, sizeof *m->host);
	for (int w = 0; w < n; w++) {
		m->host[w] = strtod(f[1 + w], &end);
		if (end == f[1 + w] || *end)
			damaged(path, "bad host line");
	}
	return n;
}

static void grid(const char *path, struct medium *m, char *line)
{
	char *f[10];
	if (fields(line, f, 10) != 10)
		damaged(path, "bad grid line");
	for (int a = 0; a < 3; a++) {
		m->cells[a] = whole(f[1 + a]);
		m->low[a] = strtof(f[4 + a], NULL);
		m->cell[a] = strtof(f[7 + a], NULL);
	}
}

static void voxels(const char *path, struct medium *m, char *line)
{
	char *f[6];
	if (fields(line, f, 6) != 6)
		damaged(path, "bad voxels line");
	for (int a = 0; a < 3; a++)
		m->voxels[a] = whole(f[1 + a]);
	m->voxel = strtod(f[4], NULL);
	m->matter = strtod(f[5], NULL);
}

static size_t aligned(size_t at) { return (at + MEDIUM_ALIGN - 1) / MEDIUM_ALIGN * MEDIUM_ALIGN; }

/* The array at *at of n elements of a size; moves on. */
static void *array(const char *path, const struct medium_file *f, size_t *at, uint64_t n, size_t size)
{
	*at = aligned(*at);
	char *p = (char *)f->map + *at;
	if (n > f->size / size || *at + n * size > f->size - MEDIUM_TRAILER)
		damaged(path, "a section does not fit the file");
	*at += (size_t)n * size;
	return p;
}

/* Where the arrays lie: behind the header, which ends at at. */
static void arrays(const char *path, struct medium_file *f, size_t at, const uint64_t *n, uint64_t former)
{
	for (int i = 0; i < N_SECTIONS; i++) {
		if (i == SECTION_particle && former)
			array(path, f, &at, former, sizeof(uint32_t));
		void *p = array(path, f, &at, n[i], medium_layout[i].size);
		*(void **)(void *)((char *)&f->medium + medium_layout[i].offset) = p;
	}
	if (aligned(at) + MEDIUM_TRAILER != f->size)
		damaged(path, "its sections are not all of the file");
}

static void header(const char *path, struct medium_file *f, uint64_t *n)
{
	struct medium *m = &f->medium;
	size_t most = f->size < MEDIUM_HEADER_MAX ? f->size : MEDIUM_HEADER_MAX, at = strlen(MEDIUM_MAGIC);
	const char *text = f->map;
	int section = 0, lines = 0, commands = 0, hosts = 0;
	uint64_t former = 0;
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
			if (++commands > HISTORY_LINES)
				damaged(path, "its history is of too many commands");
			xappend(&m->history, "%s\n", line + 4);
		} else if (!strncmp(line, "shape\t", 6)) {
			shape(path, m, line);
			lines |= 1;
		} else if (!strncmp(line, "centre\t", 7)) {
			centre(path, m, line);
		} else if (!strncmp(line, "host\t", 5)) {
			hosts = host(path, m, line);
		} else if (!strncmp(line, "grid\t", 5)) {
			grid(path, m, line);
			lines |= 2;
		} else if (!strncmp(line, "voxels\t", 7)) {
			voxels(path, m, line);
			lines |= 4;
		} else {
			char *word[3];
			int some = fields(line, word, 3) == 3 && !strcmp(word[0], "section") && section < N_SECTIONS;
			if (some && section == SECTION_particle && !former && !strcmp(word[1], MEDIUM_FORMER))
				former = strtoull(word[2], NULL, 10);
			else if (some && !strcmp(word[1], medium_layout[section].name))
				n[section++] = strtoull(word[2], NULL, 10);
			else
				damaged(path, "bad header line");
		}
		free(line);
	}
	if (section != N_SECTIONS || lines != 7)
		damaged(path, "header not complete");
	if (hosts && (uint64_t)hosts != n[SECTION_wavelength])
		damaged(path, "its host has other wavelengths");
	arrays(path, f, at, n, former);
}

static void counts_in(const char *path, struct medium *m, const uint64_t *n)
{
	const uint64_t waves = n[SECTION_wavelength], classes = n[SECTION_radius], nodes = n[SECTION_theta];
	uint64_t want[N_SECTIONS];
	m->n_waves = waves <= MEDIUM_WAVES ? (int)waves : -1;
	m->n_classes = classes <= MEDIUM_CLASSES ? (int)classes : -1;
	m->n_nodes = (size_t)nodes;
	m->n_particles = (size_t)n[SECTION_particle] / 4;
	m->kind = m->n_particles ? MEDIUM_PARTICLES : MEDIUM_DENSITY;
	m->n_first = (size_t)n[SECTION_first];
	m->n_voxel_count = (size_t)n[SECTION_voxel_count];
	m->n_density = (size_t)n[SECTION_density];
	const char *wrong = medium_check_sizes(m);
	if (wrong)
		damaged(path, wrong);
	medium_layout_counts(m, want);
	if (memcmp(want, n, sizeof want))
		damaged(path, "sections do not agree");
}

void medium_file_open(const char *path, struct medium_file *f)
{
	uint64_t n[N_SECTIONS];
	*f = (struct medium_file){ 0 };
	int fd = open(path, O_RDONLY | O_CLOEXEC);
	struct stat st;
	if (fd < 0)
		die(path, "cannot open:");
	if (fstat(fd, &st) || !S_ISREG(st.st_mode))
		die(path, "is not a regular file");
	f->size = verify(path, fd, &f->crc);
	f->map = mmap(NULL, f->size, PROT_READ, MAP_PRIVATE, fd, 0);
	if (f->map == MAP_FAILED)
		die(path, "cannot map:");
	close(fd);
	header(path, f, n);
	counts_in(path, &f->medium, n);
	const char *wrong = medium_check(&f->medium);
	if (wrong)
		damaged(path, wrong);
}

void medium_file_close(struct medium_file *f)
{
	munmap(f->map, f->size);
	free(f->medium.history);
	free(f->medium.host);
}

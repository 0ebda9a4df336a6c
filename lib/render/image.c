#include "render/image.h"

#include "base/die.h"
#include "format/tab.h"
#include "base/unit.h"
#include "render/kern/film.h"
#include "render/variance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Names of the sums. */
static const char *const names[FILM_SUMS] = { "R", "single.R", "multiple.R", "A", "depth.Z", "Y", "AB", "second.Y", "YY0", "YY1",
	"G", "single.G", "multiple.G", "B", "single.B", "multiple.B", "AR", "AG" };

/* Those of a spectral image, each for all wavelengths, are named by these and the wavelength. */
static const char *const spectral[] = { "S0.", "A." };

/* Those that, divided by the unit and the samples, are finished channels. */
static const int finished[] = { SUM_OF(SUM_ALL, 0), SUM_OF(SUM_ALL, 1), SUM_OF(SUM_ALL, 2), SUM_OF(SUM_SINGLE, 0), SUM_OF(SUM_SINGLE, 1),
	SUM_OF(SUM_SINGLE, 2), SUM_OF(SUM_MULTIPLE, 0), SUM_OF(SUM_MULTIPLE, 1), SUM_OF(SUM_MULTIPLE, 2), SUM_ALPHA, SUM_ALPHA_RED,
	SUM_ALPHA_GREEN, SUM_ALPHA_BLUE };

static size_t pixels(const struct image *m)
{
	return (size_t)m->width * (size_t)m->height;
}

long long image_samples(const struct image *m)
{
	long long n = 0;
	for (int i = 0; i < m->n_ranges; i++)
		n += m->range[i][1] - m->range[i][0];
	return n;
}

/* -------------------------------------------------------------------- ranges of samples */

const char *image_range(const char *text, long long *from, long long *to)
{
	char *copy = xtext("%s", text), *colon = strchr(copy, ':');
	const char *bad = "is not A:B, samples A to B - 1";
	if (colon) {
		*colon = 0;
		bad = unit_int(copy, from) || unit_int(colon + 1, to) ? bad : *from < 0 || *to <= *from ? "is an empty range of samples"
		    : *to > IMAGE_SAMPLES ? "goes beyond 1e9 samples" : NULL;
	}
	free(copy);
	return bad;
}

static char *ranges_text(const struct image *m)
{
	char *text;
	size_t size;
	FILE *f = open_memstream(&text, &size);
	for (int i = 0; f && i < m->n_ranges; i++)
		fprintf(f, "%s%lld:%lld", i ? "," : "", m->range[i][0], m->range[i][1]);
	if (f && m->total)
		fprintf(f, " of %lld", m->total);
	if (!f || fclose(f))
		die(NULL, "out of memory");
	return text;
}

static int ascending(const void *a, const void *b)
{
	const long long *x = a, *y = b;
	return (*x > *y) - (*x < *y);
}

/* Sort, and join those that touch; 0 if some overlap. */
static int tidy(struct image *m)
{
	int n = 0;
	qsort(m->range, (size_t)m->n_ranges, sizeof *m->range, ascending);
	for (int i = 0; i < m->n_ranges; i++) {
		if (n && m->range[i][0] < m->range[n - 1][1])
			return 0;
		if (n && m->range[i][0] == m->range[n - 1][1]) {
			m->range[n - 1][1] = m->range[i][1];
		} else {
			memmove(m->range[n], m->range[i], sizeof *m->range);
			n++;
		}
	}
	m->n_ranges = n;
	return 1;
}

/* What ranges_text wrote, to the letter; 0 if it is anything else. */
static int ranges_read(const char *text, struct image *m)
{
	char *copy = xtext("%s", text), *of = strstr(copy, " of "), *save = NULL;
	int good = !of || !unit_int(of + 4, &m->total);
	if (of)
		*of = 0;
	for (char *word = strtok_r(copy, ",", &save); word && good; word = strtok_r(NULL, ",", &save)) {
		if (!(m->n_ranges & (m->n_ranges - 1)))    /* room in powers of two */
			m->range = xgrow(m->range, m->n_ranges ? 2 * (size_t)m->n_ranges : 1, sizeof *m->range);
		good = !image_range(word, &m->range[m->n_ranges][0], &m->range[m->n_ranges][1]);
		m->n_ranges++;
	}
	free(copy);
	good = good && m->n_ranges && tidy(m) && (!m->total || m->range[m->n_ranges - 1][1] <= m->total);
	copy = ranges_text(m);
	good = good && !strcmp(copy, text);
	free(copy);
	return good;
}

int image_whole(const struct image *m)
{
	return m->n_ranges == 1 && m->range[0][0] == 0 && (!m->total || m->range[0][1] == m->total);
}

int image_complete(const struct image *m) { return m->total && image_whole(m); }

/* -------------------------------------------------------------------- from the renderer */

void image_of(struct image *out, const struct scene *s, const struct film *f, const struct medium *m, long long from, long long to,
              long long total, const char *history, const char *command)
{
	char *line = total ? xtext("%s --samples %lld", command, total) : xtext("%s", command);
	*out = (struct image){ .width = f->width, .height = f->height, .n_sums = f->n_sums, .film = f,
		.n_spectral = f->n_sums - FILM_SUMS, .coloured = s->n_waves > 1, .depth_exponent = -ilogbf(s->depth_scale), .n_ranges = 1,
		.total = total, .history = tab_join(history, line, NULL) };
	free(line);
	out->range = xalloc(1, sizeof *out->range);
	out->range[0][0] = from;
	out->range[0][1] = to;
	out->wave = xalloc((size_t)out->n_spectral, sizeof *out->wave);
	for (int k = 0; k < out->n_spectral; k++) {
		snprintf(out->wave[k], EXR_NAME, "%s%.6fnm", spectral[k / m->n_waves], m->wavelength[k % m->n_waves] * 1000);
		*strrchr(out->wave[k], '.') = ',';
	}
}

/* -------------------------------------------------------------------- finished layers */

const int64 *image_sums(const struct image *m, size_t pixel, int64 *room)
{
	if (!m->film)
		return m->sum + pixel * (size_t)m->n_sums;
	film_pixel(m->film, pixel, room);
	return room;
}

static int in_use(const struct image *m, int sum)
{
	int colour = sum == SUM_ALPHA_RED || sum == SUM_ALPHA_GREEN || sum == SUM_ALPHA_BLUE;
	return sum >= FILM_SUMS || (names[sum] && (!colour || m->coloured));
}

static void layers(struct exr *e, const struct image *m)
{
	enum { N = sizeof finished / sizeof *finished };
	long long n = image_samples(m);
	float **out = xalloc(N + (size_t)m->n_spectral, sizeof *out);
	int64 *room = xalloc((size_t)m->n_sums, sizeof *room);
	for (int k = 0; k < N; k++)
		out[k] = in_use(m, finished[k]) ? exr_add(e, names[finished[k]]) : NULL;
	for (int w = 0; w < m->n_spectral; w++)
		out[N + w] = exr_add(e, m->wave[w]);
	float *depth = exr_add(e, "depth.Z"), *variance = exr_add(e, "variance.Y"), *count = exr_add(e, "count");
	e->channel[e->n - 1].is_uint = 1;
	variance_of(m, variance);
	for (size_t i = 0; i < pixels(m); i++) {
		const int64 *sum = image_sums(m, i, room);
		for (int k = 0; k < N + m->n_spectral; k++)
			if (out[k])
				out[k][i] = (float)((double)sum[k < N ? finished[k] : FILM_SUMS + k - N] / FILM_UNIT / (double)n);
		depth[i] = sum[SUM_ALPHA] ? (float)ldexp((double)sum[SUM_DEPTH] / (double)sum[SUM_ALPHA], m->depth_exponent) : 0;
		memcpy(&count[i], &(uint32_t){ (uint32_t)n }, 4);
	}
	free(out);
	free(room);
}

/* -------------------------------------------------------------------- sums, each as two channels of 32 bits */

static char *half_name(const struct image *m, int sum, int half)
{
	return xtext("sum.%s.%s", sum < FILM_SUMS ? names[sum] : m->wave[sum - FILM_SUMS], half ? "hi" : "lo");
}

static void put_sums(struct exr *e, const struct image *m)
{
	float **out = xalloc(2 * (size_t)m->n_sums, sizeof *out);
	int64 *room = xalloc((size_t)m->n_sums, sizeof *room);
	for (int k = 0; k < 2 * m->n_sums; k++) {
		if (!in_use(m, k / 2))
			continue;
		char *name = half_name(m, k / 2, k % 2);
		out[k] = exr_add(e, name);
		e->channel[e->n - 1].is_uint = 1;
		free(name);
	}
	for (size_t i = 0; i < pixels(m); i++) {
		const int64 *sum = image_sums(m, i, room);
		for (int k = 0; k < 2 * m->n_sums; k++)
			if (out[k])
				memcpy(&out[k][i], &(uint32_t){ (uint32_t)((uint64)sum[k / 2] >> (k % 2 ? 32 : 0)) }, 4);
	}
	free(out);
	free(room);
}

static void get_sums(const char *path, const struct exr *e, struct image *m)
{
	for (int k = 0; k < 2 * m->n_sums; k++) {
		if (!in_use(m, k / 2))
			continue;
		char *name = half_name(m, k / 2, k % 2);
		const struct exr_channel *c = exr_find(e, name);
		if (!c || !c->is_uint)
			die(path, "damaged image: lacks the integer channel %s", name);
		for (size_t i = 0; i < pixels(m); i++) {
			uint32_t bits;
			memcpy(&bits, &c->data[i], 4);
			int64 *sum = &m->sum[i * (size_t)m->n_sums + (size_t)k / 2];
			*sum = (int64)((uint64)*sum | (uint64)bits << (k % 2 ? 32 : 0));
		}
		free(name);
	}
}

/* Are all the sums of a pixel in range? */
static int in_range(const int64 *sum, int n)
{
	const int64 limit = (int64)1 << 62;
	for (int c = 0; c < n; c++)
		if (c == SUM_SQUARE + 1 ? sum[c] < 0 : c != SUM_SQUARE && (sum[c] > limit || sum[c] < -limit))
			return 0;
	return 1;
}

void image_read(const char *path, struct image *m)
{
	struct exr e;
	exr_read(path, &e);
	if (!strcmp(path, "-"))
		path = "standard input";
	const char *range = exr_text(&e, "sampleRange"), *unit = exr_text(&e, "depthUnit");
	if (!range)
		die(path, "has no sums to add: a part of an image is made by vrender --sample-range");
	*m = (struct image){ .width = e.width, .height = e.height, .history = xtext("%s", e.history ? e.history : "") };
	if (!ranges_read(range, m))
		die(path, "damaged image: its sampleRange is not a list of ranges");
	m->depth_exponent = unit && !strncmp(unit, "2^", 2) ? (int)strtol(unit + 2, NULL, 10) : 1000;
	char *again = xtext("2^%d m", m->depth_exponent);
	if (!unit || strcmp(again, unit) || m->depth_exponent < -200 || m->depth_exponent > 200)
		die(path, "damaged image: its depthUnit is none");
	free(again);
	m->wave = xalloc((size_t)e.n, sizeof *m->wave);
	for (int k = 0; k < 2; k++)
		for (int i = 0; i < e.n; i++)
			if (!strncmp(e.channel[i].name, spectral[k], strlen(spectral[k])))
				strcpy(m->wave[m->n_spectral++], e.channel[i].name);
	m->coloured = exr_find(&e, "AR") != NULL;
	m->n_sums = FILM_SUMS + m->n_spectral;
	m->sum = xalloc(pixels(m), (size_t)m->n_sums * sizeof *m->sum);
	get_sums(path, &e, m);
	for (size_t i = 0; i < pixels(m); i++)
		if (!in_range(m->sum + i * (size_t)m->n_sums, m->n_sums))
			die(path, "damaged image: a sum is out of range");
	const struct exr_channel *count = exr_find(&e, "count");
	for (size_t i = 0; i < pixels(m); i++)
		if (!count || !count->is_uint || memcmp(&count->data[i], &(uint32_t){ (uint32_t)image_samples(m) }, 4))
			die(path, "damaged image: its count is not that of its sampleRange");
	exr_free(&e);
}

void image_merge(struct image *into, const struct image *more, const char *path)
{
	if (strcmp(into->history, more->history))
		die(path, "is not of the same image as those before it: its history is another");
	if (into->width != more->width || into->height != more->height)
		die(path, "is not of the same image as those before it: it is %d x %d pixels, not %d x %d", more->width, more->height,
		    into->width, into->height);
	if (into->depth_exponent != more->depth_exponent || into->n_spectral != more->n_spectral || into->coloured != more->coloured
	    || into->total != more->total
	    || memcmp(into->wave, more->wave, (size_t)more->n_spectral * sizeof *more->wave))
		die(path, "is not of the same image as those before it: its layers are others");
	into->range = xgrow(into->range, (size_t)(into->n_ranges + more->n_ranges), sizeof *into->range);
	memcpy(into->range + into->n_ranges, more->range, (size_t)more->n_ranges * sizeof *more->range);
	into->n_ranges += more->n_ranges;
	char *range = ranges_text(more);
	if (!tidy(into))
		die(path, "its samples %s are in part among those before it", range);
	free(range);
	for (size_t i = 0; i < pixels(into); i++) {
		int64 *to = into->sum + i * (size_t)into->n_sums;
		const int64 *from = more->sum + i * (size_t)into->n_sums;
		uint64 low = (uint64)to[SUM_SQUARE];
		for (int c = 0; c < into->n_sums; c++)
			to[c] = (int64)((uint64)to[c] + (uint64)from[c]);
		to[SUM_SQUARE + 1] = (int64)((uint64)to[SUM_SQUARE + 1] + ((uint64)to[SUM_SQUARE] < low));
		if (!in_range(to, into->n_sums))
			die(path, "the light is too strong: with it a pixel's samples sum to more than 2^32");
	}
}

/* -------------------------------------------------------------------- the file */

void image_write(struct out *out, const struct image *m, int sums)
{
	struct exr e = { .width = m->width, .height = m->height };
	e.history = xtext("%s", m->history);
	if (!sums && !m->total) {    /* as if made in one go */
		free(e.history);
		e.history = xtext("%.*s --samples %lld\n", (int)strlen(m->history) - 1, m->history, image_samples(m));
	}
	layers(&e, m);
	if (m->n_spectral) {
		exr_set_text(&e, "spectralLayoutVersion", "1.0");
		exr_set_text(&e, "emissiveUnits", "W.m^-2.sr^-1");
	}
	if (sums) {
		char *range = ranges_text(m), *unit = xtext("2^%d m", m->depth_exponent);
		put_sums(&e, m);
		exr_set_text(&e, "sampleRange", range);
		exr_set_text(&e, "depthUnit", unit);
		free(range);
		free(unit);
	}
	exr_write(out, &e);
	exr_free(&e);
}

void image_free(struct image *m)
{
	free(m->sum);
	free(m->wave);
	free(m->range);
	free(m->history);
	memset(m, 0, sizeof *m);
}

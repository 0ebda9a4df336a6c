/* imgcmp - how two images differ, channel by channel, pixel by pixel and in block means. */
#include "base/die.h"
#include "base/opt.h"
#include "base/out.h"
#include "base/standard.h"
#include "format/exr.h"
#include "format/tab.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define RELATIVE_FLOOR 0.01     /* keeps relMSE finite in the dark */

struct sums {
	double square, relative, max, block_square, block_max;
	size_t n, column, row;
};

static double value(const struct exr_channel *c, size_t i)
{
	uint32_t bits;
	if (!c->is_uint)
		return c->data[i];
	memcpy(&bits, &c->data[i], sizeof bits);
	return bits;
}

/* Not-a-number and infinities equal themselves; against anything else the difference is infinite. */
static double difference(double a, double b)
{
	if (a == b || (isnan(a) && isnan(b)))
		return 0;
	return isfinite(a) && isfinite(b) ? a - b : INFINITY;
}

static void block(struct sums *s, const struct exr *image, const struct exr_channel *a, const struct exr_channel *b,
                  size_t x0, size_t y0, size_t side)
{
	size_t width = (size_t)image->width, x1 = x0 + side, y1 = y0 + side, n = 0;
	double sum = 0;
	if (x1 > width)
		x1 = width;
	if (y1 > (size_t)image->height)
		y1 = (size_t)image->height;
	for (size_t y = y0; y < y1; y++)
		for (size_t x = x0; x < x1; x++, n++) {
			double v = value(a, y * width + x), d = difference(v, value(b, y * width + x));
			sum += d;
			s->square += d * d;
			s->relative += d == 0 ? 0 : d * d / ((isfinite(v) ? v * v : 0) + RELATIVE_FLOOR);
			if (fabs(d) > s->max) {
				s->max = fabs(d);
				s->column = x;
				s->row = y;
			}
		}
	sum /= (double)n;
	s->block_square += (double)n * sum * sum;
	s->block_max = fmax(s->block_max, fabs(sum));
	s->n += n;
}

static void compare(struct sums *s, const struct exr *image, const struct exr_channel *a, const struct exr_channel *b, size_t side)
{
	for (size_t y = 0; y < (size_t)image->height; y += side)
		for (size_t x = 0; x < (size_t)image->width; x += side)
			block(s, image, a, b, x, y, side);
}

static void print(FILE *f, const char *name, const struct sums *s)
{
	double n = (double)s->n;
	fprintf(f, "%-15s %12.6g %12.6g %12.6g %12.6g %12.6g %6zu %6zu\n", name, sqrt(s->square / n), s->relative / n, s->max,
	        sqrt(s->block_square / n), s->block_max, s->column, s->row);
}

/* Halves of the exact sums of a part of an image: as numbers they say nothing. */
static int is_sum(const char *name)
{
	return !strncmp(name, "sum.", 4);
}

/* What is no radiance: compared exactly or by name, never within a tolerance for the others. */
static int is_tally(const char *name)
{
	return !strcmp(name, "count") || !strcmp(name, "depth.Z") || !strcmp(name, "variance.Y");
}

/* Is the channel to be compared? */
static int chosen(const char *names, const char *name)
{
	size_t n = strlen(name);
	if (!names && is_sum(name))
		return 0;
	for (const char *w = names; w; w = strchr(w, ',') ? strchr(w, ',') + 1 : NULL)
		if (!strncmp(w, name, n) && (w[n] == ',' || !w[n]))
			return 1;
	return !names;
}

static void must_exist(const char *names, const struct exr *a, const struct exr *b)
{
	char *copy = xtext("%s", names), *save = NULL;
	for (char *word = strtok_r(copy, ",", &save); word; word = strtok_r(NULL, ",", &save))
		if (!exr_find(a, word) && !exr_find(b, word))
			die("--channels", "neither image has a channel %s", word);
	free(copy);
}

/* Channels that only one has. */
static int alone(FILE *f, const char *names, const struct exr *a, const struct exr *b, const char *path)
{
	int n = 0;
	for (int i = 0; i < a->n; i++)
		if (chosen(names, a->channel[i].name) && !exr_find(b, a->channel[i].name)) {
			fprintf(f, "channel %s: only in %s\n", a->channel[i].name, path);
			n++;
		}
	return n;
}

/* The sums of both, where they have the same: bit by bit. */
static int other_sums(FILE *f, const struct exr *a, const struct exr *b)
{
	int n = 0;
	for (int i = 0; i < a->n; i++) {
		const struct exr_channel *c = &a->channel[i], *d = exr_find(b, c->name);
		if (is_sum(c->name) && d && memcmp(c->data, d->data, (size_t)a->width * (size_t)a->height * sizeof *c->data)) {
			fprintf(f, "channel %s: other integers\n", c->name);
			n++;
		}
	}
	return n;
}

/* The picture of a - b, of the channels that are compared. */
static void write_difference(struct out *out, const char *names, const struct exr *a, const struct exr *b, const char *command)
{
	static struct exr d;
	d.width = a->width;
	d.height = a->height;
	d.history = tab_join(a->history ? a->history : "", b->history ? b->history : "", command, NULL);
	for (int i = 0; i < a->n; i++) {
		const struct exr_channel *other = exr_find(b, a->channel[i].name);
		if (!other || !chosen(names, a->channel[i].name))
			continue;
		float *pixel = exr_add(&d, other->name);
		for (size_t p = 0; p < (size_t)d.width * (size_t)d.height; p++)
			pixel[p] = (float)(value(&a->channel[i], p) - value(other, p));
	}
	exr_write(out, &d);
	exr_free(&d);
}

int main(int argc, char **argv)
{
	double rms = NAN, max = NAN;
	long long side = 0;
	const char *names = NULL, *picture = NULL;
	const struct opt opts[] = {
		{ "--rms", OPT_REAL, &rms, 0, DBL_MAX, "E", "let the root mean square of the difference be up to E", 0 },
		{ "--max", OPT_REAL, &max, 0, DBL_MAX, "E", "let no difference be above E", 0 },
		{ "--block", OPT_INT, &side, 1, EXR_SIDE_MAX, "N", "hold the tolerances against means of N x N pixels", 0 },
		{ "--channels", OPT_TEXT, &names, 0, 0, "A[,B..]", "compare these channels only", 0 },
		{ "--difference", OPT_FILE, &picture, 0, 0, "OUT.exr", "write the picture of A - B", 1 },
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. A.exr B.exr", "Compare two images: exit 0 if they agree, 1 if they differ.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n != 2)
		die(NULL, "needs two images; see imgcmp --help");
	if (standard(args.operand[0]) && standard(args.operand[1]))
		die(NULL, "only one of the images can be standard input");
	if (picture && standard(picture))
		die("--difference", "needs a file; standard output has the figures");
	static struct exr a, b;
	exr_read(args.operand[0], &a);
	exr_read(args.operand[1], &b);
	if (a.width != b.width || a.height != b.height)
		die(args.operand[1], "is %d x %d pixels, %s is %d x %d", b.width, b.height, args.operand[0], a.width, a.height);

	if (names)
		must_exist(names, &a, &b);
	struct out out = out_open(NULL, 0), difference = { 0 };
	if (picture)
		difference = out_open(picture, 1);
	int differ = alone(out.f, names, &a, &b, args.operand[0]) + alone(out.f, names, &b, &a, args.operand[1]) > 0, common = 0;
	if (isnan(rms) && isnan(max) && !names)
		differ |= other_sums(out.f, &a, &b) > 0;
	struct sums all = { 0 };
	fprintf(out.f, "%-15s %12s %12s %12s %12s %12s %6s %6s\n", "channel", "rms", "relmse", "max", "block_rms", "block_max",
	        "column", "row");
	for (int i = 0; i < a.n; i++) {
		const struct exr_channel *other = exr_find(&b, a.channel[i].name);
		if (!other || !chosen(names, a.channel[i].name))
			continue;
		struct sums s = { 0 };
		compare(&s, &a, &a.channel[i], other, side ? (size_t)side : 8);
		print(out.f, a.channel[i].name, &s);
		double got_rms = sqrt((side ? s.block_square : s.square) / (double)s.n), got_max = side ? s.block_max : s.max;
		if (isnan(rms) && isnan(max))
			differ |= s.max > 0;
		else if (names || !is_tally(a.channel[i].name))
			differ |= got_rms > rms || got_max > max || isinf(got_max);
		common++;
		if (is_tally(a.channel[i].name))
			continue;
		all.square += s.square;
		all.relative += s.relative;
		all.block_square += s.block_square;
		all.block_max = fmax(all.block_max, s.block_max);
		all.n += s.n;
		if (s.max > all.max) {
			all.max = s.max;
			all.column = s.column;
			all.row = s.row;
		}
	}
	if (!common)
		die(args.operand[1], "has no channel to compare with %s", args.operand[0]);
	print(out.f, "all", &all);
	out_close(&out);           /* before the picture: none is left behind a failure */
	if (picture)
		write_difference(&difference, names, &a, &b, args.history);
	exr_free(&a);
	exr_free(&b);
	return differ;
}

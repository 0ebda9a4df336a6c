/* What lib/image writes, it reads back to the bit; and what it wrote does not depend on the order of things. */
#include "base/die.h"
#include "format/exr.h"
#include "support/tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define WIDTH 37
#define HEIGHT 53
#define LONG "S0.a.rather.long.name.of.more.than.thirty-one.characters"

static const char *const names[] = { "R", "G", "sum", LONG };

/* Random bits: subnormals, infinities and not-a-numbers among them. */
static void fill(struct exr *image, int backwards)
{
	memset(image, 0, sizeof *image);
	image->width = WIDTH;
	image->height = HEIGHT;
	image->history = xtext("one --a 'b c'\ntwo\n");
	exr_set_text(image, backwards ? "units" : "another", "1 2");
	exr_set_text(image, backwards ? "another" : "units", "0");
	exr_set_text(image, "units", "m");
	exr_set_text(image, "another", "0 1");
	for (int k = 0; k < 4; k++) {
		int i = backwards ? 3 - k : k;
		float *data = exr_add(image, names[i]);
		image->channel[image->n - 1].is_uint = i == 2;
		uint32_t state = (uint32_t)i + 1;
		for (int p = 0; p < WIDTH * HEIGHT; p++) {
			uint32_t bits = p < WIDTH * 20 ? (uint32_t)p << 20 : (state = state * 1664525u + 1013904223u);
			memcpy(&data[p], &bits, 4);
		}
	}
}

static int same(const struct exr *a, const struct exr *b)
{
	if (a->width != b->width || a->height != b->height || a->n != b->n || strcmp(a->history, b->history))
		return 0;
	for (int i = 0; i < a->n_texts; i++)
		if (!exr_text(b, a->text[i].name) || strcmp(a->text[i].value, exr_text(b, a->text[i].name)))
			return 0;
	for (int i = 0; i < a->n; i++) {
		const struct exr_channel *c = &a->channel[i], *d = exr_find(b, c->name);
		if (!d || c->is_uint != d->is_uint ||
		    memcmp(c->data, d->data, sizeof(float[WIDTH * HEIGHT])))
			return 0;
	}
	return 1;
}

static char *bytes(const char *path, size_t *n)
{
	FILE *f = fopen(path, "rb");
	char *p = xalloc(1 << 20, 1);
	*n = f ? fread(p, 1, 1 << 20, f) : 0;
	if (f)
		fclose(f);
	return p;
}

int main(void)
{
	char folder[] = "/tmp/image-XXXXXX", a[64], b[64];
	struct exr one, other, back;
	size_t na, nb;
	if (!mkdtemp(folder))
		die(folder, "cannot create:");
	snprintf(a, sizeof a, "%s/a.exr", folder);
	snprintf(b, sizeof b, "%s/b.exr", folder);
	fill(&one, 0);
	fill(&other, 1);
	exr_write((struct out[]){ out_open(a, 1) }, &one);
	exr_write((struct out[]){ out_open(b, 1) }, &other);
	exr_read(a, &back);
	ok(same(&one, &back), "floats and integers of any bits, long names and the history come back");
	ok(!exr_find(&back, "B") && exr_find(&back, "G"), "channels are found by name");
	char *p = bytes(a, &na), *q = bytes(b, &nb);
	ok(na && na == nb && !memcmp(p, q, na), "the order of the channels makes no difference to the file");
	ok(!strstr(p, folder), "nor does its name");
	exr_free(&back);
	for (int i = 0; i < WIDTH * HEIGHT; i++)
		one.channel[0].data[i] = one.channel[1].data[i] = (float)i / 7;
	one.n = 2;
	exr_write((struct out[]){ out_open(a, 1) }, &one);
	char *command = xtext("oiiotool %s -d float -o %s", a, b);
	int failed = system(command);
	if (!failed)
		exr_read(b, &back);
	ok(!failed && same(&one, &back), "OpenImageIO reads it, and keeps the history");
	one.n = 4;
	free(command);
	unlink(a);
	unlink(b);
	rmdir(folder);
	free(p);
	free(q);
	exr_free(&one);
	exr_free(&other);
	exr_free(&back);
	return done_testing();
}

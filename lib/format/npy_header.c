#include "format/npy_header.h"

#include "base/die.h"
#include "format/limits.h"

#include <stdlib.h>
#include <string.h>

void npy_take(const struct npy_source *s, void *p, size_t n)
{
	if (fread(p, 1, n, s->f) == n)
		return;
	if (ferror(s->f))
		die(s->name, "cannot read:");
	die(s->name, "the array is cut short");
}

const char *npy_entry(const struct npy_source *s, const char *header, const char *key)
{
	char *quoted = xtext("'%s':", key);
	const char *at = strstr(header, quoted);
	if (!at)
		die(s->name, "damaged array: its header has no %s", key);
	at += strlen(quoted);
	free(quoted);
	return at + strspn(at, " ");
}

char *npy_header(const struct npy_source *s)
{
	unsigned char lead[12];
	npy_take(s, lead, 10);
	if (memcmp(lead, "\x93NUMPY", 6))
		die(s->name, "is not a NumPy array (.npy)");
	if (lead[6] < 1 || lead[6] > 3)
		die(s->name, "is a NumPy array of unknown version %d", lead[6]);
	size_t length = lead[8] | (size_t)lead[9] << 8;
	if (lead[6] > 1) {
		npy_take(s, lead + 10, 2);
		length |= (size_t)lead[10] << 16 | (size_t)lead[11] << 24;
	}
	if (length > NPY_HEADER_MAX)
		die(s->name, "damaged array: its header is too long");
	char *header = xalloc(length + 1, 1);
	npy_take(s, header, length);
	if (strncmp(npy_entry(s, header, "fortran_order"), "False", 5))
		die(s->name, "is in Fortran order; C order is needed");
	return header;
}

int npy_shape(const struct npy_source *s, const char *header, size_t n[4])
{
	const char *text = npy_entry(s, header, "shape");
	int dims = 0;
	if (*text++ != '(')
		die(s->name, "damaged array: bad shape");
	for (text += strspn(text, " "); *text != ')';) {
		size_t digits = strspn(text, "0123456789");
		if (!digits || digits > 18)
			die(s->name, "damaged array: bad shape");
		if (dims < 4)
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
	return dims;
}

void npy_end(const struct npy_source *s)
{
	if (getc(s->f) != EOF)
		die(s->name, "has bytes after the array");
}

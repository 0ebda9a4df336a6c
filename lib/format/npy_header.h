/* npy_header - the header of a NumPy array, formats 1 to 3: a Python dictionary. Everything dies at the first error. */
#ifndef FORMAT_NPY_HEADER_H
#define FORMAT_NPY_HEADER_H

#include <stddef.h>
#include <stdio.h>

struct npy_source {
	FILE *f;
	const char *name;        /* for messages */
};

/* npy_take - read n bytes. */
void npy_take(const struct npy_source *s, void *p, size_t n);

/* npy_header - read the header; its text, from malloc. Dies where the array is in Fortran order. */
char *npy_header(const struct npy_source *s);

/* npy_entry - what follows 'key': there. */
const char *npy_entry(const struct npy_source *s, const char *header, const char *key);

/* npy_shape - the sizes, of which the first 4 go to n; returns how many there are. */
int npy_shape(const struct npy_source *s, const char *header, size_t n[4]);

/* npy_end - die unless the file ends here. */
void npy_end(const struct npy_source *s);

#endif

/* exr_blob - a file in memory, as OpenEXRCore reads and writes it: standard input cannot seek, and the library must, in both
 * directions. */
#ifndef FORMAT_EXR_BLOB_H
#define FORMAT_EXR_BLOB_H

#include <openexr.h>
#include <stddef.h>

struct exr_blob {
	unsigned char *p;
	size_t n, room;
};

/* exr_blob_reserve - have room for n bytes; dies. */
void exr_blob_reserve(struct exr_blob *b, size_t n);

/* exr_blob_calls - set up the library to read from, or write to, a blob, and to say nothing by itself: its codes say enough for
 * our one line. */
exr_context_initializer_t exr_blob_calls(struct exr_blob *b);

#endif

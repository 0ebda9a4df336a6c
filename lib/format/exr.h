/* exr - images of 32-bit float (or uint) channels, by OpenEXRCore. */
#ifndef FORMAT_EXR_H
#define FORMAT_EXR_H

#include "base/out.h"
#include "format/limits.h"

#include <stddef.h>
#include <stdint.h>

struct exr_channel {
	char name[EXR_NAME];
	int is_uint;             /* data holds uint32_t bits */
	float *data;             /* [height][width], top row first */
};

struct exr_text {
	char *name, *value;
};

struct exr {
	int width, height;
	int n;
	struct exr_channel channel[EXR_CHANNELS];
	char *history;           /* cmd lines as in tab(5), each ending in a newline: the string attribute "history"; or NULL */
	int n_texts;
	struct exr_text *text;   /* the other string attributes */
};

/* exr_read - read a scan-line or tiled image (path NULL or "-": standard input); half channels become float. Of a tiled image
 * with levels it is the finest; the data window is the image. Dies on anything that is not a whole, sane image: also on
 * several parts, deep data, subsampled channels, and B44 and DWA
 * compression. Bit errors go unseen where the format has no checksum: in uncompressed pixels and in free text. */
void exr_read(const char *path, struct exr *image);

/* exr_write - write scan lines with ZIP compression to an output opened as binary, and close it; bytes depend on content alone:
 * the order of the channels does not matter either. Dies. */
void exr_write(struct out *out, const struct exr *image);

/* exr_find - the channel of that name, NULL if there is none. */
const struct exr_channel *exr_find(const struct exr *image, const char *name);

/* exr_add - append a channel with zeroed pixels and return its data; width and height are set beforehand. Dies where a
 * channel of this name is there already, or there are EXR_CHANNELS. For integers set is_uint of the last channel. */
float *exr_add(struct exr *image, const char *name);

/* exr_set_text - a string attribute, added or replaced. exr_text: its value, NULL if there is none. */
void exr_set_text(struct exr *image, const char *name, const char *value);
const char *exr_text(const struct exr *image, const char *name);

void exr_free(struct exr *image);

#endif

#include "format/exr.h"

#include "base/die.h"
#include "base/standard.h"
#include "format/exr_blob.h"
#include "format/limits.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The whole file. */
static struct exr_blob slurp(const char *path)
{
	const char *name = standard_input(path);
	static const unsigned char magic[4] = { 0x76, 0x2f, 0x31, 0x01 };
	struct exr_blob b = { NULL, 0, 0 };
	FILE *f = standard(path) ? stdin : fopen(path, "rb");
	if (!f)
		die(name, "cannot open:");
	for (size_t got = 1; got; b.n += got) {
		exr_blob_reserve(&b, b.n + 65536);
		got = fread(b.p + b.n, 1, b.n < 4 ? 4 - b.n : b.room - b.n, f);
		if (b.n + got >= 4 && memcmp(b.p, magic, 4))     /* before an endless stream of something else fills the memory */
			die(name, "is not an OpenEXR image");
		if (b.n + got > EXR_FILE_MAX)
			die(name, "is too large");
	}
	if (ferror(f))
		die(name, "cannot read:");
	if (b.n < 4)
		die(name, b.n ? "is not an OpenEXR image" : "is empty, not an image");
	if (f != stdin)
		fclose(f);
	return b;
}

struct reading {
	const char *name;
	struct exr_blob blob;
	exr_context_t file;
	exr_decode_pipeline_t decode;
	int started;
	struct exr *image;
};

static void damaged(const struct reading *r, const char *what)
{
	die(r->name, "damaged image: %s", what);
}

static void must(const struct reading *r, exr_result_t code)
{
	if (code)
		damaged(r, exr_get_default_error_message(code));
}

static void read_texts(struct reading *r)
{
	const exr_attribute_t *a;
	int32_t n;
	must(r, exr_get_attribute_count(r->file, 0, &n));
	for (int32_t i = 0; i < n; i++) {
		must(r, exr_get_attribute_by_index(r->file, 0, EXR_ATTR_LIST_FILE_ORDER, i, &a));
		if (a->type != EXR_ATTR_STRING)
			continue;
		int length = a->string->length;
		char *text = xtext("%.*s", length, a->string->str);
		if (!strcmp(a->name, "history")) {
			free(r->image->history);
			length = (int)strlen(text);
			r->image->history = xtext("%s%s", text, length && text[length - 1] != '\n' ? "\n" : "");
		} else {
			exr_set_text(r->image, a->name, text);
		}
		free(text);
	}
}

static void read_header(struct reading *r)
{
	exr_context_initializer_t init = exr_blob_calls(&r->blob);
	exr_storage_t storage;
	exr_compression_t compression;
	exr_attr_box2i_t window;
	const exr_attr_chlist_t *list;
	int parts;

	init.max_image_width = init.max_image_height = EXR_SIDE_MAX;
	init.max_tile_width = init.max_tile_height = EXR_TILE_MAX;
	init.flags = EXR_CONTEXT_FLAG_SILENT_HEADER_PARSE | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
	must(r, exr_start_read(&r->file, r->name, &init));

	must(r, exr_get_count(r->file, &parts));
	if (parts != 1)
		die(r->name, "has %d parts; an image of one part is needed", parts);
	must(r, exr_get_storage(r->file, 0, &storage));
	if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
		die(r->name, "is a deep image; a flat one is needed");
	must(r, exr_get_compression(r->file, 0, &compression));
	if (compression > EXR_COMPRESSION_PXR24)     /* OpenEXRCore 3.1 gets floats in B44 wrong, and lacks DWA */
		die(r->name, "its compression (B44 or DWA) is not read here; store it with ZIP");
	must(r, exr_get_data_window(r->file, 0, &window));
	int64_t width = (int64_t)window.max.x - window.min.x + 1, height = (int64_t)window.max.y - window.min.y + 1;
	if (width < 1 || height < 1 || width > EXR_SIDE_MAX || height > EXR_SIDE_MAX)
		damaged(r, "its size is out of range");
	r->image->width = (int)width;
	r->image->height = (int)height;

	must(r, exr_get_channels(r->file, 0, &list));
	if (list->num_channels < 1 || list->num_channels > EXR_CHANNELS)
		die(r->name, "has %d channels; 1 to %d can be read", list->num_channels, EXR_CHANNELS);
	if ((uint64_t)width * (uint64_t)height * 2 * (uint64_t)list->num_channels / EXR_PACKING_MAX > r->blob.n)
		damaged(r, "it is far too short for its size");
	for (int i = 0; i < list->num_channels; i++) {
		const exr_attr_chlist_entry_t *e = &list->entries[i];
		if (e->x_sampling != 1 || e->y_sampling != 1)
			die(r->name, "channel %s is subsampled; every pixel is needed", e->name.str);
		if (!*e->name.str || strlen(e->name.str) >= EXR_NAME)
			die(r->name, "a channel's name is empty or longer than %d characters", EXR_NAME - 1);
		if (exr_find(r->image, e->name.str))
			damaged(r, "a channel stands twice");
		exr_add(r->image, e->name.str);
		r->image->channel[i].is_uint = e->pixel_type == EXR_PIXEL_UINT;
	}
	read_texts(r);
}

/* Decode a chunk of which the upper left pixel is (x, y), and which has to be width by height. */
static void chunk(struct reading *r, const exr_chunk_info_t *info, int x, int y, int width, int height)
{
	exr_decode_pipeline_t *d = &r->decode;
	if (!info->packed_size || info->packed_size > r->blob.n)
		damaged(r, "pixels are missing");
	if (info->unpacked_size / EXR_PACKING_MAX > info->packed_size)
		damaged(r, "a block is far too short for its size");
	must(r, r->started ? exr_decoding_update(r->file, 0, info, d) : exr_decoding_initialize(r->file, 0, info, d));
	if (d->channel_count != r->image->n)
		damaged(r, "channels are missing");
	for (int i = 0; i < d->channel_count; i++) {
		exr_coding_channel_info_t *c = &d->channels[i];
		const struct exr_channel *to = exr_find(r->image, c->channel_name);
		if (!to || c->width != width || c->height != height)
			damaged(r, "a block has the wrong size");
		c->decode_to_ptr = (uint8_t *)(to->data + (size_t)y * (size_t)r->image->width + x);
		c->user_data_type = to->is_uint ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
		c->user_bytes_per_element = 4;
		c->user_pixel_stride = 4;
		c->user_line_stride = 4 * r->image->width;
	}
	if (!r->started)
		must(r, exr_decoding_choose_default_routines(r->file, 0, d));
	r->started = 1;
	must(r, exr_decoding_run(r->file, 0, d));
}

static void read_lines(struct reading *r)
{
	exr_attr_box2i_t window;
	int32_t lines;
	must(r, exr_get_data_window(r->file, 0, &window));
	must(r, exr_get_scanlines_per_chunk(r->file, 0, &lines));
	if (lines < 1)
		damaged(r, "bad block size");
	for (int y = 0; y < r->image->height; y += lines) {
		exr_chunk_info_t info;
		int height = r->image->height - y < lines ? r->image->height - y : lines;
		must(r, exr_read_scanline_chunk_info(r->file, 0, window.min.y + y, &info));
		chunk(r, &info, 0, y, r->image->width, height);
	}
}

static void read_tiles(struct reading *r)
{
	int32_t tile_width, tile_height;
	must(r, exr_get_tile_sizes(r->file, 0, 0, 0, &tile_width, &tile_height));
	if (tile_width < 1 || tile_height < 1)
		damaged(r, "bad tile size");
	for (int y = 0, row = 0; y < r->image->height; y += tile_height, row++)
		for (int x = 0, column = 0; x < r->image->width; x += tile_width, column++) {
			exr_chunk_info_t info;
			int width = r->image->width - x < tile_width ? r->image->width - x : tile_width;
			int height = r->image->height - y < tile_height ? r->image->height - y : tile_height;
			must(r, exr_read_tile_chunk_info(r->file, 0, column, row, 0, 0, &info));
			chunk(r, &info, x, y, width, height);
		}
}

void exr_read(const char *path, struct exr *image)
{
	struct reading r = { .name = standard_input(path), .image = image };
	exr_storage_t storage;
	memset(image, 0, sizeof *image);
	r.blob = slurp(path);
	read_header(&r);
	must(&r, exr_get_storage(r.file, 0, &storage));
	if (storage == EXR_STORAGE_TILED)
		read_tiles(&r);
	else
		read_lines(&r);
	exr_decoding_destroy(r.file, &r.decode);
	exr_finish(&r.file);
	free(r.blob.p);
}

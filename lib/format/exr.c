#include "format/exr.h"

#include "base/die.h"
#include "base/out.h"

#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TILE_MAX 4096
#define FILE_MAX ((size_t)16 << 30)
#define PACKING_MAX 4096     /* no compression packs tighter: a header that promises more pixels is damaged */

static const char *name_of(const char *path, const char *standard)
{
	return path && strcmp(path, "-") ? path : standard;
}

/* A file in memory: standard input cannot seek, and the library must, in both directions. */
struct blob {
	unsigned char *p;
	size_t n, room;
};

static void reserve(struct blob *b, size_t n)
{
	if (n <= b->room)
		return;
	b->room = n < b->room + b->room / 2 ? b->room + b->room / 2 : n < 65536 ? 65536 : n;
	b->p = xgrow(b->p, b->room, 1);
}

static struct blob slurp(const char *path, const char *name)
{
	static const unsigned char magic[4] = { 0x76, 0x2f, 0x31, 0x01 };
	struct blob b = { NULL, 0, 0 };
	FILE *f = name == path ? fopen(path, "rb") : stdin;
	if (!f)
		die(name, "cannot open:");
	for (size_t got = 1; got; b.n += got) {
		reserve(&b, b.n + 65536);
		got = fread(b.p + b.n, 1, b.n < 4 ? 4 - b.n : b.room - b.n, f);
		if (b.n + got >= 4 && memcmp(b.p, magic, 4))     /* before an endless stream of something else fills the memory */
			die(name, "is not an OpenEXR image");
		if (b.n + got > FILE_MAX)
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

static int64_t blob_read(exr_const_context_t c, void *user, void *to, uint64_t n, uint64_t at, exr_stream_error_func_ptr_t fail)
{
	const struct blob *b = user;
	(void)c, (void)fail;
	if (at >= b->n)
		return 0;
	if (n > b->n - at)
		n = b->n - at;
	memcpy(to, b->p + at, n);
	return (int64_t)n;
}

static int64_t blob_size(exr_const_context_t c, void *user)
{
	(void)c;
	return (int64_t)((const struct blob *)user)->n;
}

static int64_t blob_write(exr_const_context_t c, void *user, const void *from, uint64_t n, uint64_t at,
                          exr_stream_error_func_ptr_t fail)
{
	struct blob *b = user;
	(void)c, (void)fail;
	reserve(b, at + n);
	if (at > b->n)
		memset(b->p + b->n, 0, at - b->n);
	memcpy(b->p + at, from, n);
	if (at + n > b->n)
		b->n = at + n;
	return (int64_t)n;
}

/* The library's own messages: the code says enough for our one line. */
static void silent(exr_const_context_t c, exr_result_t code, const char *message)
{
	(void)c, (void)code, (void)message;
}

/* -------------------------------------------------------------------- reading */

struct reading {
	const char *name;
	struct blob blob;
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
	exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
	exr_storage_t storage;
	exr_compression_t compression;
	exr_attr_box2i_t window;
	const exr_attr_chlist_t *list;
	int parts;

	init.error_handler_fn = silent;
	init.user_data = &r->blob;
	init.read_fn = blob_read;
	init.size_fn = blob_size;
	init.max_image_width = init.max_image_height = EXR_SIDE_MAX;
	init.max_tile_width = init.max_tile_height = TILE_MAX;
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
	if ((uint64_t)width * (uint64_t)height * 2 * (uint64_t)list->num_channels / PACKING_MAX > r->blob.n)
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
	if (info->unpacked_size / PACKING_MAX > info->packed_size)
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
	struct reading r = { .name = name_of(path, "standard input"), .image = image };
	exr_storage_t storage;
	memset(image, 0, sizeof *image);
	r.blob = slurp(path, r.name);
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

/* -------------------------------------------------------------------- writing */

static void done(const char *name, exr_result_t code)
{
	if (code)
		die(name, "cannot make the image: %s", exr_get_default_error_message(code));
}

static void write_header(exr_context_t file, const char *name, const struct exr *image)
{
	int part;
	done(name, exr_add_part(file, NULL, EXR_STORAGE_SCANLINE, &part));
	done(name, exr_initialize_required_attr_simple(file, part, image->width, image->height, EXR_COMPRESSION_ZIP));
	for (int i = 0; i < image->n; i++) {
		const struct exr_channel *c = &image->channel[i];
		if (strlen(c->name) > 31)
			done(name, exr_set_longname_support(file, 1));
		done(name, exr_add_channel(file, part, c->name, c->is_uint ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT,
		                           EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
	}
	if (image->history && *image->history)
		done(name, exr_attr_set_string(file, part, "history", image->history));
	for (int i = 0; i < image->n_texts; i++)
		done(name, exr_attr_set_string(file, part, image->text[i].name, image->text[i].value));
	done(name, exr_write_header(file));
}

static void write_lines(exr_context_t file, const char *name, const struct exr *image)
{
	exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
	int32_t lines;
	done(name, exr_get_scanlines_per_chunk(file, 0, &lines));
	for (int y = 0; y < image->height; y += lines) {
		exr_chunk_info_t info;
		done(name, exr_write_scanline_chunk_info(file, 0, y, &info));
		done(name, y ? exr_encoding_update(file, 0, &info, &encode) : exr_encoding_initialize(file, 0, &info, &encode));
		for (int i = 0; i < encode.channel_count; i++) {
			exr_coding_channel_info_t *c = &encode.channels[i];
			const struct exr_channel *from = exr_find(image, c->channel_name);
			c->encode_from_ptr = (const uint8_t *)(from->data + (size_t)y * (size_t)image->width);
			c->user_data_type = c->data_type;
			c->user_bytes_per_element = 4;
			c->user_pixel_stride = 4;
			c->user_line_stride = 4 * image->width;
		}
		if (!y)
			done(name, exr_encoding_choose_default_routines(file, 0, &encode));
		done(name, exr_encoding_run(file, 0, &encode));
	}
	exr_encoding_destroy(file, &encode);
}

void exr_write(struct out *out, const struct exr *image)
{
	const char *name = name_of(out->path, "standard output");
	exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
	exr_context_t file;
	struct blob blob = { NULL, 0, 0 };
	if (image->width < 1 || image->height < 1 || image->width > EXR_SIDE_MAX || image->height > EXR_SIDE_MAX || image->n < 1)
		die(name, "an image of %d x %d pixels and %d channels cannot be written", image->width, image->height, image->n);
	init.error_handler_fn = silent;
	init.user_data = &blob;
	init.write_fn = blob_write;
	done(name, exr_start_write(&file, name, EXR_WRITE_FILE_DIRECTLY, &init));
	write_header(file, name, image);
	write_lines(file, name, image);
	done(name, exr_finish(&file));
	if (fwrite(blob.p, 1, blob.n, out->f) != blob.n)
		die(name, "cannot write:");
	free(blob.p);
	out_close(out);
}

/* -------------------------------------------------------------------- channels */

const struct exr_channel *exr_find(const struct exr *image, const char *name)
{
	for (int i = 0; i < image->n; i++)
		if (!strcmp(image->channel[i].name, name))
			return &image->channel[i];
	return NULL;
}

float *exr_add(struct exr *image, const char *name)
{
	if (image->n == EXR_CHANNELS)
		die(name, "an image has at most %d channels", EXR_CHANNELS);
	if (strlen(name) >= EXR_NAME || exr_find(image, name))
		die(name, "a channel of this name stands twice, or the name is too long");
	struct exr_channel *c = &image->channel[image->n++];
	strcpy(c->name, name);
	c->is_uint = 0;
	c->data = xalloc((size_t)image->width * (size_t)image->height, sizeof *c->data);
	return c->data;
}

void exr_set_text(struct exr *image, const char *name, const char *value)
{
	int i = 0;
	while (i < image->n_texts && strcmp(image->text[i].name, name) < 0)
		i++;
	if (i < image->n_texts && !strcmp(image->text[i].name, name)) {
		free(image->text[i].value);
	} else {                   /* in the order of the names: bytes depend on content alone */
		image->text = xgrow(image->text, (size_t)image->n_texts + 1, sizeof *image->text);
		memmove(image->text + i + 1, image->text + i, (size_t)(image->n_texts - i) * sizeof *image->text);
		image->text[i].name = xtext("%s", name);
		image->n_texts++;
	}
	image->text[i].value = xtext("%s", value);
}

const char *exr_text(const struct exr *image, const char *name)
{
	for (int i = 0; i < image->n_texts; i++)
		if (!strcmp(image->text[i].name, name))
			return image->text[i].value;
	return NULL;
}

void exr_free(struct exr *image)
{
	for (int i = 0; i < image->n; i++)
		free(image->channel[i].data);
	for (int i = 0; i < image->n_texts; i++) {
		free(image->text[i].name);
		free(image->text[i].value);
	}
	free(image->text);
	free(image->history);
	memset(image, 0, sizeof *image);
}

#include "format/exr.h"

#include "base/die.h"
#include "base/standard.h"
#include "format/exr_blob.h"
#include "format/limits.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
	const char *name = standard_output(out->path);
	struct exr_blob blob = { NULL, 0, 0 };
	exr_context_initializer_t init = exr_blob_calls(&blob);
	exr_context_t file;
	if (image->width < 1 || image->height < 1 || image->width > EXR_SIDE_MAX || image->height > EXR_SIDE_MAX || image->n < 1)
		die(name, "an image of %d x %d pixels and %d channels cannot be written", image->width, image->height, image->n);
	done(name, exr_start_write(&file, name, EXR_WRITE_FILE_DIRECTLY, &init));
	write_header(file, name, image);
	write_lines(file, name, image);
	done(name, exr_finish(&file));
	if (fwrite(blob.p, 1, blob.n, out->f) != blob.n)
		die(name, "cannot write:");
	free(blob.p);
	out_close(out);
}

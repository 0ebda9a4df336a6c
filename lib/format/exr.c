#include "format/exr.h"

#include "base/die.h"

#include <stdlib.h>
#include <string.h>

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

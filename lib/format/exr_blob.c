#include "format/exr_blob.h"

#include "base/die.h"

#include <string.h>

void exr_blob_reserve(struct exr_blob *b, size_t n)
{
	if (n <= b->room)
		return;
	b->room = n < b->room + b->room / 2 ? b->room + b->room / 2 : n < 65536 ? 65536 : n;
	b->p = xgrow(b->p, b->room, 1);
}

static int64_t read_at(exr_const_context_t c, void *user, void *to, uint64_t n, uint64_t at, exr_stream_error_func_ptr_t fail)
{
	const struct exr_blob *b = user;
	(void)c, (void)fail;
	if (at >= b->n)
		return 0;
	if (n > b->n - at)
		n = b->n - at;
	memcpy(to, b->p + at, n);
	return (int64_t)n;
}

static int64_t size_of(exr_const_context_t c, void *user)
{
	(void)c;
	return (int64_t)((const struct exr_blob *)user)->n;
}

static int64_t write_at(exr_const_context_t c, void *user, const void *from, uint64_t n, uint64_t at,
                          exr_stream_error_func_ptr_t fail)
{
	struct exr_blob *b = user;
	(void)c, (void)fail;
	exr_blob_reserve(b, at + n);
	if (at > b->n)
		memset(b->p + b->n, 0, at - b->n);
	memcpy(b->p + at, from, n);
	if (at + n > b->n)
		b->n = at + n;
	return (int64_t)n;
}

static void silent(exr_const_context_t c, exr_result_t code, const char *message)
{
	(void)c, (void)code, (void)message;
}

exr_context_initializer_t exr_blob_calls(struct exr_blob *b)
{
	exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
	init.error_handler_fn = silent;
	init.user_data = b;
	init.read_fn = read_at;
	init.size_fn = size_of;
	init.write_fn = write_at;
	return init;
}

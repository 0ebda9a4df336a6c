#include "base/die.h"

#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>

/* What dies leaves its memory as it is: nothing of it has leaked. */
static int died;
int __lsan_is_turned_off(void) { return died; }
#define LEAVE_MEMORY() (died = 1)
#else
#define LEAVE_MEMORY() ((void)0)
#endif

/* One write, so that lines of several processes in a pipe do not mix. */
static void say(const char *object, const char *fmt, va_list args)
{
	int error = errno;
	char text[1024], line[2048];
	vsnprintf(text, sizeof text, fmt, args);
	size_t n = strlen(text);
	snprintf(line, sizeof line, "%s: %s%s%s%s%s", program_invocation_short_name, object ? object : "",
	         object ? ": " : "", text, n && text[n - 1] == ':' ? " " : "", n && text[n - 1] == ':' ? strerror(error) : "");
	for (char *c = line; *c; c++)
		if ((unsigned char)*c < ' ' || *c == 127)
			*c = '?';
	fprintf(stderr, "%s\n", line);
}

void die(const char *object, const char *fmt, ...)
{
	va_list args;
	va_start(args, fmt);
	say(object, fmt, args);
	va_end(args);
	LEAVE_MEMORY();
	exit(2);
}

void warn(const char *object, const char *fmt, ...)
{
	va_list args;
	va_start(args, fmt);
	say(object, fmt, args);
	va_end(args);
}

void *xgrow(void *p, size_t n, size_t size)
{
	if (size && n > SIZE_MAX / size)
		die(NULL, "out of memory");
	p = realloc(p, n && size ? n * size : 1);
	if (!p)
		die(NULL, "out of memory");
	return p;
}

void *xalloc(size_t n, size_t size)
{
	void *p = calloc(n ? n : 1, size ? size : 1);
	if (!p)
		die(NULL, "out of memory");
	return p;
}

static char *printed(const char *fmt, va_list args)
{
	char *text;
	if (vasprintf(&text, fmt, args) < 0)
		die(NULL, "out of memory");
	return text;
}

char *xtext(const char *fmt, ...)
{
	va_list args;
	va_start(args, fmt);
	char *text = printed(fmt, args);
	va_end(args);
	return text;
}

void xappend(char **text, const char *fmt, ...)
{
	va_list args;
	va_start(args, fmt);
	char *more = printed(fmt, args);
	va_end(args);
	size_t before = strlen(*text), n = strlen(more) + 1;
	*text = xgrow(*text, before + n, 1);
	memcpy(*text + before, more, n);
	free(more);
}

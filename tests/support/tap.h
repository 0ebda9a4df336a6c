/* TAP for the C tests: plan(n), then ok(condition, "name ...") n times. */
#ifndef TESTS_TAP_H
#define TESTS_TAP_H

#include <stdarg.h>
#include <stdio.h>

static inline void plan(int n)
{
	printf("1..%d\n", n);
	setvbuf(stdout, NULL, _IOLBF, 0);
}

__attribute__((format(printf, 2, 3))) static inline int ok(int pass, const char *fmt, ...)
{
	va_list args;
	va_start(args, fmt);
	printf("%sok - ", pass ? "" : "not ");
	vprintf(fmt, args);
	putchar('\n');
	va_end(args);
	return pass;
}

#endif

/* TAP for the C tests: ok(condition, "name ...") as often as it takes, then return done_testing() from main. A test that dies before
 * has no plan, and prove fails it. */
#ifndef SUPPORT_TAP_H
#define SUPPORT_TAP_H

#include <stdarg.h>
#include <stdio.h>

static int tap_run, tap_failed;

__attribute__((format(printf, 2, 3))) static inline int ok(int pass, const char *fmt, ...)
{
	va_list args;
	va_start(args, fmt);
	printf("%sok %d - ", pass ? "" : "not ", ++tap_run);
	vprintf(fmt, args);
	putchar('\n');
	fflush(stdout);    /* what was found stands, whatever comes next */
	va_end(args);
	tap_failed += !pass;
	return pass;
}

/* The plan, counted; the exit status of main. */
static inline int done_testing(void)
{
	printf("1..%d\n", tap_run);
	return tap_run == 0 || tap_failed > 0;
}

#endif

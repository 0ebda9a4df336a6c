/* out - an output that appears under its name only when it is whole. */
#ifndef BASE_OUT_H
#define BASE_OUT_H

#include <stdio.h>

struct out {
	FILE *f;              /* write here */
	const char *path;     /* the final name; "-" is standard output */
	char *aside;          /* the name it has meanwhile; NULL if none */
	int nameless;         /* the file has no name yet: the kernel drops it should we die */
};

/* out_open - open standard output (path NULL or "-") or a new file that will replace path; dies on failure.
 * binary: refuse a terminal. A path that is no regular file (a device, a pipe) is written directly. */
struct out out_open(const char *path, int binary);

/* Should the program die or be interrupted (SIGHUP, SIGINT, SIGTERM), nothing is left behind. */

/* out_close - flush, check, and give the file its name; dies on failure. */
void out_close(struct out *out);

/* For a file that may as well not be, such as a cache's: f is NULL where it cannot be created, and out_finish, to be called in
 * any case, returns what went wrong (errno has why) or NULL. Nothing remains of a failure. */
struct out out_beside(const char *path);
const char *out_finish(struct out *out);

#endif

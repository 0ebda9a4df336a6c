/* out - an output that appears under its name only when it is whole. */
#ifndef BASE_OUT_H
#define BASE_OUT_H

#include <stdio.h>

struct out {
	FILE *f;              /* write here */
	const char *path;     /* as asked for, for messages; "-" is standard output */
	char *target;         /* the file that is replaced: path, or where its links lead; NULL: f is the output itself */
	char *aside;          /* the name it has meanwhile; NULL if none */
	int nameless;         /* the file has no name yet: the kernel drops it should we die */
	int into;             /* 1 + descriptor of the target, which gets a copy when all is whole; 0: it is replaced */
};

/* out_open - open standard output (path NULL or "-") or a new file that will replace path; dies on failure, and where the file there
 * must not be written. binary: refuse a terminal.
 *
 * Links are followed, and stay. What is no regular file (a device, a pipe), and /dev/stdout and others of /dev/fd are written directly.
 * A file keeps its owner and mode; where that needs it, as for one of several names, it is not replaced but written when all is whole. */
struct out out_open(const char *path, int binary);

/* Should the program die or be interrupted (SIGHUP, SIGINT, SIGTERM), nothing is left behind. */

/* out_close - flush, check, and give the file its name; dies on failure. */
void out_close(struct out *out);

/* For a file that may as well not be, such as a cache's: f is NULL where it cannot be created, and out_finish, to be called in
 * any case, returns what went wrong (errno has why) or NULL. Nothing remains of a failure. */
struct out out_beside(const char *path);
const char *out_finish(struct out *out);

/* out_fill_standard - see that descriptors 0 to 2 are open, so that no file gets one of them and then the messages of others, or is
 * read as standard input. Those that were closed fail as they would have. For the begin of a program. */
void out_fill_standard(void);

#endif

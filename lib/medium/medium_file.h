/* medium_file - a medium as a file, medium(5). */
#ifndef MEDIUM_MEDIUM_FILE_H
#define MEDIUM_MEDIUM_FILE_H

#include "medium/medium.h"

/* A file that is open. */
struct medium_file {
	struct medium medium;    /* its arrays lie in the map */
	uint32_t crc;            /* what a history says of its content */
	void *map;
	size_t size;
};

/* medium_file_write - write a file (not standard output: it is mapped when read), if medium_check has nothing against it. Dies. */
void medium_file_write(const char *path, const struct medium *m);

/* medium_file_open - verify a file by one sequential read, map it and check it by medium_check. Dies. */
void medium_file_open(const char *path, struct medium_file *f);

void medium_file_close(struct medium_file *f);

#endif

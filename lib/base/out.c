#include "base/out.h"

#include "base/die.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char *folder_of(const char *path)
{
	char *copy = xtext("%s", path), *folder = xtext("%s", dirname(copy));
	free(copy);
	return folder;
}

struct out out_open(const char *path, int binary)
{
	struct out out = { .path = path && strcmp(path, "-") ? path : "-" };
	struct stat st;
	if (!strcmp(out.path, "-")) {
		if (binary && isatty(STDOUT_FILENO))
			die("standard output", "is a terminal; binary data goes to a file or a pipe");
		out.f = stdout;
		return out;
	}
	if (!stat(out.path, &st) && !S_ISREG(st.st_mode)) {
		out.f = fopen(out.path, "wb");
		if (!out.f)
			die(out.path, "cannot open:");
		return out;
	}
	char *folder = folder_of(out.path);
	mode_t mask = umask(0);
	umask(mask);
	int fd = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
	out.aside = xtext("%s.tmp-%ld", out.path, (long)getpid());
	out.nameless = fd >= 0;
	if (fd < 0)     /* a file system without nameless files */
		fd = open(out.aside, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666 & ~mask);
	out.f = fd < 0 ? NULL : fdopen(fd, "wb");
	if (!out.f)
		die(out.path, "cannot create:");
	free(folder);
	return out;
}

void out_close(struct out *out)
{
	int bad = fflush(out->f) || ferror(out->f);
	if (bad)
		die(!strcmp(out->path, "-") ? "standard output" : out->path, "cannot write:");
	if (out->nameless) {
		char *self = xtext("/proc/self/fd/%d", fileno(out->f));
		if (linkat(AT_FDCWD, self, AT_FDCWD, out->aside, AT_SYMLINK_FOLLOW))
			die(out->path, "cannot name the finished file:");
		free(self);
	}
	if (fclose(out->f) && errno != EBADF)
		die(!strcmp(out->path, "-") ? "standard output" : out->path, "cannot write:");
	if (out->aside && rename(out->aside, out->path))
		die(out->path, "cannot rename:");
	free(out->aside);
	out->aside = NULL;
}

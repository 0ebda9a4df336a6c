#include "base/out.h"

#include "base/die.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <signal.h>
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

/* Without nameless files somebody has to sweep: names still in use, removed at any exit that is not a SIGKILL. */
static char *volatile in_use[16];

static void sweep(void)
{
	for (size_t i = 0; i < sizeof in_use / sizeof *in_use; i++)
		if (in_use[i])
			unlink(in_use[i]);
}

static void interrupted(int number)
{
	sweep();
	raise(number);     /* SA_RESETHAND: this time it kills */
}

static void keep_swept(char *name)
{
	static const int numbers[] = { SIGHUP, SIGINT, SIGTERM, SIGPIPE };
	static int ready;
	for (size_t i = 0; !ready && i < sizeof numbers / sizeof *numbers; i++) {
		struct sigaction was, now = { .sa_handler = interrupted, .sa_flags = (int)SA_RESETHAND | SA_NODEFER };
		if (!sigaction(numbers[i], NULL, &was) && was.sa_handler == SIG_DFL)
			sigaction(numbers[i], &now, NULL);
	}
	if (!ready++)
		atexit(sweep);
	for (size_t i = 0; i < sizeof in_use / sizeof *in_use; i++)
		if (!in_use[i]) {
			in_use[i] = name;
			return;
		}
}

static void swept(const char *name)
{
	for (size_t i = 0; i < sizeof in_use / sizeof *in_use; i++)
		if (in_use[i] == name)
			in_use[i] = NULL;
}

/* What a nameless file is called meanwhile. */
static char *self_of(int fd)
{
	return xtext("/proc/self/fd/%d", fd);
}

static int nameable(int fd)
{
	char *self = self_of(fd);
	int there = !access(self, F_OK);
	free(self);
	return there;
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
	if (fd >= 0 && !nameable(fd)) {
		close(fd);
		fd = -1;
	}
	out.aside = xtext("%s.tmp-%ld", out.path, (long)getpid());
	out.nameless = fd >= 0;
	if (fd < 0) {   /* a file system without nameless files, or no /proc */
		fd = open(out.aside, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666 & ~mask);
		if (fd >= 0)
			keep_swept(out.aside);
	}
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
		char *self = self_of(fileno(out->f));
		unlink(out->aside);     /* of a dead process that had our number */
		keep_swept(out->aside);
		if (linkat(AT_FDCWD, self, AT_FDCWD, out->aside, AT_SYMLINK_FOLLOW))
			die(out->path, "cannot name the finished file:");
		free(self);
	}
	if (fclose(out->f) && errno != EBADF)
		die(!strcmp(out->path, "-") ? "standard output" : out->path, "cannot write:");
	if (out->aside && rename(out->aside, out->path))
		die(out->path, "cannot rename:");
	swept(out->aside);
	free(out->aside);
	out->aside = NULL;
}

#include "base/out.h"

#include "base/die.h"
#include "base/standard.h"

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

/* Where a regular file is to appear: a nameless one, or else one with a name of its own. f is NULL where neither can be. */
struct out out_beside(const char *path)
{
	struct out out = { .path = path };
	char *folder = folder_of(path);
	mode_t mask = umask(0);
	umask(mask);
	int fd = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
	if (fd >= 0 && !nameable(fd)) {
		close(fd);
		fd = -1;
	}
	out.aside = xtext("%s.tmp-%ld", path, (long)getpid());
	out.nameless = fd >= 0;
	if (fd < 0) {   /* a file system without nameless files, or no /proc */
		fd = open(out.aside, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666 & ~mask);
		if (fd >= 0)
			keep_swept(out.aside);
	}
	out.f = fd < 0 ? NULL : fdopen(fd, "wb");
	free(folder);
	return out;
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
	if (!stat(out.path, &st) && !S_ISREG(st.st_mode))
		out.f = fopen(out.path, "wb");
	else
		out = out_beside(out.path);
	if (!out.f)
		die(out.path, out.aside ? "cannot create:" : "cannot open:");
	return out;
}

/* Give a nameless file the name that it has aside; -1 on failure. */
static int name_aside(struct out *out)
{
	char *self = self_of(fileno(out->f));
	unlink(out->aside);     /* of a dead process that had our number */
	keep_swept(out->aside);
	int bad = linkat(AT_FDCWD, self, AT_FDCWD, out->aside, AT_SYMLINK_FOLLOW);
	free(self);
	return bad;
}

const char *out_finish(struct out *out)
{
	const char *wrong = NULL;
	int error = errno;
	if (!out->f)
		wrong = "cannot create:";
	else if (fflush(out->f) || ferror(out->f))
		wrong = "cannot write:";
	else if (out->nameless && name_aside(out))
		wrong = "cannot name the finished file:";
	error = wrong && out->f ? errno : error;
	if (out->f && fclose(out->f) && errno != EBADF && !wrong) {
		wrong = "cannot write:";
		error = errno;
	}
	if (!wrong && out->aside && rename(out->aside, out->path)) {
		wrong = "cannot rename:";
		error = errno;
	}
	if (wrong && out->aside)
		unlink(out->aside);
	swept(out->aside);
	free(out->aside);
	out->aside = NULL;
	errno = error;
	return wrong;
}

void out_close(struct out *out)
{
	const char *wrong = out_finish(out);
	if (wrong)
		die(standard_output(out->path), "%s", wrong);
}

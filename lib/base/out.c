#include "base/out.h"

#include "base/die.h"
#include "base/standard.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <limits.h>
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
static void beside(struct out *out)
{
	char *folder = folder_of(out->target);
	mode_t mask = umask(0);
	umask(mask);
	int fd = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
	if (fd >= 0 && !nameable(fd)) {
		close(fd);
		fd = -1;
	}
	out->aside = xtext("%s.tmp-%ld", out->target, (long)getpid());
	out->nameless = fd >= 0;
	if (fd < 0) {   /* a file system without nameless files, or no /proc */
		unlink(out->aside);
		fd = open(out->aside, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666 & ~mask);
		if (fd >= 0)
			keep_swept(out->aside);
	}
	out->f = fd < 0 ? NULL : fdopen(fd, "w+b");
	free(folder);
}

struct out out_beside(const char *path)
{
	struct out out = { .path = path, .target = xtext("%s", path) };
	beside(&out);
	return out;
}

static void lose_aside(struct out *out)
{
	if (out->aside)
		unlink(out->aside);
	swept(out->aside);
	free(out->aside);
	out->aside = NULL;
}

/* Where a file of before is: the new one gets its owner and mode, or, where only its content may change, is copied into it. */
static void over(struct out *out, int into, const struct stat *was)
{
	struct stat now;
	beside(out);
	if (out->f && was->st_nlink == 1 && !fstat(fileno(out->f), &now)
	    && ((now.st_uid == was->st_uid && now.st_gid == was->st_gid) || !fchown(fileno(out->f), was->st_uid, was->st_gid))
	    && !fchmod(fileno(out->f), was->st_mode & 07777)) {
		close(into);
		return;
	}
	if (out->f)
		fclose(out->f);
	lose_aside(out);
	out->nameless = 0;
	out->into = 1 + into;
	out->f = tmpfile();
}

#define LINKS_MOST 40

/* The descriptor of this process that a path like /dev/stdout or /dev/fd/3 is, or -1. */
static int descriptor_of(const char *path)
{
	char *folder = folder_of(path), *real = realpath(folder, NULL), *own = xtext("/proc/%ld/fd", (long)getpid()), *end;
	const char *name = strrchr(path, '/');
	int fd = -1;
	if (name && real && !strcmp(real, own) && name[1] >= '0' && name[1] <= '9') {
		long number = strtol(name + 1, &end, 10);
		fd = *end || number > INT_MAX ? -1 : (int)number;
	}
	free(folder);
	free(real);
	free(own);
	return fd;
}

/* Follow a path's own links, also one that leads to nothing yet. *fd: the descriptor that it comes to, or -1. NULL: errno has why. */
static char *follow(const char *path, int *fd)
{
	char *at = xtext("%s", path);
	for (int links = 0;; links++) {
		char to[PATH_MAX];
		*fd = descriptor_of(at);
		ssize_t n = *fd >= 0 ? -1 : readlink(at, to, sizeof to - 1);
		if (n < 0)
			return at;         /* no link */
		if (links == LINKS_MOST) {
			free(at);
			errno = ELOOP;
			return NULL;
		}
		to[n] = 0;
		char *folder = folder_of(at), *next = *to == '/' ? xtext("%s", to) : xtext("%s/%s", folder, to);
		free(folder);
		free(at);
		at = next;
	}
}

static FILE *stream_of(int fd)
{
	int own = fcntl(fd, F_DUPFD_CLOEXEC, 3);
	return own < 0 ? NULL : fdopen(own, "wb");
}

struct out out_open(const char *path, int binary)
{
	struct out out = { .path = path && strcmp(path, "-") ? path : "-" };
	struct stat st;
	int fd = -1, into = -1;
	if (!strcmp(out.path, "-")) {
		if (binary && isatty(STDOUT_FILENO))
			die("standard output", "is a terminal; binary data goes to a file or a pipe");
		out.f = stdout;
		return out;
	}
	char *target = follow(out.path, &fd);
	int there = target && fd < 0 && !stat(target, &st);
	if (!target)
		die(out.path, "cannot open:");
	if (fd >= 0) {
		out.f = stream_of(fd);
	} else if (there && !S_ISREG(st.st_mode)) {
		out.f = fopen(target, "wb");
	} else if (!there) {
		out.target = target;
		beside(&out);
	} else {
		out.target = target;
		if (!(st.st_mode & 0222))    /* which holds for the superuser, too */
			die(out.path, "is read-only");
		into = open(target, O_WRONLY | O_CLOEXEC);
		if (into >= 0)
			over(&out, into, &st);
	}
	if (!out.f)
		die(out.path, out.aside ? "cannot create:" : "cannot open:");
	if (!out.target && binary && isatty(fileno(out.f)))
		die(out.path, "is a terminal; binary data goes to a file or a pipe");
	if (!out.target)
		free(target);
	return out;
}

/* All that was written into the target. -1 on failure. */
static int copy_into(struct out *out)
{
	int from = fileno(out->f), into = out->into - 1;
	static char buffer[1 << 16];
	off_t at = 0;
	ssize_t n;
	if (ftruncate(into, 0))
		return -1;
	while ((n = pread(from, buffer, sizeof buffer, at)) > 0)
		for (ssize_t done = 0; done < n;) {
			ssize_t put = pwrite(into, buffer + done, (size_t)(n - done), at);
			if (put <= 0)
				return -1;
			done += put;
			at += put;
		}
	return n < 0 ? -1 : 0;
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
	else if (fflush(out->f) || ferror(out->f) || (out->into && copy_into(out)))
		wrong = "cannot write:";
	else if (out->nameless && name_aside(out))
		wrong = "cannot name the finished file:";
	error = wrong && out->f ? errno : error;
	if (out->into && close(out->into - 1) && !wrong) {
		wrong = "cannot write:";
		error = errno;
	}
	if (out->f && fclose(out->f) && errno != EBADF && !wrong) {
		wrong = "cannot write:";
		error = errno;
	}
	if (!wrong && out->aside && rename(out->aside, out->target)) {
		wrong = "cannot rename:";
		error = errno;
	}
	if (!wrong) {
		swept(out->aside);
		free(out->aside);
		out->aside = NULL;
	}
	lose_aside(out);
	free(out->target);
	out->target = NULL;
	errno = error;
	return wrong;
}

void out_close(struct out *out)
{
	const char *wrong = out_finish(out);
	if (wrong)
		die(standard_output(out->path), "%s", wrong);
}

void out_fill_standard(void)
{
	for (int fd = 0; fd <= STDERR_FILENO; fd++)
		if (fcntl(fd, F_GETFD) < 0 && errno == EBADF)    /* the lowest free one is what open gives */
			if (open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY) != fd)
				_exit(2);
}

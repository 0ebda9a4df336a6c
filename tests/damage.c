/* Damaged input: every tool that reads a table or an image gets it cut short, with single bits turned over, and followed by
 * another, and has to say so in one line and exit with 2. A table is guarded by a checksum, so that no damage may go unseen; an
 * image is not in all its parts, so that a turned bit may pass there, but never silently end a tool or upset the sanitizers.
 *
 * DAMAGE=all in the environment tries every bit for every reader (minutes). To add a tool, add a row to readers[]. */
#include "base/die.h"
#include "base/tab.h"
#include "image/exr.h"
#include "tap.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#define WORKERS 2
#define SECONDS 20

enum kind { SIZES, IMAGE_ZIP, IMAGE_PIZ, IMAGE_TILED, KINDS };

static const char *const kind_names[] = { "table", "zip image", "piz image", "tiled image" };

/* The input comes on standard input; INPUT stands for the name of an undamaged file of the same kind. */
#define INPUT "INPUT"
static const struct reader {
	const char *tool;
	enum kind kind;
	int stride;              /* every how many bits are turned over, and bytes cut: prime, to meet all bits of a byte */
	const char *args[10];
} readers[] = {
	{ "tabtxt", SIZES, 1, { NULL } },
	{ "tabcmp", SIZES, 13, { "-", INPUT, NULL } },
	{ "mie-coeffs", SIZES, 31, { "--particle", "1.33", "--wavelength", "550nm", NULL } },
	{ "mie-phase", SIZES, 31, { "--particle", "1.33", "--wavelength", "550nm", "--angles", "3", NULL } },
	{ "goa-phase", SIZES, 31, { "--particle", "1.33", "--wavelength", "550nm", "--angles", "3", NULL } },
	{ "xsect", SIZES, 31, { "--particle", "1.33", "--wavelength", "550nm", NULL } },
	{ "particles", SIZES, 31, { "--psd", "-", "--count", "3", "--box", "1m,1m,1m", NULL } },
	{ "exr2png", IMAGE_ZIP, 23, { NULL } },
	{ "exr2png", IMAGE_PIZ, 23, { NULL } },
	{ "exr2png", IMAGE_TILED, 23, { NULL } },
	{ "imgcmp", IMAGE_TILED, 41, { "-", INPUT, NULL } },
};
#define READERS (sizeof readers / sizeof *readers)

static char folder[] = "/tmp/damage-XXXXXX", *inputs[KINDS];
extern char **environ;

struct bytes {
	unsigned char *p;
	size_t n;
};

static struct bytes contents(const char *path)
{
	struct bytes b = { xalloc(1 << 20, 1), 0 };
	FILE *f = fopen(path, "rb");
	if (!f)
		die(path, "cannot open:");
	b.n = fread(b.p, 1, 1 << 20, f);
	fclose(f);
	return b;
}

static void make_inputs(void)
{
	if (!mkdtemp(folder))
		die(folder, "cannot create:");
	for (int i = 0; i < KINDS; i++)
		inputs[i] = xtext("%s/%d", folder, i);
	struct tab_col cols[] = { { "radius", TAB_F64, "um" }, { "weight", TAB_F64, "1" }, { "radius_lo", TAB_F64, "um" },
	                          { "radius_hi", TAB_F64, "um" } };
	struct tab_out *t = tab_create(inputs[SIZES], "", "psd mono", 4, cols);
	tab_put(t, (double[]){ 1, 0.75, 0.5, 2 });
	tab_put(t, (double[]){ 3, 0.25, 2, 4 });
	tab_finish(t);

	struct exr image = { .width = 17, .height = 19, .history = xtext("vrender\n") };
	static const char *const names[] = { "R", "G", "B", "count" };
	for (int i = 0; i < 4; i++) {
		float *data = exr_add(&image, names[i]);
		image.channel[i].is_uint = i == 3;
		for (int p = 0; p < 17 * 19; p++)
			data[p] = (float)(p * (i + 1) % 61) / 64;
	}
	exr_write(inputs[IMAGE_ZIP], &image);
	exr_free(&image);
	char *command = xtext("cd %s && oiiotool 1 --ch R,G,B -d half --compression piz -o 2.exr && mv 2.exr 2 && "
	    "oiiotool 1 --ch R,G,B -d float --compression pxr24 --tile 16 16 -o 3.exr && mv 3.exr 3", folder);
	if (system(command))
		die("oiiotool", "cannot make the images to be damaged");
	free(command);
}

static void write_all(int fd, const unsigned char *p, size_t n)
{
	while (n) {
		ssize_t got = write(fd, p, n);
		if (got <= 0)
			die("temporary file", "cannot write:");
		p += got;
		n -= (size_t)got;
	}
}

/* Feed the bytes to the tool. Returns its exit status, 100 + the signal that ended it; *lines and *printed of what it wrote. */
static int feed(const struct reader *r, const struct bytes *b, const struct bytes *more, int *lines, size_t *printed)
{
	char path[4096], *argv[12] = { (char *)(uintptr_t)r->tool };
	int in = memfd_create("in", 0), out = memfd_create("out", 0), err = memfd_create("err", 0), status;
	posix_spawn_file_actions_t actions;
	pid_t child;
	snprintf(path, sizeof path, "%s/bin/%s", getenv("MOTES_BUILD"), r->tool);
	for (int i = 0; r->args[i]; i++)
		argv[i + 1] = (char *)(uintptr_t)(!strcmp(r->args[i], INPUT) ? inputs[r->kind] : r->args[i]);
	write_all(in, b->p, b->n);
	if (more)
		write_all(in, more->p, more->n);
	lseek(in, 0, SEEK_SET);
	posix_spawn_file_actions_init(&actions);
	posix_spawn_file_actions_adddup2(&actions, in, 0);
	posix_spawn_file_actions_adddup2(&actions, out, 1);
	posix_spawn_file_actions_adddup2(&actions, err, 2);
	if (posix_spawn(&child, path, &actions, NULL, argv, environ))
		die(path, "cannot run:");
	posix_spawn_file_actions_destroy(&actions);
	for (int waited = 0; !waitpid(child, &status, WNOHANG); waited++) {
		usleep(waited < 100 ? 200 : 20000);
		if (waited == SECONDS * 50)
			kill(child, SIGKILL);
	}
	char text[65536];
	ssize_t n = pread(err, text, sizeof text, 0);
	*lines = n > 0 && text[n - 1] != '\n';
	for (ssize_t i = 0; i < n; i++)
		*lines += text[i] == '\n';
	*printed = (size_t)lseek(out, 0, SEEK_END);
	close(in);
	close(out);
	close(err);
	return WIFEXITED(status) ? WEXITSTATUS(status) : 100 + WTERMSIG(status);
}

/* One trial; 1 if it went wrong. may_pass: the damage need not be seen. */
static int trial(const struct reader *r, const struct bytes *b, const struct bytes *more, int may_pass, const char *what, size_t at)
{
	int lines;
	size_t printed;
	int status = feed(r, b, more, &lines, &printed);
	if ((status == 2 && lines == 1 && !printed) || (may_pass && (status == 0 || status == 1) && !lines))
		return 0;
	printf("# %s, %s %zu of %zu bytes: exit %d, %d lines on stderr, %zu bytes on stdout\n", r->tool, what, at, b->n, status,
	       lines, printed);
	return 1;
}

/* The worker's share of all trials; stops at the fourth that goes wrong. */
static int share(const struct reader *r, const struct bytes *whole, size_t worker)
{
	size_t stride = getenv("DAMAGE") && !strcmp(getenv("DAMAGE"), "all") ? 1 : (size_t)r->stride, number = 0;
	struct bytes b = { xalloc(whole->n, 1), whole->n };
	int wrong = 0;
	memcpy(b.p, whole->p, whole->n);
	for (b.n = 0; b.n < whole->n && wrong < 4; b.n += stride)
		if (number++ % WORKERS == worker)
			wrong += trial(r, &b, NULL, 0, "cut at", b.n);
	b.n = whole->n;
	for (size_t bit = 0; bit < 8 * whole->n && wrong < 4; bit += stride)
		if (number++ % WORKERS == worker) {
			b.p[bit / 8] ^= (unsigned char)(1 << bit % 8);
			wrong += trial(r, &b, NULL, r->kind != SIZES, "turned over: bit", bit);
			b.p[bit / 8] ^= (unsigned char)(1 << bit % 8);
		}
	if (r->kind == SIZES && worker == 0)
		wrong += trial(r, &b, whole, 0, "followed by another", 0) + trial(r, &b, &(struct bytes){ whole->p, 1 }, 0, "and a byte", 1);
	free(b.p);
	return wrong;
}

static int survives(const struct reader *r, const struct bytes *whole)
{
	pid_t workers[WORKERS];
	int wrong = 0;
	fflush(stdout);
	for (size_t i = 0; i < WORKERS; i++) {
		workers[i] = fork();
		if (!workers[i]) {
			int bad = share(r, whole, i);
			fflush(stdout);
			_exit(bad != 0);
		}
	}
	for (size_t i = 0; i < WORKERS; i++) {
		int status;
		waitpid(workers[i], &status, 0);
		wrong |= status;
	}
	return !wrong;
}

int main(void)
{
	if (!getenv("MOTES_BUILD"))
		die("MOTES_BUILD", "is not set; run by tests/run");
	setenv("ASAN_OPTIONS", "exitcode=99", 0);
	setenv("OMP_NUM_THREADS", "1", 0);
	plan(2 * READERS);
	make_inputs();
	for (size_t i = 0; i < READERS; i++) {
		const struct reader *r = &readers[i];
		char *path = xtext("%s/bin/%s", getenv("MOTES_BUILD"), r->tool);
		if (access(path, X_OK)) {
			ok(1, "%s # skip not built", r->tool);
			ok(1, "%s # skip not built", r->tool);
		} else {
			struct bytes whole = contents(inputs[r->kind]);
			int lines;
			size_t printed;
			ok(feed(r, &whole, NULL, &lines, &printed) == 0 && !lines, "%s takes a whole %s", r->tool, kind_names[r->kind]);
			ok(survives(r, &whole), "%s bears with a damaged one", r->tool);
			free(whole.p);
		}
		free(path);
	}
	for (int i = 0; i < KINDS; i++) {
		unlink(inputs[i]);
		free(inputs[i]);
	}
	rmdir(folder);
	return 0;
}

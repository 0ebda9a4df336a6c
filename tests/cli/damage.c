/* Damaged input: every tool that reads a table or an image gets it cut short, with single bits turned over, and followed by
 * another, and has to say so in one line and exit with 2. A table is guarded by a checksum, so that no damage may go unseen; an
 * image is not in all its parts, so that a turned bit may pass there, but never silently end a tool or upset the sanitizers. So may
 * damage behind a checksum that was made right again: single bits, and pieces of a file that all have the same value.
 *
 * DAMAGE=all in the environment tries every bit for every reader (minutes). To add a tool, add a row to readers[]. */
#include "base/die.h"
#include "format/tab.h"
#include "format/exr.h"
#include "support/tap.h"

#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <spawn.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#define WORKERS 2
#define SECONDS 20

/* What is damaged: a file of this name in the test's folder, where make_inputs puts it. */
static const struct input {
	const char *name;
	size_t checksum;         /* of all before it, so many bytes from the end: no damage may go unseen; 0: there is none */
} sizes = { "sizes", 4 }, coeffs = { "coeffs", 4 }, xsect = { "xsect", 4 }, phase = { "phase", 4 },
  grains = { "grains", 4 }, medium = { "medium", 8 }, field = { "field", 8 }, scene = { "scene", 0 },
  csv = { "csv", 0 }, npy = { "npy", 0 }, ply = { "ply", 0 },
  zip = { "zip.exr", 0 }, part = { "part.exr", 0 }, piz = { "piz.exr", 0 }, tiled = { "tiled.exr", 0 };

#define LIGHT "--particle", "1.33", "--wavelength", "550nm"
#define BAKE "--box", "1m,1m,1m", "-o", "@out"

/* The damaged input comes on standard input; @NAME is the path of an undamaged one, @out of an output. */
static const struct reader {
	const char *tool;
	const struct input *input;
	int stride;              /* every how many bits are turned over, and bytes cut: prime, to meet all bits of a byte */
	const char *args[14];
} readers[] = {
	{ "tabtxt", &sizes, 1, { NULL } },
	{ "txttab", &csv, 1, { "--units", "radius=um", "-o", "@out", NULL } },
	{ "txttab", &npy, 3, { "-o", "@out", NULL } },
	{ "txttab", &ply, 3, { "--units", "radius=um", "-o", "@out", NULL } },
	{ "tabcat", &sizes, 31, { "-o", "@out", "@sizes", "-", NULL } },
	{ "tabcmp", &sizes, 13, { "-", "@sizes", NULL } },
	{ "mie-coeffs", &sizes, 31, { LIGHT, NULL } },
	{ "mie-phase", &sizes, 31, { LIGHT, "--theta", "0:180:90", NULL } },
	{ "mie-phase", &coeffs, 31, { "--theta", "0:180:90", NULL } },
	{ "goa-phase", &sizes, 31, { LIGHT, "--theta", "0:180:90", NULL } },
	{ "xsect", &sizes, 31, { LIGHT, NULL } },
	{ "xsect", &coeffs, 31, { NULL } },
	{ "particles", &sizes, 31, { "--psd", "-", "--count", "3", "--box", "1m,1m,1m", NULL } },
	{ "medium-bake", &grains, 31, { "--xsect", "@xsect", "--phase", "@phase", BAKE, NULL } },
	{ "medium-bake", &xsect, 31, { "--xsect", "-", "--phase", "@phase", BAKE, "@grains", NULL } },
	{ "medium-bake", &phase, 31, { "--xsect", "@xsect", "--phase", "-", BAKE, "@grains", NULL } },
	{ "vrender", &medium, 499, { "--samples", "1", "-o", "@out", "@from-stdin", NULL } },
	{ "vrender", &medium, 997, { "--samples", "1", "--transport", "grid", "-o", "@out", "@from-stdin", NULL } },
	{ "vrender", &field, 997, { "--samples", "1", "--transport", "grid", "-o", "@out", "@from-stdin", NULL } },
	{ "vrender", &scene, 19, { "--samples", "1", "-o", "@out", "/dev/stdin", NULL } },
	{ "exr2png", &zip, 31, { NULL } },
	{ "exr2png", &piz, 31, { NULL } },
	{ "exr2png", &tiled, 31, { NULL } },
	{ "exr-merge", &part, 53, { "-o", "@out", "-", NULL } },
	{ "imgcmp", &tiled, 41, { "-", "@tiled.exr", NULL } },
};
#define READERS (sizeof readers / sizeof *readers)

static char folder[] = "/tmp/damage-XXXXXX";
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

static char *in_folder(const char *name)
{
	return xtext("%s/%s", folder, name);
}

/* A table of rows by cols values; columns are name and unit by turns. */
static void table(const char *name, const char *law, int ncols, const char *const *columns, int rows, const double *values)
{
	struct tab_col cols[TAB_COLS];
	char *path = in_folder(name);
	for (int i = 0; i < ncols; i++) {
		cols[i].type = TAB_F64;
		strcpy(cols[i].name, columns[2 * i]);
		strcpy(cols[i].unit, columns[2 * i + 1]);
	}
	struct tab_out *t = tab_create(path, "", "by hand", law, ncols, cols);
	for (int i = 0; i < rows; i++)
		tab_put(t, values + i * ncols);
	tab_finish(t);
	free(path);
}
#define WORDS (const char *const[])
#define ROWS (const double[])

static void write_scene(const char *name, const char *file)
{
	char *path = in_folder(name);
	FILE *f = fopen(path, "w");
	if (!f)
		die(path, "cannot create:");
	fprintf(f, "camera = { position = [0.0, 0.0, 3.0]; target = [0.0, 0.0, 0.0]; fov = 34.0; resolution = [6, 4]; };\n"
	    "medium = { file = \"%s\"; };\nlights = ( { type = \"sun\"; direction = [0.0, -1.0, 0.0]; irradiance = 3.0; } );\n", file);
	fclose(f);
	free(path);
}

static void make_inputs(void)
{
	if (!mkdtemp(folder))
		die(folder, "cannot create:");
	table("sizes", "uniform min=0.5 max=4", 4, WORDS{ "radius", "um", "weight", "1", "radius_lo", "um", "radius_hi", "um" }, 2,
	      ROWS{ 1, 3.0 / 7, 0.5, 2, 3, 4.0 / 7, 2, 4 });
	table("coeffs", NULL, 8, WORDS{ "x", "1", "host_re", "1", "host_im", "1", "n", "1", "a_re", "1", "a_im", "1", "b_re", "1", "b_im", "1" },
	      2, ROWS{ 1, 1, 0, 1, 0.5, 0.5, 0.1, 0.3, 1, 1, 0, 2, 0.01, 0.1, 0, 0 });
	table("xsect", NULL, 4, WORDS{ "wavelength", "um", "radius", "um", "c_ext", "um^2", "c_sca", "um^2" }, 2,
	      ROWS{ 0.55, 1, 6, 5, 0.55, 3, 60, 50 });
	table("phase", NULL, 3, WORDS{ "wavelength", "um", "theta", "deg", "p", "sr^-1" }, 3,
	      ROWS{ 0.55, 0, M_1_PI / 4, 0.55, 90, M_1_PI / 4, 0.55, 180, M_1_PI / 4 });
	table("grains", NULL, 4, WORDS{ "x", "m", "y", "m", "z", "m", "radius", "um" }, 2, ROWS{ 0, 0, 0, 1, 0.1, 0.2, 0.3, 3 });

	char *path = in_folder("csv");
	FILE *f = fopen(path, "w");
	if (!f)
		die(path, "cannot create:");
	fprintf(f, "\xef\xbb\xbf\"id\",x , radius\r\n1,2, \"3.5\"\r\n2,-1e-3,nan\r\n");
	fclose(f);
	free(path);

	struct exr image = { .width = 17, .height = 19, .history = xtext("vrender\n") };
	static const char *const names[] = { "R", "G", "B", "count" };
	for (int i = 0; i < 4; i++) {
		float *data = exr_add(&image, names[i]);
		image.channel[i].is_uint = i == 3;
		for (int p = 0; p < 17 * 19; p++)
			data[p] = (float)(p * (i + 1) % 61) / 64;
	}
	path = in_folder("zip.exr");
	exr_write((struct out[]){ out_open(path, 1) }, &image);
	exr_free(&image);
	free(path);

	write_scene("from-stdin", "/dev/stdin");
	path = in_folder("medium");
	write_scene("scene", path);
	free(path);
	char *command = xtext("cd %s && oiiotool zip.exr --ch R,G,B -d half --compression piz -o piz.exr && "
	    "oiiotool zip.exr --ch R,G,B -d float --compression pxr24 --tile 16 16 -o tiled.exr && "
	    "\"$BIN/tabtxt\" --npy grains -o npy && "
	    "{ printf 'ply\\nformat binary_big_endian 1.0\\nelement thing 1\\nproperty list uchar short some\\nelement vertex 2\\n"
	    "property float x\\nproperty list uchar int of\\nproperty double radius\\nend_header\\n"
	    "\\002\\000\\001\\000\\002\\077\\200\\000\\000\\001\\000\\000\\000\\005\\100\\010\\000\\000\\000\\000\\000\\000"
	    "\\100\\000\\000\\000\\000\\100\\020\\000\\000\\000\\000\\000\\000'; } >ply && "
	    "{ ! [ -x \"$BIN/medium-bake\" ] || \"$BIN/medium-bake\" --xsect xsect --phase phase --box 1m,1m,1m -o medium grains; } && "
	    "{ ! [ -x \"$BIN/medium-bake\" ] || \"$BIN/medium-bake\" --xsect xsect --phase phase --psd sizes --concentration 1e9/m3 "
	    "--box 1m,1m,1m --voxels 3 --host 1.33+1e-9i -o field; } && "
	    "{ ! [ -x \"$BIN/vrender\" ] || \"$BIN/vrender\" --sample-range 0:2 --spectral -o part.exr scene; }", folder);
	if (system(command))
		die(folder, "cannot make the files to be damaged");
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

/* Feed the bytes to the tool. Returns its exit status, 100 + the signal that ended it; *lines it wrote to stderr, and *printed:
 * the bytes it wrote to stdout and its output file. */
static int feed(const struct reader *r, const struct bytes *b, const struct bytes *more, int *lines, size_t *printed)
{
	char *path = xtext("%s/%s", getenv("BIN"), r->tool), *output = xtext("%s/out-%ld", folder, (long)getpid());
	char *argv[16] = { (char *)(uintptr_t)r->tool };
	int in = memfd_create("in", 0), out = memfd_create("out", 0), err = memfd_create("err", 0), status;
	posix_spawn_file_actions_t actions;
	pid_t child;
	for (int i = 0; r->args[i]; i++) {
		const char *arg = r->args[i];
		argv[i + 1] = !strcmp(arg, "@out") ? xtext("%s", output) : *arg == '@' ? in_folder(arg + 1) : xtext("%s", arg);
	}
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
	*printed = (size_t)lseek(out, 0, SEEK_END) + !unlink(output);
	for (int i = 1; argv[i]; i++)
		free(argv[i]);
	free(path);
	free(output);
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

/* Make the checksum right again. */
static void repair(const struct reader *r, struct bytes *b)
{
	size_t at = b->n - r->input->checksum;
	uint32_t crc = (uint32_t)crc32(crc32(0, NULL, 0), b->p, (unsigned)at);
	for (size_t i = 0; i < 4; i++)
		b->p[at + i] = (unsigned char)(crc >> 8 * i);
}

#define PIECE 64             /* bytes */

/* What a checksum does not see: single bits, and pieces of one value. b holds the whole input, and does so again. */
static int forgery(const struct reader *r, struct bytes *b, const struct bytes *whole, size_t stride, size_t worker)
{
	static const unsigned char values[] = { 0, 1, 0x7f, 0xf0, 0xff };
	size_t number = 0, guarded = whole->n - r->input->checksum;
	int wrong = 0;
	for (size_t bit = 0; bit < 8 * guarded && wrong < 4; bit += stride)
		if (number++ % WORKERS == worker) {
			b->p[bit / 8] ^= (unsigned char)(1 << bit % 8);
			repair(r, b);
			wrong += trial(r, b, NULL, 1, "forged: bit", bit);
			memcpy(b->p, whole->p, whole->n);
		}
	for (size_t at = 0; at < guarded && wrong < 4; at += PIECE)
		for (size_t v = 0; v < sizeof values && wrong < 4; v++)
			if (number++ % WORKERS == worker) {
				memset(b->p + at, values[v], guarded - at < PIECE ? guarded - at : PIECE);
				repair(r, b);
				wrong += trial(r, b, NULL, 1, "forged: piece at", at);
				memcpy(b->p, whole->p, whole->n);
			}
	return wrong;
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
			wrong += trial(r, &b, NULL, r->input == &scene || r->input == &csv, "cut at", b.n);
	b.n = whole->n;
	for (size_t bit = 0; bit < 8 * whole->n && wrong < 4; bit += stride)
		if (number++ % WORKERS == worker) {
			b.p[bit / 8] ^= (unsigned char)(1 << bit % 8);
			wrong += trial(r, &b, NULL, !r->input->checksum, "turned over: bit", bit);
			b.p[bit / 8] ^= (unsigned char)(1 << bit % 8);
		}
	if (r->input->checksum)
		wrong += forgery(r, &b, whole, stride, worker);
	if (r->input->checksum && worker == 0)
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
	char *build = realpath(getenv("MOTES_BUILD"), NULL), *bin = xtext("%s/bin", build);
	setenv("BIN", bin, 1);
	setenv("ASAN_OPTIONS", "exitcode=99", 0);     /* for the tools: as in tests/support/lib.sh */
	setenv("OMP_NUM_THREADS", "1", 0);
	make_inputs();
	for (size_t i = 0; i < READERS; i++) {
		const struct reader *r = &readers[i];
		char *tool = xtext("%s/%s", bin, r->tool), *input = in_folder(r->input->name);
		struct bytes whole = contents(input);
		int lines;
		size_t printed;
		ok(feed(r, &whole, NULL, &lines, &printed) == 0 && !lines, "%s takes a whole input: %s", r->tool, r->input->name);
		ok(survives(r, &whole), "%s bears with a damaged one", r->tool);
		free(whole.p);
		free(tool);
		free(input);
	}
	free(build);
	free(bin);
	char *sweep = xtext("rm -r %s", folder);
	int left = system(sweep);
	free(sweep);
	return done_testing() || left;
}

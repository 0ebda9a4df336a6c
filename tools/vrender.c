/* vrender - render a scene: its media under its lights, by path tracing. */
#include "base/die.h"
#include "base/opt.h"
#include "base/out.h"
#include "format/tab.h"
#include "medium/host.h"
#include "medium/medium_file.h"
#include "medium/particle_grid.h"
#include "render/backend.h"
#include "render/image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define SAMPLES 64             /* unless asked for */
#define BATCH_SECONDS 0.2      /* between two looks at the clock: a display's watchdog and Ctrl-C wait no longer for a device */
#define FIRST_PATHS 16384      /* of the first batch */
#define FIRST_PARTS 16         /* of the film, at least, while nothing is known of some of it */
#define MOST_SAMPLES 1024      /* of a pixel at a time: more would not make more of the cache, but leave few pixels to a batch */

static double now(void)
{
	struct timespec t;
	clock_gettime(CLOCK_MONOTONIC, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void progress(double share, double seconds)
{
	fprintf(stderr, "\rvrender: %3.0f %%, %.0f s left ", 100 * share, seconds * (1 - share) / share);
	if (share >= 1)
		fprintf(stderr, "\r%40s\r", "");
}

/* Paths of the next batch, after one of so many. The parts of a film may differ a hundredfold: unless it was the whole of it, the
 * slowest so far, forgotten but slowly, says what a batch may take. */
static double next_batch(double paths, double seconds, int whole, double *slowest)
{
	double speed = paths / fmax(seconds, 1e-9);
	*slowest = whole ? speed : fmin(speed, 1.02 * *slowest);
	return fmin(2 * paths, BATCH_SECONDS * *slowest);
}

/* Samples [from, to), in batches of some samples of some pixels. A CPU takes all samples of a pixel while what it sees of the medium is
 * in the cache, a GPU as many pixels as there are; the C backend, which a signal ends at any time, all pixels where nobody looks. */
static void render(const struct setup *setup, struct film *film, struct cl *cl, uint32 from, uint32 to, int threads)
{
	const uint32 pixels = (uint32)(film->width * film->height);
	int visible = isatty(STDERR_FILENO), wide = cl && cl_wide(cl);
	double start = now(), shown = start, slowest = INFINITY, batch = FIRST_PATHS;
	for (uint32 sample = from, n; sample < to; sample += n) {
		n = (uint32)fmin(to - sample, !wide ? MOST_SAMPLES : sample == from ? 1 : fmax(1, batch / pixels));
		for (uint32 pixel = 0, part; pixel < pixels; pixel += part) {
			double before = now(), most = wide && sample == from ? fmin(batch, pixels / FIRST_PARTS) : batch / n;
			part = cl || visible ? (uint32)fmin(fmax(1, most), pixels - pixel) : pixels;
			if (cl)
				cl_render(cl, pixel, part, sample, n);
			else
				render_c(setup, film, pixel, part, sample, n, threads);
			double after = now();
			batch = next_batch((double)part * n, after - before, part == pixels, &slowest);
			int last = pixel + part == pixels && sample + n == to;
			if (visible && (last || after - shown >= BATCH_SECONDS)) {
				progress((sample - from + (double)n * (pixel + part) / pixels) / (to - from), after - start);
				shown = after;
			}
		}
	}
}

/* Particles are not there to be looked at from inside: a camera in one is likely to be misplaced. */
static void check_camera(const char *path, const struct scenefile *f, const double *origin, const struct medium *m)
{
	double at[3];
	size_t one = 0;
	for (int a = 0; a < 3; a++)
		at[a] = f->position[a] - origin[a];
	size_t n = particle_grid_around(m, at, &one);
	if (!n)
		return;
	const float *p = m->particle + 4 * one;
	int32_t class;
	memcpy(&class, p + 3, sizeof class);
	char *others = n > 1 ? xtext("%zu particles, one of them", n) : xtext("a particle");
	warn(path, "camera.position is inside %s of radius %g um at [%g, %g, %g], which is not seen as from inside", others, m->radius[class],
	     p[0] + origin[0], p[1] + origin[1], p[2] + origin[2]);
	free(others);
}

/* A medium's transport: of the command line, of the scene, or by its kind. */
static int transport_of(const struct scene_medium *m, const struct medium *medium, int asked, int verbose)
{
	int transport = asked >= 0 ? asked : m->transport;
	const char *why = asked >= 0 ? "as asked for" : "as the scene says";
	if (transport < 0) {
		transport = medium->kind == MEDIUM_PARTICLES ? TRANSPORT_EXPLICIT : medium_even(medium) ? TRANSPORT_CONTINUOUS : TRANSPORT_GRID;
		why = transport == TRANSPORT_EXPLICIT ? "the default for particles" : transport == TRANSPORT_GRID ?
		    "the default for a density that varies" : "the default for an even density";
	} else if ((transport == TRANSPORT_EXPLICIT || transport == TRANSPORT_FAT_RAY) && medium->kind != MEDIUM_PARTICLES) {
		die(m->file, "has no particles, which explicit and fat-ray need; bake it from particles, or render it as grid or continuous");
	}
	if (verbose)
		warn(m->file, "%s, %s: %zu particles, %d classes, %d wavelengths, mean optical depth %.4g along the shortest axis%s",
		     scene_transport[transport], why, medium->n_particles, medium->n_classes, medium->n_waves, medium_depth(medium),
		     medium->host ? ", and a host that absorbs" : "");
	return transport;
}

static void open_media(const struct scenefile *f, struct medium_file *baked, const struct medium **medium)
{
	for (int i = 0; i < f->n_media; i++) {
		medium_file_open(f->medium[i].file, &baked[i]);
		medium[i] = &baked[i].medium;
		if (medium[i]->n_waves != medium[0]->n_waves)
			die(f->medium[i].file, "has %d wavelengths, and %s %d: the media of a scene need the same", medium[i]->n_waves,
			    f->medium[0].file, medium[0]->n_waves);
		for (int w = 0; w < medium[0]->n_waves; w++)
			if (fabs(medium[i]->wavelength[w] - medium[0]->wavelength[w]) > 1e-9 * medium[0]->wavelength[w])
				die(f->medium[i].file, "has a wavelength of %.12g um where %s has %.12g: the media of a scene need the same",
				    medium[i]->wavelength[w], f->medium[0].file, medium[0]->wavelength[w]);
	}
}

/* The media's hosts that absorb are media, too: host[], of which those at n.. of the scene. Returns how many there are. */
static int add_hosts(const char *path, struct scenefile *f, const struct medium **medium, struct medium *host)
{
	int n = f->n_media;
	for (int i = 0; i < n; i++) {
		if (!medium[i]->host)
			continue;
		if (f->n_media == MAX_VOLUMES)
			die(path, "has more than %d media, counted with what absorbs between the particles of some", MAX_VOLUMES);
		host[f->n_media - n] = host_medium(medium[i]);
		medium[f->n_media] = &host[f->n_media - n];
		f->medium[f->n_media] = f->medium[i];
		f->medium[f->n_media++].file = xtext("%s", f->medium[i].file);
	}
	return f->n_media - n;
}

/* What the media are made of, and the scene. */
static char *history_of(const struct scenefile *f, const struct medium_file *baked)
{
	char *history = xtext("%s", "");
	for (int i = 0; i < f->n_media; i++) {
		char *content = xtext("medium crc %08x", baked[i].crc), *before = history;
		history = tab_join(before, baked[i].medium.history, content, NULL);
		free(content);
		free(before);
	}
	char *all = tab_join(history, f->history, NULL);
	free(history);
	return all;
}

int main(int argc, char **argv)
{
	const char *output = NULL, *part = NULL;
	long long samples = 0, from = 0, to = 0, seed = 1, threads = sysconf(_SC_NPROCESSORS_ONLN), device = -1;
	int transport = -1, attenuation = 0, backend = 0, list = 0, verbose = 0, spectral = 0;
	const struct opt opts[] = {
		{ "-o", OPT_FILE, &output, 0, 0, "FILE.exr", "the image", 1 },
		{ "--samples", OPT_INT, &samples, 1, IMAGE_SAMPLES, "N", "paths a pixel; default: 64", 1 },
		{ "--sample-range", OPT_TEXT, &part, 0, 0, "A:B", "render samples A to B - 1 only, for exr-merge", 1 },
		{ "--seed", OPT_INT, &seed, 0, 4294967295.0, "S", "of the random numbers", 0 },
		{ "--transport", OPT_CHOICE, &transport, 0, 0, "explicit|fat-ray|grid|continuous", "model of all media; default: as the scene says, else explicit for particles, grid for a density that varies", 0 },
		{ "--attenuation", OPT_CHOICE, &attenuation, 0, 0, "product|exponential", "of fat rays; exponential is biased", 0 },
		{ "--spectral", OPT_FLAG, &spectral, 0, 0, NULL, "add a layer for every wavelength", 0 },
		{ "--backend", OPT_CHOICE, &backend, 0, 0, "c|opencl", "what runs the kernels", 1 },
		{ "--device", OPT_INT, &device, 0, 63, "I", "OpenCL device; default: the first GPU, else the first", 1 },
		{ "--list-devices", OPT_FLAG, &list, 0, 0, NULL, "list the OpenCL devices and exit", 1 },
		{ "--threads", OPT_INT, &threads, 1, 1024, "N", "threads of the C backend", 1 },
		{ "--verbose", OPT_FLAG, &verbose, 0, 0, NULL, "say which model is used, and why", 1 },
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [SCENE] -o FILE.exr", "Render a scene.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (list) {
		struct out out = out_open(NULL, 0);
		cl_list(out.f);
		out_close(&out);
		return 0;
	}
	if (args.n > 1)
		die(args.operand[1], "one scene at most");
	if (!output)
		die("-o", "is needed");
	if (device >= 0 && !backend)
		die("--device", "goes with --backend opencl");
	const char *bad = part ? image_range(part, &from, &to) : NULL;
	if (bad)
		die("--sample-range", "'%s' %s", part, bad);
	if (part && samples && to > samples)
		die("--sample-range", "'%s' goes beyond --samples %lld", part, samples);
	if (!part)
		to = samples = samples ? samples : SAMPLES;
	struct scenefile file;
	struct medium_file baked[MAX_VOLUMES];
	const struct medium *medium[MAX_VOLUMES];
	struct medium host[MAX_VOLUMES];
	struct setup setup;
	struct film film;
	const char *path = args.n ? args.operand[0] : "-";
	struct render_options options = { .attenuation = attenuation, .spectral = spectral, .seed = (uint32)seed };
	int fat = 0;
	scenefile_read(path, &file);
	open_media(&file, baked, medium);
	for (int i = 0; i < file.n_media; i++) {
		options.transport[i] = transport_of(&file.medium[i], medium[i], transport, verbose);
		fat |= options.transport[i] == TRANSPORT_FAT_RAY;
		if (options.transport[i] == TRANSPORT_EXPLICIT || options.transport[i] == TRANSPORT_FAT_RAY)
			check_camera(path, &file, file.medium[i].position, medium[i]);
	}
	if (attenuation == ATTENUATION_EXPONENTIAL && !fat)
		die("--attenuation", "exponential goes with --transport fat-ray");
	if (spectral && medium[0]->n_waves > IMAGE_WAVES)
		die("--spectral", "the medium has %d wavelengths; an image has room for %d", medium[0]->n_waves, IMAGE_WAVES);
	char *history = history_of(&file, baked);
	int hosts = add_hosts(path, &file, medium, host);
	for (int i = 1; i <= hosts; i++)
		options.transport[file.n_media - i] = TRANSPORT_CONTINUOUS;
	setup_make(&setup, &file, medium, &options);
	film_make(&film, &setup.scene);

	struct out out = out_open(output, 1);    /* before the work, not after */
	struct cl *cl = backend ? cl_start(&setup, &film, (int)device, verbose) : NULL;
	render(&setup, &film, cl, (uint32)from, (uint32)to, (int)threads);
	if (cl)
		cl_read(cl, &film);
	if (!film_holds(&film))
		die(path, "the light is too strong: a pixel's samples sum to more than 2^32; scale the lights down");
	struct image image;
	image_of(&image, &setup.scene, &film, medium[0], from, to, samples, history, args.history);
	image_write(&out, &image, part != NULL);
	image_free(&image);
	free(history);
	if (cl)
		cl_free(cl);
	film_free(&film);
	setup_free(&setup);
	for (int i = 0; i < file.n_media - hosts; i++)
		medium_file_close(&baked[i]);
	for (int i = 0; i < hosts; i++)
		medium_free(&host[i]);
	scenefile_free(&file);
	free(args.history);
	return 0;
}

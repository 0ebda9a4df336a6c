/* The OpenCL build of the kernels: what a device holds, and its launches. */
#include "base/die.h"
#include "base/unit.h"
#include "render/backend.h"
#include "render/opencl.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHUNKS_MAX 8           /* buffers of a large table */
#define N_BUFFERS (1 + N_TABLES)    /* the scene is one */
#define CPU_PIXELS 256         /* of a work-item, or fewer, */
#define CPU_PATHS 16384        /* of about so many paths: lanes run dry only at its end, and none waits long for the last */
#define GPU_GROUP 64

struct cl {
	uint32 pixels;             /* of the image */
	size_t pixel_size;         /* of the film, bytes */
	cl_context context;
	cl_command_queue queue;
	cl_program program;
	cl_kernel kernel;
	cl_mem table[N_BUFFERS * CHUNKS_MAX];
	cl_uint n_buffers;         /* of the tables: the kernel's first arguments, followed by the film */
	cl_mem *film, overflow;
	uint32 n_films, film_pixels;      /* buffers, pixels of each */
	uint32 lanes;              /* 1 where a work-item has one pixel */
	int many;                  /* a work-item has many pixels */
	size_t group;              /* work-items of a work-group */
};

struct piece {
	const void *p;
	size_t n;                  /* elements of 4 bytes */
	int large;                 /* may be split over buffers */
};

/* One after the other of all volumes. */
struct table {
	struct piece piece[MAX_VOLUMES];
	size_t n;                  /* of all */
	int large;
};

/* How the device is used. CPUs run few work-items of many pixels, whose lanes are vectors of the kernel's own, for their drivers
 * do not make vectors of a path's loop; others run a pixel a work-item. */
static void shape(struct cl *c, cl_device_id device)
{
	cl_uint width = 1;
	size_t most = 1;
	c->many = cl_kind(device) == CL_DEVICE_TYPE_CPU;
	cl_ask(device, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT, &width, sizeof width);
	cl_ask(device, CL_DEVICE_MAX_WORK_GROUP_SIZE, &most, sizeof most);
	c->lanes = !c->many ? 1 : width >= 16 ? 16 : width >= 8 ? 8 : width >= 4 ? 4 : 1;
	c->group = c->many ? 1 : most < GPU_GROUP ? most : GPU_GROUP;
}

/* The largest buffer, bytes. */
static size_t buffer_limit(cl_device_id device)
{
	const char *text = getenv("MOTES_CL_BUFFER");
	cl_ulong most = 0;
	double asked;
	cl_ask(device, CL_DEVICE_MAX_MEM_ALLOC_SIZE, &most, sizeof most);
	if (text && *text) {
		const char *wrong = unit_bytes(text, &asked);
		if (wrong)
			die("MOTES_CL_BUFFER", "'%s' %s", text, wrong);
		most = asked < (double)most ? (cl_ulong)asked : most;
	}
	return (size_t)most;
}

/* As the kernel's arguments are; the scene is a copy of the setup's that says where each volume's tables begin. */
static void tables(const struct setup *u, struct scene *scene, struct table *out)
{
#define SMALL(type, name) { u->tables[k].name, u->size[k].name, 0 },
#define LARGE(type, name) { u->tables[k].name, u->size[k].name, 1 },
#define PLACE(type, name) &scene->volume[k].at.name,
	*scene = u->scene;
	memset(out, 0, N_BUFFERS * sizeof *out);
	out[0] = (struct table){ .piece = { { scene, sizeof *scene / 4, 0 } }, .n = sizeof *scene / 4 };
	for (int k = 0; k < scene->n_volumes; k++) {
		const struct piece own[N_TABLES] = { TABLES(SMALL, LARGE) };
		int *const at[N_TABLES] = { TABLES(PLACE, PLACE) };
		for (int i = 0; i < N_TABLES; i++) {
			struct table *t = &out[1 + i];
			if (own[i].n > INT_MAX - t->n)
				die("OpenCL", "the tables of all media together have more than %d elements", INT_MAX);
			t->piece[k] = own[i];
			t->large = own[i].large;
			*at[i] = (int)t->n;
			t->n += own[i].n;
		}
	}
}

/* The kernels are built for the number of buffers of large tables, as a rule 1. Of several each but the last holds 2^shift
 * elements: the bits of an index say which buffer and where in it, and no particle (4 elements) is divided. Returns the shift. */
static int divide(const struct table *table, size_t limit, int *chunks)
{
	size_t fixed = 0, large = 0;
	int shift = 2;
	for (int i = 0; i < N_BUFFERS; i++)
		if (table[i].large)
			large = table[i].n > large ? table[i].n : large;
		else
			fixed = table[i].n > fixed ? table[i].n : fixed;
	while ((size_t)8 << shift <= limit)
		shift++;
	*chunks = large <= limit / 4 ? 1 : CHUNKS_MAX;
	size_t most = *chunks == 1 ? limit / 4 : (size_t)1 << shift;
	if (fixed > most)
		die("OpenCL", "out of memory on the device: a buffer of %zu bytes is needed, %zu is the most", 4 * fixed, 4 * most);
	if (*chunks > 1 && large > (size_t)CHUNKS_MAX << shift)
		die("OpenCL", "out of memory on the device: a table of %zu bytes is more than %d buffers of %zu", 4 * large,
		    CHUNKS_MAX, (size_t)4 << shift);
	return shift;
}

/* A program for this scene alone is smaller and faster: constants that many a branch depends on are in its options. */
static char *options_for(const struct cl *c, const struct scene *s, cl_device_id device, int chunks, int shift)
{
	cl_device_fp_config rounding = 0;
	char waves[32] = "", parts[32] = "", model[64] = "";
	const struct volume *v = &s->volume[0];
	cl_ask(device, CL_DEVICE_SINGLE_FP_CONFIG, &rounding, sizeof rounding);
	if (!(rounding & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) || !(rounding & CL_FP_DENORM))
		warn("OpenCL", "the device rounds otherwise than the C backend; the last bits of the image may differ");
	if (s->n_waves == 1 || s->n_waves == 3)
		snprintf(waves, sizeof waves, " -DWAVES=%d", s->n_waves);
	if (chunks > 1)
		snprintf(parts, sizeof parts, " -DCHUNK_SHIFT=%d", shift);
	const char *exact = rounding & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT ? " -cl-fp32-correctly-rounded-divide-sqrt" : "";
	if (s->n_volumes == 1)
		snprintf(model, sizeof model, " -DTRANSPORT=%d -DCOUNTED=%d -DCLASSED=%d", v->transport, v->counted, v->classed);
	return xtext("-cl-std=CL1.2%s -DLANES=%d -DVOLUMES=%d%s%s -DPEAK=%d -DCHANNELS=%d -DSPECTRAL=%d -DHAS_GROUND=%d -DALL_ISOTROPIC=%d"
	             " -DCHUNKS=%d%s", exact, (int)c->lanes, s->n_volumes, model, waves, s->peak > 0, s->channels, s->spectral,
	             s->surfaces.has_ground, s->isotropic, chunks, parts);
}

static void set(struct cl *c, cl_uint arg, size_t size, const void *value)
{
	cl_check(clSetKernelArg(c->kernel, arg, size, value), "setting an argument");
}

/* A buffer of elements [from, to) of a table; an empty one still needs some. */
static cl_mem table_buffer(struct cl *c, const struct table *t, size_t from, size_t to)
{
	cl_int error;
	cl_mem m = clCreateBuffer(c->context, CL_MEM_READ_ONLY, to > from ? 4 * (to - from) : 16, NULL, &error);
	cl_check(error, "loading the scene");
	size_t begin = 0;
	for (int k = 0; k < MAX_VOLUMES; begin += t->piece[k++].n) {
		size_t low = begin > from ? begin : from, end = begin + t->piece[k].n, high = end < to ? end : to;
		if (low < high)
			cl_check(clEnqueueWriteBuffer(c->queue, m, CL_TRUE, 4 * (low - from), 4 * (high - low),
			                              (const char *)t->piece[k].p + 4 * (low - begin), 0, NULL, NULL), "loading the scene");
	}
	return m;
}

static void load_tables(struct cl *c, const struct table *table, int chunks, int shift)
{
	for (int i = 0; i < N_BUFFERS; i++) {
		size_t n = table[i].n, part = chunks > 1 && table[i].large ? (size_t)1 << shift : n;
		for (int k = 0; k < (table[i].large ? chunks : 1); k++) {
			size_t from = (size_t)k * part < n ? (size_t)k * part : n, own = n - from < part ? n - from : part;
			cl_mem m = table_buffer(c, &table[i], from, from + own);
			set(c, c->n_buffers, sizeof m, &m);
			c->table[c->n_buffers++] = m;
		}
	}
}

/* The part of a film that buffer i holds. */
static void *film_part(const struct cl *c, const struct film *f, uint32 i) { return (char *)f->sum + i * (c->film_pixels * c->pixel_size); }

/* Pixels of the film's buffer i. */
static uint32 pixels_of(const struct cl *c, uint32 i)
{
	uint32 left = c->pixels - i * c->film_pixels;
	return left < c->film_pixels ? left : c->film_pixels;
}

static cl_mem film_buffer(const struct cl *c, const void *p, size_t n)
{
	cl_int error;
	cl_mem m = clCreateBuffer(c->context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, n, (void *)(size_t)p, &error);
	cl_check(error, "loading the film");
	return m;
}

/* A film beyond one buffer is several; no launch writes into two. */
static void load_film(struct cl *c, const struct film *f, size_t limit)
{
	size_t most = limit / c->pixel_size;
	if (!most)
		die("OpenCL", "out of memory on the device: a pixel takes %zu bytes, a buffer %zu at most", c->pixel_size, limit);
	c->film_pixels = most < c->pixels ? (uint32)most : c->pixels;
	c->n_films = (c->pixels - 1) / c->film_pixels + 1;
	c->film = xalloc(c->n_films, sizeof *c->film);
	for (uint32 i = 0; i < c->n_films; i++)
		c->film[i] = film_buffer(c, film_part(c, f, i), pixels_of(c, i) * c->pixel_size);
	c->overflow = film_buffer(c, &f->overflow, sizeof f->overflow);
}

/* Samples [first, first + n) of the pixels [from, to), which lie in one buffer of the film. */
static void launch(struct cl *c, uint32 from, uint32 to, uint32 first, uint32 n)
{
	uint32 film = from / c->film_pixels, origin = film * c->film_pixels;
	uint32 chunk = !c->many ? 1 : n < CPU_PATHS / CPU_PIXELS ? CPU_PIXELS : CPU_PATHS / n + 1;
	const uint32 number[] = { origin, from, to, chunk, first, n };
	cl_uint arg = c->n_buffers;
	set(c, arg++, sizeof(cl_mem), &c->film[film]);
	set(c, arg++, sizeof(cl_mem), &c->overflow);
	for (size_t i = 0; i < sizeof number / sizeof *number; i++)
		set(c, arg++, sizeof *number, &number[i]);
	size_t groups = ((to - from + chunk - 1) / chunk + c->group - 1) / c->group, global = (groups ? groups : 1) * c->group;
	cl_check(clEnqueueNDRangeKernel(c->queue, c->kernel, 1, NULL, &global, &c->group, 0, NULL, NULL), "starting the kernel");
	cl_check(clFinish(c->queue), "running the kernel");
}

static void need_memory(const struct cl *c, const struct table *table, cl_device_id device)
{
	cl_ulong has = 0;
	double needs = (double)c->pixels * (double)c->pixel_size;
	for (int i = 0; i < N_BUFFERS; i++)
		needs += 4.0 * (double)table[i].n;
	cl_ask(device, CL_DEVICE_GLOBAL_MEM_SIZE, &has, sizeof has);
	if (needs > (double)has)     /* a driver may take the machine's memory until it has none */
		die("OpenCL", "out of memory on the device: the scene and its film need %.1f GiB, and it has %.1f GiB",
		    needs / 0x1p30, (double)has / 0x1p30);
}

struct cl *cl_start(const struct setup *u, const struct film *f, int number, int verbose)
{
	struct cl *c = xalloc(1, sizeof *c);
	cl_device_id device = cl_device(number, verbose);
	struct table table[N_BUFFERS];
	struct scene scene;
	size_t limit = buffer_limit(device), most = 1;
	int chunks, cached;
	cl_int error;
	c->pixels = (uint32)f->width * (uint32)f->height;
	c->pixel_size = (size_t)f->n_sums * sizeof *f->sum;
	shape(c, device);
	tables(u, &scene, table);
	need_memory(c, table, device);
	int shift = divide(table, limit, &chunks);
	char *options = options_for(c, &u->scene, device, chunks, shift);
	c->context = clCreateContext(NULL, 1, &device, NULL, NULL, &error);
	cl_check(error, "creating a context");
	c->queue = clCreateCommandQueue(c->context, device, 0, &error);
	cl_check(error, "creating a queue");
	c->program = cl_build(c->context, device, options, &cached);
	c->kernel = clCreateKernel(c->program, "render", &error);
	cl_check(error, "creating the kernel");
	clGetKernelWorkGroupInfo(c->kernel, device, CL_KERNEL_WORK_GROUP_SIZE, sizeof most, &most, NULL);
	c->group = c->group < most ? c->group : most;
	load_tables(c, table, chunks, shift);
	load_film(c, f, limit);
	launch(c, 0, 0, 0, 0);     /* of nothing: some drivers compile only now, which no clock shall see */
	if (!cached)
		cl_keep(c->program, device, options);
	free(options);
	return c;
}

int cl_wide(const struct cl *c) { return !c->many; }

void cl_render(struct cl *c, uint32 pixel, uint32 pixels, uint32 first, uint32 n)
{
	for (uint32 from = pixel, to; from < pixel + pixels; from = to) {
		uint32 film = from / c->film_pixels, end = film * c->film_pixels + pixels_of(c, film);
		to = end < pixel + pixels ? end : pixel + pixels;
		launch(c, from, to, first, n);
	}
}

void cl_read(const struct cl *c, struct film *f)
{
	for (uint32 i = 0; i < c->n_films; i++)
		cl_check(clEnqueueReadBuffer(c->queue, c->film[i], CL_TRUE, 0, pixels_of(c, i) * c->pixel_size, film_part(c, f, i), 0, NULL, NULL),
		         "reading the film");
	cl_check(clEnqueueReadBuffer(c->queue, c->overflow, CL_TRUE, 0, sizeof f->overflow, &f->overflow, 0, NULL, NULL), "reading the film");
}

void cl_free(struct cl *c)
{
	for (uint32 i = 0; i < c->n_films; i++)
		clReleaseMemObject(c->film[i]);
	clReleaseMemObject(c->overflow);
	for (cl_uint i = 0; i < c->n_buffers; i++)
		clReleaseMemObject(c->table[i]);
	clReleaseKernel(c->kernel);
	clReleaseProgram(c->program);
	clReleaseCommandQueue(c->queue);
	clReleaseContext(c->context);
	free(c->film);
	free(c);
}

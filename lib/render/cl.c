/* The OpenCL build of the kernels. */
#include "base/die.h"
#include "render/job.h"
#include "render/kernels.h"

#include <CL/cl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define DEVICES_MAX 64
#define N_BUFFERS 16       /* the scene and the tables */

struct cl {
	struct job *job;
	cl_context context;
	cl_command_queue queue;
	cl_program program;
	cl_kernel kernel;
	cl_mem buffer[N_BUFFERS], film, overflow;
	size_t local;
};

static void check(cl_int error, const char *what)
{
	if (error == CL_MEM_OBJECT_ALLOCATION_FAILURE || error == CL_OUT_OF_RESOURCES || error == CL_OUT_OF_HOST_MEMORY
	    || error == CL_INVALID_BUFFER_SIZE)
		die("OpenCL", "%s: out of memory on the device", what);
	if (error)
		die("OpenCL", "%s failed (error %d)", what, error);
}

/* PoCL aborts the process where it cannot read the machine's memory from /sys, as in a plain chroot: tell it there. */
static void describe_machine(void)
{
	char text[96];
	if (!access("/sys/devices/system/cpu", F_OK))
		return;
	snprintf(text, sizeof text, "numa:1(memory=%lld) pu:%ld", (long long)sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGESIZE),
	         sysconf(_SC_NPROCESSORS_ONLN));
	setenv("HWLOC_SYNTHETIC", text, 0);
}

/* All devices of all platforms, in the order that the loader gives. */
static cl_uint devices(cl_device_id *out)
{
	describe_machine();
	cl_platform_id platform[16];
	cl_uint n_platforms = 0, n = 0;
	cl_int error = clGetPlatformIDs(16, platform, &n_platforms);
	if (error || !n_platforms)
		die("OpenCL", "no platform found (is an OpenCL driver such as pocl-opencl-icd installed?)");
	for (cl_uint i = 0; i < n_platforms && i < 16; i++) {
		cl_uint found = 0;
		if (!clGetDeviceIDs(platform[i], CL_DEVICE_TYPE_ALL, DEVICES_MAX - n, out + n, &found))
			n += found < DEVICES_MAX - n ? found : DEVICES_MAX - n;
	}
	if (!n)
		die("OpenCL", "no device found");
	return n;
}

void cl_list(FILE *out)
{
	cl_device_id device[DEVICES_MAX];
	char name[256];
	cl_uint n = devices(device);
	for (cl_uint i = 0; i < n; i++) {
		check(clGetDeviceInfo(device[i], CL_DEVICE_NAME, sizeof name, name, NULL), "asking for a device's name");
		fprintf(out, "%u\t%s\n", i, name);
	}
}

/* A buffer of a table; an empty one still needs a byte. */
static cl_mem load(struct cl *c, const void *p, size_t size)
{
	static const char nothing[16];
	cl_int error;
	cl_mem m = clCreateBuffer(c->context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, size ? size : sizeof nothing,
	                          (void *)(size_t)(size ? p : nothing), &error);
	check(error, "loading the scene");
	return m;
}

static void build(struct cl *c, cl_device_id device)
{
	cl_int error;
	cl_device_fp_config rounding = 0;
	const char *source = kernels_source;
	c->program = clCreateProgramWithSource(c->context, 1, &source, NULL, &error);
	check(error, "reading the kernels");
	clGetDeviceInfo(device, CL_DEVICE_SINGLE_FP_CONFIG, sizeof rounding, &rounding, NULL);
	if (!(rounding & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) || !(rounding & CL_FP_DENORM))
		warn("OpenCL", "the device rounds otherwise than the C backend; the last bits of the image may differ");
	const char *options = rounding & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT ? "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt"
	    : "-cl-std=CL1.2";
	error = clBuildProgram(c->program, 1, &device, options, NULL, NULL);
	if (error) {
		size_t size = 0;
		clGetProgramBuildInfo(c->program, device, CL_PROGRAM_BUILD_LOG, 0, NULL, &size);
		char *log = xalloc(size + 1, 1);
		clGetProgramBuildInfo(c->program, device, CL_PROGRAM_BUILD_LOG, size, log, NULL);
		for (char *line = log; *line; line++)
			if (*line == '\n')
				*line = ';';
		die("OpenCL", "the kernels do not build (error %d): %.900s", error, log);
	}
	c->kernel = clCreateKernel(c->program, "render", &error);
	check(error, "creating the kernel");
}

struct cl *cl_start(struct job *j, int device)
{
	struct cl *c = xalloc(1, sizeof *c);
	cl_device_id all[DEVICES_MAX];
	cl_uint n = devices(all);
	cl_int error;
	if (device < 0 || (cl_uint)device >= n)
		die("--device", "%d is none of the %u devices (see --list-devices)", device, n);
	c->job = j;
	c->context = clCreateContext(NULL, 1, &all[device], NULL, NULL, &error);
	check(error, "creating a context");
	c->queue = clCreateCommandQueue(c->context, all[device], 0, &error);
	check(error, "creating a queue");
	build(c, all[device]);
	const struct tables *t = &j->tables;
	const struct { const void *p; size_t size; } table[N_BUFFERS] = {
		{ &j->scene, sizeof j->scene }, { t->extinction, j->n_extinction * 4 }, { t->disc, j->n_disc * 4 },
		{ t->albedo, j->n_albedo * 4 }, { t->colour, j->n_colour * 4 }, { t->phase, j->n_phase * 4 }, { t->interval, j->n_interval * 4 },
		{ t->alias, j->n_alias * 4 }, { t->angle, j->n_angle * 4 }, { t->particle, j->n_particle * 4 }, { t->first, j->n_first * 4 },
		{ t->brick, j->n_brick * 4 }, { t->voxel, j->n_voxel * 4 }, { t->count, j->n_count * 4 },
		{ t->map, j->n_map * 4 }, { t->map_cdf, j->n_map_cdf * 4 },
	};
	cl_uint arg = 0;
	for (; arg < N_BUFFERS; arg++) {
		c->buffer[arg] = load(c, table[arg].p, table[arg].size);
		check(clSetKernelArg(c->kernel, arg, sizeof(cl_mem), &c->buffer[arg]), "setting an argument");
	}
	size_t size = (size_t)j->scene.width * (size_t)j->scene.height * (size_t)j->scene.film_sums * sizeof *j->film;
	c->film = clCreateBuffer(c->context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, size, j->film, &error);
	check(error, "creating the film");
	c->overflow = clCreateBuffer(c->context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, sizeof(cl_int), &j->overflow, &error);
	check(error, "creating the film");
	cl_uint pixels = (cl_uint)(j->scene.width * j->scene.height);
	check(clSetKernelArg(c->kernel, arg++, sizeof(cl_mem), &c->film), "setting an argument");
	check(clSetKernelArg(c->kernel, arg++, sizeof(cl_mem), &c->overflow), "setting an argument");
	check(clSetKernelArg(c->kernel, arg, sizeof pixels, &pixels), "setting an argument");
	size_t most = 1;
	clGetKernelWorkGroupInfo(c->kernel, all[device], CL_KERNEL_WORK_GROUP_SIZE, sizeof most, &most, NULL);
	c->local = most < 64 ? most : 64;
	return c;
}

void cl_render(struct cl *c, uint32 first, uint32 n)
{
	size_t pixels = (size_t)c->job->scene.width * (size_t)c->job->scene.height;
	size_t global = (pixels + c->local - 1) / c->local * c->local;
	check(clSetKernelArg(c->kernel, N_BUFFERS + 3, sizeof first, &first), "setting an argument");
	check(clSetKernelArg(c->kernel, N_BUFFERS + 4, sizeof n, &n), "setting an argument");
	check(clEnqueueNDRangeKernel(c->queue, c->kernel, 1, NULL, &global, &c->local, 0, NULL, NULL), "starting the kernel");
	check(clFinish(c->queue), "running the kernel");
}

void cl_finish(struct cl *c)
{
	struct job *j = c->job;
	size_t size = (size_t)j->scene.width * (size_t)j->scene.height * (size_t)j->scene.film_sums * sizeof *j->film;
	check(clEnqueueReadBuffer(c->queue, c->film, CL_TRUE, 0, size, j->film, 0, NULL, NULL), "reading the film");
	check(clEnqueueReadBuffer(c->queue, c->overflow, CL_TRUE, 0, sizeof(cl_int), &j->overflow, 0, NULL, NULL), "reading the film");
	for (int i = 0; i < N_BUFFERS; i++)
		clReleaseMemObject(c->buffer[i]);
	clReleaseMemObject(c->film);
	clReleaseMemObject(c->overflow);
	clReleaseKernel(c->kernel);
	clReleaseProgram(c->program);
	clReleaseCommandQueue(c->queue);
	clReleaseContext(c->context);
	free(c);
}

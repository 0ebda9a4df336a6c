/* The OpenCL devices: which there are, and which is meant. */
#include "base/die.h"
#include "render/backend.h"
#include "render/opencl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PLATFORMS_MAX 16
#define DEVICES_MAX 64

void cl_check(cl_int error, const char *what)
{
	if (error == CL_MEM_OBJECT_ALLOCATION_FAILURE || error == CL_OUT_OF_HOST_MEMORY || error == CL_INVALID_BUFFER_SIZE)
		die("OpenCL", "%s: out of memory on the device", what);
	if (error == CL_OUT_OF_RESOURCES)     /* memory for many a driver, too, or whatever else ends a launch */
		die("OpenCL", "%s: out of memory or other resources on the device", what);
	if (error)
		die("OpenCL", "%s failed (error %d)", what, error);
}

void cl_ask(cl_device_id device, cl_device_info what, void *value, size_t size)
{
	cl_check(clGetDeviceInfo(device, what, size, value, NULL), "asking for a device's properties");
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
	cl_platform_id platform[PLATFORMS_MAX];
	cl_uint n_platforms = 0, n = 0;
	cl_int error = clGetPlatformIDs(PLATFORMS_MAX, platform, &n_platforms);
	if (error || !n_platforms)
		die("OpenCL", "no platform found (is an OpenCL driver such as pocl-opencl-icd installed?)");
	for (cl_uint i = 0; i < n_platforms && i < PLATFORMS_MAX && n < DEVICES_MAX; i++) {
		cl_uint found = 0;
		if (!clGetDeviceIDs(platform[i], CL_DEVICE_TYPE_ALL, DEVICES_MAX - n, out + n, &found))
			n += found < DEVICES_MAX - n ? found : DEVICES_MAX - n;
	}
	if (!n)
		die("OpenCL", "no device found");
	return n;
}

cl_device_type cl_kind(cl_device_id device)
{
	static const cl_device_type kind[] = { CL_DEVICE_TYPE_GPU, CL_DEVICE_TYPE_ACCELERATOR };
	cl_device_type all = 0;
	cl_ask(device, CL_DEVICE_TYPE, &all, sizeof all);
	for (size_t i = 0; i < sizeof kind / sizeof *kind; i++)
		if (all & kind[i])
			return kind[i];
	return CL_DEVICE_TYPE_CPU;
}

/* As a field of a line: vendors pad their names. */
static char *tidy(char *text)
{
	size_t n = 0;
	for (char *c = text; *c; c++)
		if ((unsigned char)*c > ' ')
			text[n++] = *c;
		else if (n && text[n - 1] != ' ')
			text[n++] = ' ';
	n -= n && text[n - 1] == ' ';
	text[n] = 0;
	return text;
}

char *cl_device_text(cl_device_id device, cl_device_info what)
{
	size_t size = 0;
	cl_check(clGetDeviceInfo(device, what, 0, NULL, &size), "asking for a device's name");
	char *text = xalloc(size + 1, 1);
	cl_check(clGetDeviceInfo(device, what, size, text, NULL), "asking for a device's name");
	return tidy(text);
}

char *cl_platform_text(cl_device_id device, cl_platform_info what)
{
	size_t size = 0;
	cl_platform_id platform;
	cl_ask(device, CL_DEVICE_PLATFORM, &platform, sizeof platform);
	cl_check(clGetPlatformInfo(platform, what, 0, NULL, &size), "asking for a platform's name");
	char *text = xalloc(size + 1, 1);
	cl_check(clGetPlatformInfo(platform, what, size, text, NULL), "asking for a platform's name");
	return tidy(text);
}

/* As the list has it, less its number. */
static char *line_of(cl_device_id device, const char *separator)
{
	char *name = cl_device_text(device, CL_DEVICE_NAME), *platform = cl_platform_text(device, CL_PLATFORM_NAME);
	cl_device_type kind = cl_kind(device);
	cl_ulong memory = 0;
	cl_ask(device, CL_DEVICE_GLOBAL_MEM_SIZE, &memory, sizeof memory);
	const char *word = kind == CL_DEVICE_TYPE_GPU ? "GPU" : kind == CL_DEVICE_TYPE_CPU ? "CPU" : "accelerator";
	char *line = xtext("%s%s%s%s%s%s%.1f GiB", name, separator, word, separator, platform, separator,
	                   (double)memory / 0x1p30);
	free(name);
	free(platform);
	return line;
}

void cl_list(FILE *out)
{
	cl_device_id device[DEVICES_MAX];
	cl_uint n = devices(device);
	for (cl_uint i = 0; i < n; i++) {
		char *line = line_of(device[i], "\t");
		fprintf(out, "%u\t%s\n", i, line);
		free(line);
	}
}

cl_device_id cl_device(int number, int verbose)
{
	cl_device_id all[DEVICES_MAX];
	cl_uint n = devices(all);
	if (number >= (int)n)
		die("--device", "%d is none of the %u devices (see --list-devices)", number, n);
	for (cl_uint i = 0; number < 0 && i < n; i++)
		if (cl_kind(all[i]) == CL_DEVICE_TYPE_GPU)
			number = (int)i;
	number = number < 0 ? 0 : number;
	if (verbose) {
		char *line = line_of(all[number], ", ");
		warn("OpenCL", "device %d: %s", number, line);
		free(line);
	}
	return all[number];
}

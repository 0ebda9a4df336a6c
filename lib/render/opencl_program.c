/* The kernels built for a device, and the cache that saves building them again.
 *
 * A file of the cache is a head, a key, a program's binary, and the CRC-32 of all before it. The key is all that the binary
 * depends on, the source included, and is compared in full; the file's name is but a hash of it. What is damaged, cut short,
 * another user's or of another key is as good as not there.
 *
 * PoCL 3.1 compiles a kernel at its first launch, for the size of the work-groups and for few or many of them; its binary is the
 * folder of its own cache, with all that was compiled so far. Taken right after the build, it holds intermediate code and a
 * function for any size, which a launch of a known size does not use: that is compiled again, all but as slowly as from source.
 * Taken after a launch, it holds the machine code of that, and the next start is immediate. */
#include "base/die.h"
#include "base/out.h"
#include "render/kernels_text.h"
#include "render/opencl.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

struct head {
	char magic[24];
	uint64_t key, binary;      /* bytes of each */
};

static const char magic[24] = "motes OpenCL program 1\n";

/* Not in it: variables in the environment that tell a driver to compile otherwise, which are for those who debug it. */
static char *key_of(cl_device_id device, const char *options)
{
	char *name = cl_device_text(device, CL_DEVICE_NAME), *vendor = cl_device_text(device, CL_DEVICE_VENDOR);
	char *driver = cl_device_text(device, CL_DRIVER_VERSION), *version = cl_device_text(device, CL_DEVICE_VERSION);
	char *platform = cl_platform_text(device, CL_PLATFORM_NAME), *release = cl_platform_text(device, CL_PLATFORM_VERSION);
	char *key = xtext("%s\n%s\n%s\n%s\n%s\n%s\n%s\n%s", platform, release, vendor, name, version, driver, options,
	                  kernels_source);
	free(name);
	free(vendor);
	free(driver);
	free(version);
	free(platform);
	free(release);
	return key;
}

/* FNV-1a, 64 bits. */
static uint64_t hash(const char *text)
{
	uint64_t h = 0xcbf29ce484222325u;
	for (; *text; text++)
		h = (h ^ (unsigned char)*text) * 0x100000001b3u;
	return h;
}

/* The folder of the cache, by the XDG Base Directory Specification; NULL where the user has none. */
static char *cache_folder(void)
{
	const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
	if (cache && *cache == '/')
		return xtext("%s/motes", cache);
	return home && *home == '/' ? xtext("%s/.cache/motes", home) : NULL;
}

/* Where in it the program of a key is. */
static char *cache_path(const char *key)
{
	char *folder = cache_folder(), *path = folder ? xtext("%s/%016llx.cl", folder, (unsigned long long)hash(key)) : NULL;
	free(folder);
	return path;
}

/* Whether files can be put in there; makes what is missing of the path. */
static int cache_open(void)
{
	char *folder = cache_folder();
	for (char *c = folder ? strchr(folder + 1, '/') : NULL; c; c = strchr(c + 1, '/')) {
		*c = 0;
		mkdir(folder, 0700);
		*c = '/';
	}
	int open = folder && (!mkdir(folder, 0700) || errno == EEXIST) && !access(folder, W_OK | X_OK);
	free(folder);
	return open;
}

/* All of a file that is the user's own; NULL where there is none. */
static unsigned char *slurp(const char *path, size_t *size)
{
	struct stat st;
	int fd = open(path, O_RDONLY | O_CLOEXEC);
	unsigned char *all = NULL;
	if (fd >= 0 && !fstat(fd, &st) && S_ISREG(st.st_mode) && st.st_uid == geteuid() && st.st_size <= INT32_MAX) {
		all = xalloc((size_t)st.st_size, 1);
		*size = 0;
		for (ssize_t n = 1; n > 0 && *size < (size_t)st.st_size; *size += n > 0 ? (size_t)n : 0)
			n = read(fd, all + *size, (size_t)st.st_size - *size);
	}
	if (fd >= 0)
		close(fd);
	return all;
}

/* The binary in the bytes of a file, if it is whole and of this key. */
static const unsigned char *binary_in(const unsigned char *all, size_t size, const char *key, size_t *length)
{
	struct head head;
	uint32_t crc;
	if (size < sizeof head + sizeof crc)
		return NULL;
	memcpy(&head, all, sizeof head);
	memcpy(&crc, all + size - sizeof crc, sizeof crc);
	size -= sizeof head + sizeof crc;
	if (memcmp(head.magic, magic, sizeof magic) || head.key != strlen(key) || head.key > size
	    || head.binary != size - head.key || memcmp(all + sizeof head, key, head.key) || crc32_z(0, all, sizeof head + size) != crc)
		return NULL;
	*length = head.binary;
	return all + sizeof head + head.key;
}

/* The compilers' own chatter does not belong on standard error: PoCL's writes there how many errors it found. */
static cl_int build_quietly(cl_program program, cl_device_id device, const char *options)
{
	int aside = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3), nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
	if (aside >= 0 && nothing >= 0)
		dup2(nothing, STDERR_FILENO);
	cl_int error = clBuildProgram(program, 1, &device, options, NULL, NULL);
	if (aside >= 0 && nothing >= 0)
		dup2(aside, STDERR_FILENO);
	close(aside);
	close(nothing);
	return error;
}

static cl_program from_cache(cl_context context, cl_device_id device, const char *options)
{
	char *key = key_of(device, options), *path = cache_path(key);
	size_t size, length;
	unsigned char *all = path ? slurp(path, &size) : NULL;
	const unsigned char *binary = all ? binary_in(all, size, key, &length) : NULL;
	cl_program program = NULL;
	cl_int status, error;
	if (binary) {
		program = clCreateProgramWithBinary(context, 1, &device, &length, &binary, &status, &error);
		if (program && (error || status || build_quietly(program, device, options))) {
			clReleaseProgram(program);
			program = NULL;
		}
	}
	free(all);
	free(path);
	free(key);
	return program;
}

static unsigned char *binary_of(cl_program program, size_t *size)
{
	*size = 0;
	if (clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof *size, size, NULL) || !*size)
		return NULL;
	unsigned char *binary = xalloc(*size, 1);
	if (!clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof binary, &binary, NULL))
		return binary;
	free(binary);
	return NULL;
}

static uLong put(struct out *out, uLong crc, const void *p, size_t size)
{
	fwrite(p, 1, size, out->f);     /* errors are for out_finish */
	return crc32_z(crc, p, size);
}

void cl_keep(cl_program program, cl_device_id device, const char *options)
{
	size_t size;
	unsigned char *binary = cache_open() ? binary_of(program, &size) : NULL;     /* which takes PoCL seconds */
	if (!binary)
		return;
	char *key = key_of(device, options), *path = cache_path(key);
	struct out out = out_beside(path);
	if (out.f) {
		struct head head = { .key = strlen(key), .binary = size };
		memcpy(head.magic, magic, sizeof magic);
		uint32_t crc = (uint32_t)put(&out, put(&out, put(&out, 0, &head, sizeof head), key, head.key), binary, size);
		put(&out, 0, &crc, sizeof crc);
	}
	out_finish(&out);
	free(path);
	free(key);
	free(binary);
}

/* The log's first line about an error, or its first line. */
static void complain(cl_program program, cl_device_id device, cl_int error)
{
	size_t size = 0;
	clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, 0, NULL, &size);
	char *log = xalloc(size + 1, 1);
	clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, size, log, NULL);
	char *line = strstr(log, "error");
	while (line && line > log && line[-1] != '\n')
		line--;
	line = line ? line : log + strspn(log, " \n");
	line[strcspn(line, "\n")] = 0;
	die("OpenCL", "the kernels do not build (error %d)%s%.300s", error, *line ? ": " : "", line);
}

cl_program cl_build(cl_context context, cl_device_id device, const char *options, int *cached)
{
	cl_program program = from_cache(context, device, options);
	cl_int error;
	*cached = program != NULL;
	if (program)
		return program;
	const char *source = kernels_source;
	program = clCreateProgramWithSource(context, 1, &source, NULL, &error);
	cl_check(error, "reading the kernels");
	error = build_quietly(program, device, options);
	if (error)
		complain(program, device, error);
	return program;
}

/* opencl - what the parts of the OpenCL backend share. */
#ifndef RENDER_OPENCL_H
#define RENDER_OPENCL_H

#include <CL/cl.h>

/* cl_check - dies unless error is 0, in a line that says what failed. */
void cl_check(cl_int error, const char *what);

/* cl_ask - one of a device's properties of known size. */
void cl_ask(cl_device_id device, cl_device_info what, void *value, size_t size);

/* cl_device - a device by its number in the list; -1: the first GPU, or without one the first device. Dies where there is none.
 * verbose: warn which it is. */
cl_device_id cl_device(int number, int verbose);

/* Which of the three kinds a device is: a bit of CL_DEVICE_TYPE_*. */
cl_device_type cl_kind(cl_device_id device);

/* A device's text and its platform's, as xtext. */
char *cl_device_text(cl_device_id device, cl_device_info what);
char *cl_platform_text(cl_device_id device, cl_platform_info what);

/* cl_build - the kernels' program for a device: from the user's cache where it is there, else from source. Dies where they do not
 * build. *cached: which it was. */
cl_program cl_build(cl_context context, cl_device_id device, const char *options, int *cached);

/* cl_keep - put a program built from source into the cache, for the next time; quietly does nothing where that cannot be. To be
 * called after its first launch: PoCL compiles a kernel when it is launched, and its binary holds what was compiled by then. */
void cl_keep(cl_program program, cl_device_id device, const char *options);

#endif

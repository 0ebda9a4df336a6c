/* wide - eight doubles side by side; the compiler makes of them what the processor has. Nothing is contracted: the bits are the
 * same everywhere. */
#ifndef OPTICS_KERN_WIDE_H
#define OPTICS_KERN_WIDE_H

#include <string.h>

typedef double wide __attribute__((vector_size(64)));

static inline wide wide_load(const double *p)
{
	wide v;
	memcpy(&v, p, sizeof v);
	return v;
}

static inline void wide_store(double *p, wide v) { memcpy(p, &v, sizeof v); }
static inline wide wide_of(double a) { return a - (wide){ 0 }; }
static inline wide wide_pair(double a, double b) { return (wide){ a, a, a, a, b, b, b, b }; }

#endif

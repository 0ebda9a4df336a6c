/* chunk - tables that may be larger than one buffer of a device: with CHUNKS > 1 a table is that many buffers of 2^CHUNK_SHIFT
 * elements (the last one used has the rest). Otherwise, and always in C, it is a plain pointer. */
#ifndef KERN_CHUNK_H
#define KERN_CHUNK_H

#include "render/kern/compat.h"

#ifndef CHUNKS
#define CHUNKS 1
#endif

/* FLOATS, INTS - the type of a table. float_at, int_at - one element. */
#if CHUNKS == 1
#define FLOATS GLOBAL const float *
#define INTS GLOBAL const int *
FN float float_at(FLOATS t, int i) { return t[i]; }
FN int int_at(INTS t, int i) { return t[i]; }
#else
#define FLOATS struct floats
#define INTS struct ints
struct floats { GLOBAL const float *part[CHUNKS]; int from; };    /* from: of its first element */
struct ints { GLOBAL const int *part[CHUNKS]; int from; };

/* Selects rather than an indexed load: pointers stay in registers. */
#define CHUNK_AT(type, table, i) \
	GLOBAL const type *at = (table).part[0]; \
	for (int k = 1; k < CHUNKS; k++) \
		at = (i) >> CHUNK_SHIFT == k ? (table).part[k] : at; \
	return at[(i) & ((1 << CHUNK_SHIFT) - 1)]
FN float float_at(FLOATS t, int i) { CHUNK_AT(float, t, i + t.from); }
FN int int_at(INTS t, int i) { CHUNK_AT(int, t, i + t.from); }
#endif

/* The kernel's arguments for a table that may be large, and the table made of them, from one of its elements on; one that is not has a
 * buffer alone. */
#if CHUNKS == 1
#define CHUNK_ARGS(type, name) __global const type *name
#define CHUNK_TABLE(name, from) (name) + (from)
#define WHOLE_TABLE(name, from) (name) + (from)
#elif CHUNKS == 8
#define CHUNK_ARGS(type, name) __global const type *name##0, __global const type *name##1, __global const type *name##2, \
	__global const type *name##3, __global const type *name##4, __global const type *name##5, __global const type *name##6, \
	__global const type *name##7
#define CHUNK_TABLE(name, from) { { name##0, name##1, name##2, name##3, name##4, name##5, name##6, name##7 }, from }
#define WHOLE_TABLE(name, from) { { name }, from }
#endif

#endif

/* chunk - tables that may be larger than one buffer of a device: with CHUNKS > 1 a table is that many buffers of 2^CHUNK_SHIFT
 * elements (the last one used has the rest), CHUNK_SHIFT being 2 at least. Otherwise, and always in C, it is a plain pointer. */
#ifndef KERN_CHUNK_H
#define KERN_CHUNK_H

#include "render/kern/compat.h"

#ifndef CHUNKS
#define CHUNKS 1
#endif

/* FLOATS, UINTS - the type of a table. floats_at, uints_at - where element i is; those that follow stand beside it as far as the
 * next multiple of 4. */
#if CHUNKS == 1
#define FLOATS GLOBAL const float *
#define UINTS GLOBAL const uint32 *
FN GLOBAL const float *floats_at(FLOATS t, int64 i) { return t + i; }
FN GLOBAL const uint32 *uints_at(UINTS t, int64 i) { return t + i; }
#else
#define FLOATS struct floats
#define UINTS struct uints
struct floats { GLOBAL const float *part[CHUNKS]; };
struct uints { GLOBAL const uint32 *part[CHUNKS]; };

/* Selects rather than an indexed load: pointers stay in registers. */
#define CHUNK_AT(type, table, i) \
	GLOBAL const type *at = (table).part[0]; \
	for (int k = 1; k < CHUNKS; k++) \
		at = (int)((i) >> CHUNK_SHIFT) == k ? (table).part[k] : at; \
	return at + ((i) & (((int64)1 << CHUNK_SHIFT) - 1))
FN GLOBAL const float *floats_at(FLOATS t, int64 i) { CHUNK_AT(float, t, i); }
FN GLOBAL const uint32 *uints_at(UINTS t, int64 i) { CHUNK_AT(uint32, t, i); }
#endif

/* The kernel's arguments for a table, and the table made of them. */
#if CHUNKS == 1
#define CHUNK_ARGS(type, name) __global const type *name
#define CHUNK_TABLE(name) name
#elif CHUNKS == 8
#define CHUNK_ARGS(type, name) __global const type *name##0, __global const type *name##1, __global const type *name##2, \
	__global const type *name##3, __global const type *name##4, __global const type *name##5, __global const type *name##6, \
	__global const type *name##7
#define CHUNK_TABLE(name) { { name##0, name##1, name##2, name##3, name##4, name##5, name##6, name##7 } }
#endif

#endif

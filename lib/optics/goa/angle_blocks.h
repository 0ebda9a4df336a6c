/* angle_blocks - the angles that rays are found for, in blocks of GOA_WIDTH; a block has its rays in packets, one after the other. */
#ifndef OPTICS_ANGLE_BLOCKS_H
#define OPTICS_ANGLE_BLOCKS_H

#include "optics/goa/rays.h"

#include <stddef.h>

struct angle_blocks {
	int n;                       /* angles */
	double *theta;               /* [n], degrees */
	size_t *first;               /* first packet of each block, and behind the last one how many there are; to be filled */
};

#define angle_blocks_count(n) (((n) + GOA_WIDTH - 1) / GOA_WIDTH)

/* angle_blocks_new - for theta[n] (copied). Returns 0, or -1 when memory ran out; angle_blocks_free does in either case. */
int angle_blocks_new(int n, const double *theta, struct angle_blocks *out);
void angle_blocks_free(struct angle_blocks *b);

/* angle_blocks_are - whether these are the angles theta[n], n > 0. */
int angle_blocks_are(const struct angle_blocks *b, int n, const double *theta);

/* angle_blocks_room - have room for `more' packets of a size behind the used: *packets, of *room, grows. 0, or -1 when memory ran out. */
int angle_blocks_room(void *packets, size_t *room, size_t used, size_t more, size_t size);

#endif

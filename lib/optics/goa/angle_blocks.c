#include "optics/goa/angle_blocks.h"

#include <stdlib.h>
#include <string.h>

int angle_blocks_new(int n, const double *theta, struct angle_blocks *out)
{
	out->n = n;
	out->theta = malloc((size_t)(n ? n : 1) * sizeof *out->theta);
	out->first = malloc(((size_t)angle_blocks_count(n) + 1) * sizeof *out->first);
	if (!out->theta || !out->first)
		return -1;
	memcpy(out->theta, theta, (size_t)n * sizeof *theta);
	return 0;
}

void angle_blocks_free(struct angle_blocks *b)
{
	free(b->theta);
	free(b->first);
}

int angle_blocks_are(const struct angle_blocks *b, int n, const double *theta)
{
	return n && n == b->n && !memcmp(theta, b->theta, (size_t)n * sizeof *theta);
}

int angle_blocks_room(void *packets, size_t *room, size_t used, size_t more, size_t size)
{
	void **at = packets;
	if (used + more <= *room)
		return 0;
	*room = 2 * *room + more;
	void *grown = realloc(*at, *room * size);
	if (!grown)
		return -1;
	*at = grown;
	return 0;
}

#include "medium/medium_layout.h"

#include <string.h>

#define LAYOUT(name, type, n) { #name, offsetof(struct medium, name), sizeof(type) },
const struct medium_layout medium_layout[N_SECTIONS] = { MEDIUM_SECTIONS(LAYOUT) };

void medium_layout_counts(const struct medium *m, uint64_t *n)
{
	const uint64_t waves = (uint64_t)m->n_waves, classes = (uint64_t)m->n_classes;
#define COUNT(name, type, count) count,
	const uint64_t counts[N_SECTIONS] = { MEDIUM_SECTIONS(COUNT) };
	memcpy(n, counts, sizeof counts);
}

/* Efficiencies of many spheres: blocks of about as many terms each, side by side in the lanes of this processor. */
#include "optics/mie/mie_lanes.h"

#include <stdlib.h>

/* A sphere's place in the caller's order, and what it costs; kind: those of one kind can share a block. */
enum { ABSORBS = 1, NEAR = 2 };
struct item {
	int at, terms, kind;
};

/* By kind, then by terms, then as given. */
static int by_cost(const void *a, const void *b)
{
	const struct item *p = a, *q = b;
	if (p->kind != q->kind)
		return p->kind - q->kind;
	return p->terms != q->terms ? (p->terms > q->terms ? 1 : -1) : p->at - q->at;
}

static int together(const struct mie_lanes *lanes, const struct item *item, int n, const double *x, const double complex *m, struct efficiencies *q,
                    double *error)
{
	struct mie_block b = { .absorbs = item->kind & ABSORBS, .near = item->kind & NEAR };
	b.room = aligned_alloc(64, mie_block_room(item[n - 1].terms) * sizeof *b.room);
	if (!b.room)
		return 1;
	for (int i = 0; i < MIE_BLOCK; i++) {    /* the last one again where there are fewer */
		const struct item *own = &item[i < n ? i : n - 1];
		b.x[i] = x[own->at];
		b.m_re[i] = creal(m[own->at]);
		b.m_im[i] = cimag(m[own->at]);
		b.terms[i] = own->terms;
	}
	lanes->block(&b);
	for (int i = 0; i < n; i++) {
		int at = item[i].at;
		q[at] = mie_sums_efficiencies(x[at], !b.absorbs, &b.sums[i]);
		error[at] = mie_sums_error(x[at], !b.absorbs, &b.sums[i]);
	}
	free(b.room);
	return 0;
}

int mie_many(int n, const double *x, const double complex *m, struct efficiencies *q, double *error)
{
	const struct mie_lanes *lanes = mie_lanes();
	if (n == 1)
		return mie_one(lanes, *x, *m, mie_terms(*x, *m), q, error);
	struct item *item = malloc(((size_t)n + 1) * sizeof *item);
	if (!item)
		return -1;
	int sorted = 1, bad = 0;
	for (int i = 0; i < n; i++) {
		item[i] = (struct item){ i, mie_terms(x[i], m[i]), (cimag(m[i]) > 0 ? ABSORBS : 0) | (mie_near(m[i]) ? NEAR : 0) };
		sorted &= i == 0 || by_cost(&item[i - 1], &item[i]) < 0;
	}
	if (!sorted)
		qsort(item, (size_t)n, sizeof *item, by_cost);
	int blocks = (n + MIE_BLOCK - 1) / MIE_BLOCK;
#pragma omp parallel for schedule(dynamic) reduction(| : bad) if (n > MIE_BLOCK)
	for (int k = 0; k < blocks; k++) {
		int first = k * MIE_BLOCK, end = n - first < MIE_BLOCK ? n : first + MIE_BLOCK, last = end;
		while (first < end) {      /* each kind by itself, those of many terms alone */
			last = first;
			while (last < end && item[last].kind == item[first].kind && item[last].terms <= MIE_BLOCK_TERMS)
				last++;
			if (last - first > MIE_BLOCK / 8) {
				bad |= together(lanes, item + first, last - first, x, m, q, error);
				first = last;
			} else {
				int at = item[first].at;
				bad |= mie_one(lanes, x[at], m[at], item[first].terms, &q[at], &error[at]);
				first++;
			}
		}
	}
	free(item);
	return bad ? -1 : 0;
}

/* One build of the loop over a block of spheres: compiled for each processor, with MIE_BLOCK_FN the name, and LANES. */
#include "optics/mie_lanes.h"

#define UNROLL 4
#include "optics/mie_solve.h"

/* Orders [from, to] of all spheres. */
INLINE void orders(struct climb *k, struct solved *q, vec old[2][UNROLL][2], const struct spheres *s,
                                                         const struct ratios *e, int from, int to, int outside)
{
	for (int l = from; l <= to; l++) {
		climb_to(k, s, e, l, outside);
		EACH(u) {
			vec a[2], b[2];
			climb_waves(k, s, e, l, u, outside, a, b);
			solved_add(q, s, l, u, a, b, old[0][u], old[1][u]);
			for (int c = 0; c < 2; c++) {
				old[0][u][c] = a[c];
				old[1][u][c] = b[c];
			}
		}
	}
}

INLINE void sums(struct mie_block *b, int first, int absorb, int near)
{
	struct spheres s = { .most = 0, .absorb = absorb, .near = near };
	struct solved q;
	vec old[2][UNROLL][2];
	for (int i = 0; i < WIDTH; i++) {
		LANE(s.x, i) = b->x[first + i];
		LANE(s.m_re, i) = b->m_re[first + i];
		LANE(s.m_im, i) = absorb ? b->m_im[first + i] : 0;
		LANE(s.terms, i) = b->terms[first + i];
		s.most = b->terms[first + i] > s.most ? b->terms[first + i] : s.most;
	}
	EACH(u) {
		q.ext[u] = q.sca[u] = q.asym[u] = q.back_re[u] = q.back_im[u] = each(0);
		for (int c = 0; c < 2; c++)
			old[0][u][c] = old[1][u][c] = each(0);
	}
	struct ratios e = ratios_of(&s, (vec *)b->ratios);
	struct climb k = climb_start(&s);
	int inside = e.outside - 1 < s.most ? e.outside - 1 : s.most;
	orders(&k, &q, old, &s, &e, 1, inside, 0);
	orders(&k, &q, old, &s, &e, inside + 1, s.most, 1);
	for (int i = 0; i < WIDTH; i++)
		b->sums[first + i] = (struct mie_sums){ LANE(q.ext, i), LANE(q.sca, i), LANE(q.asym, i), LANE(q.back_re, i), LANE(q.back_im, i) };
}

void MIE_BLOCK_FN(struct mie_block *b)
{
	for (int first = 0; first < MIE_BLOCK; first += WIDTH)
		if (b->near)
			sums(b, first, b->absorbs, 1);
		else if (b->absorbs)
			sums(b, first, 1, 0);
		else
			sums(b, first, 0, 0);
}

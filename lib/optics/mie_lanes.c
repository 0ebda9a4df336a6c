/* One build of the loops of Lorenz-Mie theory: compiled for each processor, with BUILD the name of what comes out, and LANES. */
#include "optics/mie_lanes.h"

#define UNROLL 4
#include "optics/mie_solve.h"

#include <string.h>

/* ------------------------------------------------------------------ many spheres */

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

static void block(struct mie_block *b)
{
	for (int first = 0; first < MIE_BLOCK; first += WIDTH)
		if (b->near)
			sums(b, first, b->absorbs, 1);
		else if (b->absorbs)
			sums(b, first, 1, 0);
		else
			sums(b, first, 0, 0);
}

/* ------------------------------------------------------------------ many angles */

/* pi_l is carried with the difference v_l = pi_l - pi_{l-1} (after Wiscombe 1979, with mu = 1 - c put in), so that c counts with all its
 * digits: v_{l+1} = ((l+1) v_l - (2l+1) c pi_l)/l, (pi_l + tau_l)/l = (l+1)/l v_l - c pi_l. Of unroll vectors of angles, sums from k[l][0]
 * on, and twice as many from there if both. */
INLINE void waves(int both, int unroll, int n, const struct mie_factors *restrict k, int side, const double *c_, double (*out)[MIE_ANGLES])
{
	vec c[UNROLL], p[UNROLL], v[UNROLL], sum[UNROLL][8];
	for (int u = 0; u < unroll; u++) {
		p[u] = v[u] = each(1);
		for (int i = 0; i < (both ? 8 : 4); i++)
			sum[u][i] = each(0);
	}
	for (int i = 0; i < unroll * LANES; i++)
		LANE(c, i) = c_[i];
	for (int l = 1; l <= n; l++) {
		const double rise = k[l].rise, twice = k[l].twice, *f = k[l].side[side];
#pragma GCC unroll 4
		for (int u = 0; u < unroll; u++) {
			vec cp = c[u] * p[u], plus = rise * v[u] - cp, minus = twice * p[u] - plus;
			sum[u][0] += f[0] * plus;
			sum[u][1] += f[1] * plus;
			sum[u][2] += f[2] * minus;
			sum[u][3] += f[3] * minus;
			if (both) {
				sum[u][4] += f[4] * plus;
				sum[u][5] += f[5] * plus;
				sum[u][6] += f[6] * minus;
				sum[u][7] += f[7] * minus;
			}
			v[u] = plus - rise * cp;
			p[u] += v[u];
		}
	}
	for (int u = 0; u < unroll; u++)
		for (int j = 0; j < (both ? 8 : 4); j++)
			memcpy(&out[j][u * LANES], &sum[u][j], sizeof(vec));
}

static void angles(int n, const struct mie_factors *k, int sides, const double *c, double (*out)[MIE_ANGLES])
{
	double part[8][MIE_ANGLES];
	int both = sides == MIE_PAIR, width = LANES * (both ? UNROLL / 2 : UNROLL);
	for (int first = 0; first < MIE_ANGLES; first += width) {
		if (both)
			waves(1, UNROLL / 2, n, k, 0, c + first, part);
		else
			waves(0, UNROLL, n, k, sides == MIE_BEHIND, c + first, part);
		for (int j = 0; j < (both ? 8 : 4); j++)
			memcpy(out[j] + first, part[j], (size_t)width * sizeof(double));
	}
}

const struct mie_lanes BUILD = { block, angles };

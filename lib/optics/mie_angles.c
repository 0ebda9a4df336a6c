/* One build of the sums over partial waves at many angles: compiled for each processor, with MIE_ANGLES_FN the name, and LANES. */
#include "optics/mie_lanes.h"

#define UNROLL 4
#include "optics/vec.h"

#include <string.h>

/* pi_l is carried with the difference v_l = pi_l - pi_{l-1} (after Wiscombe 1979, with mu = 1 - c put in), so that c counts with all its
 * digits: v_{l+1} = ((l+1) v_l - (2l+1) c pi_l)/l, (pi_l + tau_l)/l = (l+1)/l v_l - c pi_l. Of unroll vectors of angles, sums from k[l][0]
 * on, and twice as many from there if both. */
INLINE void sums(int both, int unroll, int n, const struct mie_factors *restrict k, int side, const double *c_, double (*out)[MIE_ANGLES])
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

void MIE_ANGLES_FN(int n, const struct mie_factors *k, int sides, const double *c, double (*out)[MIE_ANGLES])
{
	double part[8][MIE_ANGLES];
	int both = sides == MIE_PAIR, width = LANES * (both ? UNROLL / 2 : UNROLL);
	for (int first = 0; first < MIE_ANGLES; first += width) {
		if (both)
			sums(1, UNROLL / 2, n, k, 0, c + first, part);
		else
			sums(0, UNROLL, n, k, sides == MIE_BEHIND, c + first, part);
		for (int j = 0; j < (both ? 8 : 4); j++)
			memcpy(out[j] + first, part[j], (size_t)width * sizeof(double));
	}
}

/* voxels - extinction on a grid, tracked exactly: constant in cubes that count particles, trilinear between the nodes of a density,
 * where it is a cubic along the ray within a cell. */
#ifndef KERN_VOXELS_H
#define KERN_VOXELS_H

#include "render/kern/ray.h"

/* What a ray passes: in cubes the optical depth of each wavelength, in a density its integral (in depth[0]), up to where the
 * hero's own reaches target. */
struct passed {
	float depth[MAX_WAVES];
	float t;                   /* from the ray's entry, where the target was reached */
	int reached;
	int voxel;                 /* in which cube */
	struct vec entry;
};

FN int clamp_index(int i, int n) { return i < 0 ? 0 : i > n - 1 ? n - 1 : i; }

/* Density at the place (x, y, z) of the cell of nodes p, fractions in [0, 1]. */
FN float trilinear(const float *p, float x, float y, float z)
{
	float a = p[0] + (p[1] - p[0]) * x, b = p[2] + (p[3] - p[2]) * x, c = p[4] + (p[5] - p[4]) * x, d = p[6] + (p[7] - p[6]) * x;
	float e = a + (b - a) * y, f = c + (d - c) * y;
	return e + (f - e) * z;
}

/* One cell of a density over the length [0, span] of the ray, which passes from fractions f of the cell to f + df:
 * the integral is added to sum; where it passes target, returns the place, else -1. */
FN float pass_cell(const struct scene *s, const struct tables *tab, const int *i, const float *f, const float *df, float span,
                   float target, float *sum)
{
	float p[8];
	for (int k = 0; k < 8; k++) {
		int x = clamp_index(i[0] - 1 + (k & 1), s->voxels[0]), y = clamp_index(i[1] - 1 + (k >> 1 & 1), s->voxels[1]);
		int z = clamp_index(i[2] - 1 + (k >> 2), s->voxels[2]);
		p[k] = tab->voxel[(z * s->voxels[1] + y) * s->voxels[0] + x];
	}
	/* four values fix the cubic, which is not negative */
	float v[4];
	for (int k = 0; k < 4; k++) {
		float u = (float)k * 0.333333333f, g[3];
		for (int a = 0; a < 3; a++)
			g[a] = least(1.f, most(0.f, f[a] + df[a] * u));
		v[k] = trilinear(p, g[0], g[1], g[2]);
	}
	float whole = span * 0.125f * (v[0] + 3.f * (v[1] + v[2]) + v[3]);
	if (!(*sum + whole >= target)) {
		*sum += whole;
		return -1.f;
	}
	float share = least(1.f, (target - *sum) / whole);
	float q1 = -5.5f * v[0] + 9.f * v[1] - 4.5f * v[2] + v[3], q2 = 9.f * v[0] - 22.5f * v[1] + 18.f * v[2] - 4.5f * v[3];
	float q3 = -4.5f * v[0] + 13.5f * v[1] - 13.5f * v[2] + 4.5f * v[3];
	*sum = target;
	return span * invert_density(v[0], q1, q2, q3, 0.f, share);
}

/* Walk from cell to cell (3D-DDA) up to t_end or the target. */
FN void pass_voxels(const struct scene *s, const struct tables *tab, struct ray r, float t_end, struct waves w, int hero,
                    float target, struct passed *g)
{
	float t0, t1, t = 0.f;
	clip_medium(s, r, &t0, &t1);
	t1 = least(t1, t_end) - t0;
	g->entry = add(r.from, scale(r.along, t0));
	g->reached = 0;
	g->voxel = 0;
	g->t = 0.f;
	for (int j = 0; j < w.n; j++)
		g->depth[j] = 0.f;
	if (!(t1 > 0.f))
		return;
	const float at[3] = { g->entry.x, g->entry.y, g->entry.z };
	const float inv[3] = { inverse(r.along.x), inverse(r.along.y), inverse(r.along.z) }, d[3] = { r.along.x, r.along.y, r.along.z };
	float low[3], leave[3];
	int i[3], n[3], wall[3];
	for (int a = 0; a < 3; a++) {
		/* between nodes, cells are offset by half a voxel */
		low[a] = s->voxel_low[a] - (s->counted ? 0.f : 0.5f * s->voxel[a]);
		n[a] = s->voxels[a] + (s->counted ? 0 : 1);
		i[a] = (int)most(0.f, least((at[a] - low[a]) / s->voxel[a], (float)(n[a] - 1)));
		wall[a] = i[a] + (inv[a] > 0.f);
		leave[a] = (low[a] + (float)wall[a] * s->voxel[a] - at[a]) * inv[a];
	}
	while (t < t1) {
		int axis = leave[0] < leave[1] ? (leave[0] < leave[2] ? 0 : 2) : (leave[1] < leave[2] ? 1 : 2);
		float span = most(0.f, least(leave[axis], t1) - t);
		if (s->counted) {
			int voxel = (i[2] * n[1] + i[1]) * n[0] + i[0];
			GLOBAL const float *sigma = tab->voxel + (long)voxel * s->n_waves;
			float own = g->depth[hero], here = sigma[wave_of(w, hero)];
			if (own + here * span >= target && here > 0.f) {
				span = least(span, (target - own) / here);
				g->reached = 1;
				g->voxel = voxel;
				g->t = t + span;
			}
			for (int j = 0; j < w.n; j++)
				g->depth[j] += sigma[wave_of(w, j)] * span;
		} else {
			float f[3], df[3];
			for (int a = 0; a < 3; a++) {
				f[a] = (at[a] + d[a] * t - low[a]) / s->voxel[a] - (float)i[a];
				df[a] = d[a] * span / s->voxel[a];
			}
			float place = pass_cell(s, tab, i, f, df, span, target, &g->depth[0]);
			if (place >= 0.f) {
				g->reached = 1;
				g->t = t + place;
			}
		}
		if (g->reached)
			return;
		t = most(t, leave[axis]);
		int step = inv[axis] > 0.f ? 1 : -1;
		i[axis] += step;
		if (i[axis] < 0 || i[axis] >= n[axis])
			return;
		wall[axis] += step;
		leave[axis] = (low[axis] + (float)wall[axis] * s->voxel[axis] - at[axis]) * inv[axis];
	}
}

#endif

/* voxels - extinction on a grid, tracked exactly: constant in cubes that count particles, trilinear between the nodes of a density,
 * where it is a cubic along the ray within a cell.
 *
 * Cells lie in bricks of BRICK^3, each one piece of memory; a brick with nothing in it has none and is passed in one step. A brick of
 * cubes holds [z][y][x][wave]. A brick of a density holds the corners of its cells as faces across z, so that a cell is read by two
 * loads of four floats: [z of 5][y of 4][x of 5][y, y + 1]. lib/render/bricks.c makes them. */
#ifndef KERN_VOXELS_H
#define KERN_VOXELS_H

#include "render/kern/random.h"
#include "render/kern/ray.h"

#define BRICK 4
#define BRICK_CELLS (BRICK * BRICK * BRICK)
#define FACE_ROW (2 * (BRICK + 1))
#define FACE (BRICK * FACE_ROW)
#define BRICK_CORNERS ((BRICK + 1) * FACE)

/* Beyond this optical depth a shadow ray goes on by chance: what gets through is then never less than e^-4, so nothing grows
 * noisy, and a thick medium is not crossed in vain. */
#define SHADOW_DEPTH 4.f

struct passage {
	mv going, reached;         /* still under way; came to the target */
	mv flight;                 /* the target is in the hero's optical depth, else in the least of all */
	fv depth[CARRIED];         /* passed: in cubes the optical depth of each wavelength, in a density its integral, in depth[0] */
	fv target;
	struct vec entry, along, inverse;
	fv t0;                     /* entry, along the ray */
	fv t, t1;                  /* from entry: of the cell that it is in, where it enters; where it leaves the medium */
	fv span;                   /* of the cell that has the target */
	iv cell[3];
};

FN void passage_begin(const struct scene *s, struct passage *g, mv m, struct ray r, fv t_end, int flight, fv target)
{
	fv t0, t1;
	clip_medium(s, r, &t0, &t1);
	t1 = least(t1, t_end) - t0;
	struct vec entry = add(r.from, scale(r.along, t0));
	const fv at[3] = { entry.x, entry.y, entry.z };
	set3(m, &g->entry, entry);
	set3(m, &g->along, r.along);
	set3(m, &g->inverse, r.inverse);
	for (int a = 0; a < 3; a++) {
		fv place = (at[a] - s->voxel_low[a]) * s->voxels_per_m[a];
		SET(m, g->cell[a], to_int(most(FV(0.f), least(place, FV((float)(s->voxels[a] - 1))))));
	}
	SET(m, g->t0, t0);
	SET(m, g->t, FV(0.f));
	SET(m, g->span, FV(0.f));
	SET(m, g->t1, t1);
	SET(m, g->target, target);
	EACH_WAVE(j)
		SET(m, g->depth[j], FV(0.f));
	SET_TRUTH(m, g->flight, lanes_if(flight));
	SET_TRUTH(m, g->reached, NO_LANE);
	SET_TRUTH(m, g->going, lt(FV(0.f), t1));
}

/* The eight corners of a cell, [z][x][y]. */
FN void corners(const struct tables *t, mv m, iv brick, const iv *cell, fv *p)
{
	const int in = BRICK - 1;
	iv at = brick * BRICK_CORNERS + (cell[2] & in) * FACE + (cell[1] & in) * FACE_ROW + (cell[0] & in) * 2;
	gather4(m, t->voxel, at, p);
	gather4(m, t->voxel, at + FACE, p + 4);
}

/* Density at the fractions x, y, z of a cell. */
FN fv trilinear(const fv *p, fv x, fv y, fv z)
{
	fv a = p[0] + (p[2] - p[0]) * x, b = p[1] + (p[3] - p[1]) * x, c = p[4] + (p[6] - p[4]) * x, d = p[5] + (p[7] - p[5]) * x;
	fv e = a + (b - a) * y, f = c + (d - c) * y;
	return e + (f - e) * z;
}

/* Density at t, in the cell of these corners. */
FN fv density_along(const struct scene *s, const struct passage *g, const fv *p, fv t)
{
	fv x = (g->entry.x + g->along.x * t - s->voxel_low[0]) * s->voxels_per_m[0] - to_float(g->cell[0]);
	fv y = (g->entry.y + g->along.y * t - s->voxel_low[1]) * s->voxels_per_m[1] - to_float(g->cell[1]);
	fv z = (g->entry.z + g->along.z * t - s->voxel_low[2]) * s->voxels_per_m[2] - to_float(g->cell[2]);
	return trilinear(p, x, y, z);
}

FN iv brick_of(const struct scene *s, const struct tables *t, mv m, const iv *cell)
{
	return igather(m, t->brick, ((cell[2] / BRICK) * s->bricks[1] + cell[1] / BRICK) * s->bricks[0] + cell[0] / BRICK);
}

/* One cell, or one empty brick, of all lanes under way (3D-DDA). */
FN void passage_on(const struct scene *s, const struct tables *t, struct passage *g, struct waves w, iv hero)
{
	mv m = g->going, up[3];
	iv brick = brick_of(s, t, m, g->cell), wall[3];
	mv empty = ilt(brick, IV(0)), full = m & NOT(empty);
	const fv at[3] = { g->entry.x, g->entry.y, g->entry.z }, d[3] = { g->along.x, g->along.y, g->along.z };
	const fv inverse[3] = { g->inverse.x, g->inverse.y, g->inverse.z };
	fv leave[3];
	for (int a = 0; a < 3; a++) {
		up[a] = lt(FV(0.f), inverse[a]);
		iv low = SEL(empty, g->cell[a] & ~(BRICK - 1), g->cell[a]);
		wall[a] = low + SEL(up[a], SEL(empty, IV(BRICK), IV(1)), IV(0));
		leave[a] = (s->voxel_low[a] + to_float(wall[a]) * s->voxel[a] - at[a]) * inverse[a];
	}
	fv out = least(leave[0], least(leave[1], leave[2])), span = most(FV(0.f), least(out, g->t1) - g->t);
	if (s->counted) {
		fv here[CARRIED], own = FV(FAR), own_here = FV(FAR);
		iv at_cell = (brick * BRICK_CELLS + ((g->cell[2] & 3) * BRICK + (g->cell[1] & 3)) * BRICK + (g->cell[0] & 3)) * s->n_waves;
		EACH_WAVE(j) {
			here[j] = gather(full, t->voxel, at_cell + wave_of(s, w, j));
			mv mine = (g->flight & ieq(hero, IV(j))) | (NOT(g->flight) & lt(g->depth[j] + here[j] * span, own + own_here));
			own = SEL(mine, g->depth[j], own);
			own_here = SEL(mine, here[j] * span, own_here);
		}
		mv hit = full & le(g->target, own + own_here) & lt(FV(0.f), own_here);
		span = SEL(hit, least(span, (g->target - own) * span / own_here), span);
		EACH_WAVE(j)
			SET(full, g->depth[j], g->depth[j] + here[j] * span);
		SET(hit, g->t, g->t + span);
		g->reached |= hit;
		g->going &= NOT(hit);
	} else {
		fv p[8];
		corners(t, full, brick, g->cell, p);
		/* the cubic, by Gauss's two nodes exactly */
		fv v0 = density_along(s, g, p, g->t + span * 0.211324865f), v1 = density_along(s, g, p, g->t + span * 0.788675135f);
		fv sum = g->depth[0] + span * (0.5f * (v0 + v1));
		mv hit = full & le(g->target, sum);
		SET(hit, g->span, span);
		SET(full & NOT(hit), g->depth[0], sum);
		g->reached |= hit;
		g->going &= NOT(hit);
	}
	/* into the next cell */
	m = g->going;
	SET(m, g->t, most(g->t, out));
	for (int a = 0; a < 3; a++) {
		mv across = le(leave[a], out);
		iv low = g->cell[a] & ~(BRICK - 1), next = wall[a] - SEL(up[a], IV(0), IV(1));
		fv place = (at[a] + d[a] * g->t - s->voxel_low[a]) * s->voxels_per_m[a];
		iv inside = imost(low, ileast(low + (BRICK - 1), to_int(place)));
		SET(m & across, g->cell[a], next);
		SET(m & empty & NOT(across), g->cell[a], inside);
		g->going &= NOT(ilt(g->cell[a], IV(0))) & ilt(g->cell[a], IV(s->voxels[a]));
	}
	g->going &= lt(g->t, g->t1);
}

/* Where lanes that reached the target are, from entry; depth[0] of a density is then the target. */
FN fv passage_end(const struct scene *s, const struct tables *t, struct passage *g, mv m)
{
	m &= g->reached;
	if (s->counted || !any(m))
		return g->t;
	fv p[8], v[4], span = g->span;
	corners(t, m, brick_of(s, t, m, g->cell), g->cell, p);
	for (int k = 0; k < 4; k++)    /* four values fix the cubic, which is not negative */
		v[k] = most(FV(0.f), density_along(s, g, p, g->t + span * ((float)k * 0.333333333f)));
	fv whole = span * 0.125f * (v[0] + 3.f * (v[1] + v[2]) + v[3]);
	fv q[5] = { v[0], -5.5f * v[0] + 9.f * v[1] - 4.5f * v[2] + v[3], 9.f * v[0] - 22.5f * v[1] + 18.f * v[2] - 4.5f * v[3],
		-4.5f * v[0] + 13.5f * v[1] - 13.5f * v[2] + 4.5f * v[3], FV(0.f) };
	fv share = SEL(lt(FV(0.f), whole), least(FV(1.f), (g->target - g->depth[0]) / whole), FV(0.f));
	SET(m, g->t, g->t + span * invert_density(q, share, 4));
	SET(m, g->depth[0], g->target);
	return g->t;
}

#endif

/* voxels - extinction on a grid, tracked exactly: constant in cubes that count particles, trilinear between the nodes of a density,
 * where it is a cubic along the ray within a cell.
 *
 * Cells lie in bricks of BRICK^3, each one piece of memory. A brick with nothing in it has none, but says how many bricks away, in
 * any direction, the nearest that is not empty lies: a ray passes all the empty ones around it in one step. The outermost are empty,
 * so that a ray that rounding puts a cell too far is still among bricks. A brick of cubes holds [z][y][x][wave]. A brick of a density
 * holds the corners of its cells as faces across z, so that a cell is read by two loads of four floats: [z of 5][y of 4][x of 5]
 * [y, y + 1]. lib/render/bricks.c makes them. */
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
	struct vec entry, along;
	fv t0;                     /* entry, along the ray */
	fv t, t1;                  /* from entry: of the cell that it is in, where it enters; where it leaves the medium */
	fv span;                   /* of the cell that has the target */
	/* in cells, from the low end: entry, direction and its inverse, 1 where it goes up; the cell */
	fv at[3], d[3], inverse[3], up[3], cell[3];
};

FN void passage_begin(const struct scene *s, struct passage *g, mv m, struct ray r, fv t_end, mv flight, fv target)
{
	fv t0, t1;
	clip_medium(s, r, &t0, &t1);
	t1 = fv_min(t1, t_end) - t0;
	struct vec entry = add(r.from, scale(r.along, t0));
	const fv at[3] = { entry.x, entry.y, entry.z }, d[3] = { r.along.x, r.along.y, r.along.z };
	const fv inverse[3] = { r.inverse.x, r.inverse.y, r.inverse.z };
	set3(m, &g->entry, entry);
	set3(m, &g->along, r.along);
	EACH(a, 3) {
		fv place = (at[a] - s->voxel_low[a]) * s->voxels_per_m[a];
		SET(m, g->at[a], place);
		SET(m, g->d[a], d[a] * s->voxels_per_m[a]);
		SET(m, g->inverse[a], inverse[a] * s->voxel[a]);
		SET(m, g->up[a], SEL(lt(FV(0.f), inverse[a]), FV(1.f), FV(0.f)));
		SET(m, g->cell[a], fv_trunc(fv_min(fv_max(place, FV((float)BRICK)), FV((float)(BRICK + s->voxels[a] - 1)))));
	}
	SET(m, g->t0, t0);
	SET(m, g->t, FV(0.f));
	SET(m, g->span, FV(0.f));
	SET(m, g->t1, t1);
	SET(m, g->target, target);
	EACH_WAVE(j)
		SET(m, g->depth[j], FV(0.f));
	SET_TRUTH(m, g->flight, flight);
	SET_TRUTH(m, g->reached, NO_LANE);
	SET_TRUTH(m, g->going, lt(FV(0.f), t1));
}

/* The cell as integers. */
FN void indices(const struct passage *g, iv *i)
{
	EACH(a, 3)
		i[a] = to_int(g->cell[a]);
}

FN iv brick_of(const struct scene *s, const struct tables *t, mv m, const iv *i)
{
	return igather(m, t->brick, ((i[2] >> 2) * s->bricks[1] + (i[1] >> 2)) * s->bricks[0] + (i[0] >> 2));
}

/* The eight corners of a cell, [z][x][y]. */
FN void corners(const struct tables *t, mv m, iv brick, const iv *i, fv *p)
{
	const int in = BRICK - 1;
	iv at = brick * BRICK_CORNERS + (i[2] & in) * FACE + (i[1] & in) * FACE_ROW + (i[0] & in) * 2;
	gather4(m, t->voxel, at, 0, p);
	gather4(m, t->voxel, at, FACE, p + 4);
}

/* Density at t, in the cell of these corners. */
FN fv density_along(const struct passage *g, const fv *p, fv t)
{
	fv x = g->at[0] + g->d[0] * t - g->cell[0], y = g->at[1] + g->d[1] * t - g->cell[1], z = g->at[2] + g->d[2] * t - g->cell[2];
	fv a = p[0] + (p[2] - p[0]) * x, b = p[1] + (p[3] - p[1]) * x, c = p[4] + (p[6] - p[4]) * x, d = p[5] + (p[7] - p[5]) * x;
	fv e = a + (b - a) * y, f = c + (d - c) * y;
	return e + (f - e) * z;
}

/* One cell, or empty bricks at once, of all lanes under way (3D-DDA). */
FN void passage_on(const struct scene *s, const struct tables *t, struct passage *g, struct waves w, iv hero)
{
	mv m = g->going;
	iv i[3];
	indices(g, i);
	iv brick = brick_of(s, t, m, i);
	mv empty = m & ilt(brick, IV(0)), full = m & NOT(empty);
	/* what is passed now: cells from low on, one or many along each axis */
	fv low[3] = { g->cell[0], g->cell[1], g->cell[2] }, many = FV(1.f), wall[3], leave[3];
	if (any(empty)) {
		many = SEL(empty, to_float((-2 * BRICK) * brick - BRICK), many);
		EACH(a, 3)
			low[a] = SEL(empty, to_float((i[a] & ~(BRICK - 1)) + (brick + 1) * BRICK), low[a]);
	}
	EACH(a, 3) {
		wall[a] = low[a] + g->up[a] * many;
		leave[a] = (wall[a] - g->at[a]) * g->inverse[a];
	}
	fv out = fv_min(leave[0], fv_min(leave[1], leave[2])), span = fv_max(FV(0.f), fv_min(out, g->t1) - g->t);
	if (COUNTED) {
		fv here[CARRIED], own = FV(FAR), own_here = FV(FAR);
		iv at = (brick * BRICK_CELLS + ((i[2] & 3) * BRICK + (i[1] & 3)) * BRICK + (i[0] & 3)) * s->n_waves;
		EACH_WAVE(j) {
			here[j] = gather(full, t->voxel, at + wave_of(s, w, j));
			mv mine = (g->flight & ieq(hero, IV(j))) | (NOT(g->flight) & lt(g->depth[j] + here[j] * span, own + own_here));
			own = SEL(mine, g->depth[j], own);
			own_here = SEL(mine, here[j] * span, own_here);
		}
		mv hit = full & le(g->target, own + own_here) & lt(FV(0.f), own_here);
		if (any(hit))
			span = SEL(hit, fv_min(span, (g->target - own) * span / own_here), span);
		EACH_WAVE(j)
			SET(full, g->depth[j], g->depth[j] + here[j] * span);
		SET(hit, g->t, g->t + span);
		g->reached |= hit;
		g->going &= NOT(hit);
	} else {
		fv p[8];
		corners(t, full, brick, i, p);
		/* the cubic, by Gauss's two nodes exactly */
		fv v = density_along(g, p, g->t + span * 0.211324865f) + density_along(g, p, g->t + span * 0.788675135f);
		fv sum = g->depth[0] + span * (0.5f * v);
		mv hit = full & le(g->target, sum);
		SET(hit, g->span, span);
		SET(full & NOT(hit), g->depth[0], sum);
		g->reached |= hit;
		g->going &= NOT(hit);
	}
	/* into the next cell */
	m = g->going;
	EACH(a, 3) {
		mv across = le(leave[a], out);
		if (any(empty))        /* along the other axes the ray has moved on, too */
			SET(m & empty, g->cell[a], fv_max(low[a], fv_min(low[a] + (many - 1.f), fv_trunc(g->at[a] + g->d[a] * out))));
		SET(m & across, g->cell[a], wall[a] + (g->up[a] - 1.f));
	}
	SET(m, g->t, fv_max(g->t, out));
	g->going &= lt(g->t, g->t1);
}

/* Where lanes that reached the target are, from entry; depth[0] of a density is then the target. */
FN fv passage_end(const struct scene *s, const struct tables *t, struct passage *g, mv m)
{
	m &= g->reached;
	if (COUNTED || !any(m))
		return g->t;
	fv p[8], v[4], span = g->span;
	iv i[3];
	indices(g, i);
	corners(t, m, brick_of(s, t, m, i), i, p);
	EACH(k, 4)    /* four values fix the cubic, which is not negative */
		v[k] = fv_max(FV(0.f), density_along(g, p, g->t + span * ((float)k * 0.333333333f)));
	fv all = span * 0.125f * (v[0] + 3.f * (v[1] + v[2]) + v[3]);
	fv q[5] = { v[0], -5.5f * v[0] + 9.f * v[1] - 4.5f * v[2] + v[3], 9.f * v[0] - 22.5f * v[1] + 18.f * v[2] - 4.5f * v[3],
		-4.5f * v[0] + 13.5f * v[1] - 13.5f * v[2] + 4.5f * v[3], FV(0.f) };
	fv share = SEL(lt(FV(0.f), all), fv_min(FV(1.f), (g->target - g->depth[0]) / all), FV(0.f));
	SET(m, g->t, g->t + span * invert_density(q, share, 4));
	SET(m, g->depth[0], g->target);
	return g->t;
}

#endif

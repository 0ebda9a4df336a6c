/* voxels - extinction on a grid, tracked exactly: constant in cubes that count particles, trilinear between the nodes of a density,
 * where it is a cubic along the ray within a cell.
 *
 * Cells lie in bricks of BRICK^3, each one piece of memory. A brick with nothing in it has none, but says how many bricks away, in
 * any direction, the nearest that is not empty lies: a ray passes all the empty ones around it in one step. The outermost are empty,
 * so that a ray that rounding puts a cell too far is still among bricks. A brick of cubes holds [z][y][x][wave]. A brick of a density
 * holds the corners of its cells as faces across z, so that a cell is read by two loads of four floats: [z of 5][y of 4][x of 5]
 * [y, y + 1]. Where each class has a density of its own, a brick is one for each wavelength, of extinction, and each class's density is
 * looked up where a flight has collided. lib/render/bricks.c makes them. */
#ifndef KERN_VOXELS_H
#define KERN_VOXELS_H

#include "render/kern/traversal.h"

#define BRICK 4
#define BRICK_CELLS (BRICK * BRICK * BRICK)
#define FACE_ROW (2 * (BRICK + 1))
#define FACE (BRICK * FACE_ROW)
#define BRICK_CORNERS ((BRICK + 1) * FACE)

/* Beyond this optical depth a shadow ray goes on by chance: what gets through is then never less than e^-4, so nothing grows
 * noisy, and a thick medium is not crossed in vain. */
#define SHADOW_DEPTH 4.f

/* Whether extinction differs from wavelength to wavelength in its place, not in a factor alone. */
#define BY_WAVE(v) (IS_COUNTED(v) || IS_CLASSED(v))

struct voxel_dda {
	mv reached;                /* came to the target: of a flight in the hero's optical depth, else in the least of all */
	fv depth[CARRIED];         /* passed: the optical depth of each wavelength; of a single density its integral, in depth[0] */
	fv target;
	fv asked;                  /* of a camera flight that looks how thick the volume is: where it would end; else -1 */
	fv whole[CARRIED];         /* optical depth of all that lies before the end of a forced flight */
	fv t, t1;                  /* from entry: of the cell that it is in, where it enters; where it leaves the medium */
	fv span;                   /* of the cell that has the target */
	/* in cells, from the low end: entry, direction and its inverse, 1 where it goes up; the cell */
	fv at[3], d[3], inverse[3], up[3], cell[3];
};

/* Lanes m set out from where they enter. */
FN void voxels_start(const struct scene *s, const struct volume *v, struct traversal *g, struct voxel_dda *q, mv m, fv target)
{
	EACH(a, 3)
		SET(m, q->cell[a], fv_trunc(fv_min(fv_max(q->at[a], FV((float)BRICK)), FV((float)(BRICK + v->voxels[a] - 1)))));
	SET(m, q->t, FV(0.f));
	SET(m, q->span, FV(0.f));
	SET(m, q->target, target);
	EACH_WAVE(j)
		SET(m, q->depth[j], FV(0.f));
	SET_TRUTH(m, q->reached, NO_LANE);
	SET_TRUTH(m, g->going, lt(FV(0.f), q->t1));
}

FN void voxels_begin(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g, struct voxel_dda *q, mv m,
                     struct ray r, fv t_end, mv flight, struct waves w, const struct random *random)
{
	fv target = free_path(SEL(flight, draw_bits(random, DRAW_FLIGHT), draw_bits(random, DRAW_SHADOW)));
	target += SEL(flight, FV(0.f), FV(SHADOW_DEPTH));
	if (!BY_WAVE(v)) {         /* in units of the integral of the density */
		fv own = of_hero(s, t->extinction, m, w), thinnest = own;
		EACH_WAVE(j)
			thinnest = fv_min(thinnest, of_wave(s, t->extinction, 0, m, w, j));
		own = SEL(flight, own, thinnest);
		target = SEL(lt(FV(0.f), own), target / own, FV(FAR));
	}
	fv t0, t1;
	clip_volume(v, r, &t0, &t1);
	t1 = fv_min(t1, t_end) - t0;
	struct vec entry = add(r.from, scale(r.along, t0));
	const fv at[3] = { entry.x, entry.y, entry.z }, d[3] = { r.along.x, r.along.y, r.along.z };
	const fv inverse[3] = { r.inverse.x, r.inverse.y, r.inverse.z };
	set3(m, &g->entry, entry);
	set3(m, &g->along, r.along);
	EACH(a, 3) {
		fv place = (at[a] - v->voxel_low[a]) * v->voxels_per_m[a];
		SET(m, q->at[a], place);
		SET(m, q->d[a], d[a] * v->voxels_per_m[a]);
		SET(m, q->inverse[a], inverse[a] * v->voxel[a]);
		SET(m, q->up[a], SEL(lt(FV(0.f), inverse[a]), FV(1.f), FV(0.f)));
	}
	SET(m, g->t0, t0);
	SET(m, q->t1, t1);
	SET(m, q->asked, FV(-1.f));
	SET_TRUTH(m, g->flight, flight);
	SET_TRUTH(m, g->forced, NO_LANE);
	voxels_start(s, v, g, q, m, target);
}

/* Flights m of the camera, which set out: they go on until it is known that they are not thin. */
FN void voxels_measure(const struct scene *s, const struct volume *v, const struct tables *t, struct voxel_dda *q, mv m, struct waves w)
{
	fv least = FV(FORCED_DEPTH), thickest = FV(0.f);
	if (!BY_WAVE(v)) {
		EACH_WAVE(j)
			thickest = fv_max(thickest, of_wave(s, t->extinction, 0, m, w, j));
		least = SEL(lt(FV(0.f), thickest), least / thickest, FV(0.f));
	}
	SET(m, q->asked, q->target);
	SET(m, q->target, fv_max(q->target, least));
}

/* They have ended: forced where they were thin. Returns those that have to go again, to where they end. */
FN mv voxels_force(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g, struct voxel_dda *q, mv m,
                   struct waves w, const struct random *random, mv *thin)
{
	fv whole[CARRIED], thickest = FV(0.f);
	EACH_WAVE(j) {
		whole[j] = BY_WAVE(v) ? q->depth[j] : of_wave(s, t->extinction, 0, m, w, j) * q->depth[0];
		thickest = fv_max(thickest, whole[j]);
	}
	m &= le(FV(0.f), q->asked);
	mv through = m & NOT(q->reached);
	fv own = hero_among(s, whole, w), passed = BY_WAVE(v) ? own : q->depth[0], target = q->asked;
	*thin = through & lt(FV(0.f), thickest) & lt(thickest, FV(FORCED_DEPTH));
	mv again = *thin | (through & le(q->asked, passed)) | (m & q->reached & lt(q->asked, q->target));
	SET(m, q->asked, FV(-1.f));
	if (any(*thin)) {
		fv forced = forced_path(draw_bits(random, DRAW_FLIGHT), fv_min(own, FV(FORCED_DEPTH)));
		if (!BY_WAVE(v)) {
			fv sigma = of_hero(s, t->extinction, m, w);
			forced = SEL(lt(FV(0.f), sigma), forced / sigma, FV(FAR));
		}
		SET(*thin, target, forced);
		EACH_WAVE(j)
			SET(*thin, q->whole[j], whole[j]);
		g->forced |= *thin;
	}
	if (any(again))
		voxels_start(s, v, g, q, again, target);
	return again;
}

/* The optical depth of all that lies before the end of forced flights m. */
FN void voxels_depth(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g, struct voxel_dda *q, mv m,
                     struct waves w, fv *out)
{
	(void)s, (void)v, (void)t, (void)g, (void)m, (void)w;
	EACH_WAVE(j)
		out[j] = q->whole[j];
}

/* The cell as integers. */
FN void indices(const struct voxel_dda *q, iv *i)
{
	EACH(a, 3)
		i[a] = to_int(q->cell[a]);
}

FN iv brick_of(const struct volume *v, const struct tables *t, mv m, const iv *i)
{
	return igather(m, t->brick, ((i[2] >> 2) * v->bricks[1] + (i[1] >> 2)) * v->bricks[0] + (i[0] >> 2));
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
FN fv density_along(const struct voxel_dda *q, const fv *p, fv t)
{
	fv x = q->at[0] + q->d[0] * t - q->cell[0], y = q->at[1] + q->d[1] * t - q->cell[1], z = q->at[2] + q->d[2] * t - q->cell[2];
	fv a = p[0] + (p[2] - p[0]) * x, b = p[1] + (p[3] - p[1]) * x, c = p[4] + (p[6] - p[4]) * x, d = p[5] + (p[7] - p[5]) * x;
	fv e = a + (b - a) * y, f = c + (d - c) * y;
	return e + (f - e) * z;
}

/* The integral of a field over span from t, within a cell: that of a cubic, by Gauss's two nodes exactly. */
FN fv passed_in(const struct tables *t, const struct voxel_dda *q, mv m, iv brick, const iv *i, fv from, fv span)
{
	fv p[8];
	corners(t, m, brick, i, p);
	return span * (0.5f * (density_along(q, p, from + span * 0.211324865f) + density_along(q, p, from + span * 0.788675135f)));
}

/* The brick of wavelength j among those of a brick. */
FN iv field_of(const struct scene *s, iv brick, struct waves w, int j) { return brick * N_WAVES + wave_of(s, w, j); }

/* One cell, or empty bricks at once, of all lanes under way (3D-DDA). */
FN void voxels_step(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g, struct voxel_dda *q,
                    struct waves w, const struct random *random)
{
	(void)random;
	mv m = g->going;
	iv i[3];
	indices(q, i);
	iv brick = brick_of(v, t, m, i);
	mv empty = m & ilt(brick, IV(0)), full = m & NOT(empty);
	/* what is passed now: cells from low on, one or many along each axis */
	fv low[3] = { q->cell[0], q->cell[1], q->cell[2] }, many = FV(1.f), wall[3], leave[3];
	if (any(empty)) {
		many = SEL(empty, to_float((-2 * BRICK) * brick - BRICK), many);
		EACH(a, 3)
			low[a] = SEL(empty, to_float((i[a] & ~(BRICK - 1)) + (brick + 1) * BRICK), low[a]);
	}
	EACH(a, 3) {
		wall[a] = low[a] + q->up[a] * many;
		leave[a] = (wall[a] - q->at[a]) * q->inverse[a];
	}
	fv out = fv_min(leave[0], fv_min(leave[1], leave[2])), span = fv_max(FV(0.f), fv_min(out, q->t1) - q->t);
	if (IS_COUNTED(v)) {
		fv here[CARRIED], own = FV(FAR), own_here = FV(FAR);
		iv at = (brick * BRICK_CELLS + ((i[2] & 3) * BRICK + (i[1] & 3)) * BRICK + (i[0] & 3)) * N_WAVES;
		EACH_WAVE(j) {
			here[j] = gather(full, t->voxel, at + wave_of(s, w, j));
			mv mine = CARRIED == 1 ? ALL_LANES
			    : (g->flight & ieq(w.hero, IV(j))) | (NOT(g->flight) & lt(q->depth[j] + here[j] * span, own + own_here));
			own = SEL(mine, q->depth[j], own);
			own_here = SEL(mine, here[j] * span, own_here);
		}
		mv hit = full & le(q->target, own + own_here) & lt(FV(0.f), own_here);
		if (any(hit))
			span = SEL(hit, fv_min(span, (q->target - own) * span / own_here), span);
		EACH_WAVE(j)
			SET(full, q->depth[j], q->depth[j] + here[j] * span);
		SET(hit, q->t, q->t + span);
		q->reached |= hit;
		g->going &= NOT(hit);
	} else if (IS_CLASSED(v)) {
		fv all[CARRIED], own = FV(FAR);
		EACH_WAVE(j) {
			all[j] = q->depth[j] + passed_in(t, q, full, field_of(s, brick, w, j), i, q->t, span);
			mv mine = CARRIED == 1 ? ALL_LANES : (g->flight & ieq(w.hero, IV(j))) | (NOT(g->flight) & lt(all[j], own));
			own = SEL(mine, all[j], own);
		}
		mv hit = full & le(q->target, own);
		SET(hit, q->span, span);
		EACH_WAVE(j)
			SET(full & NOT(hit), q->depth[j], all[j]);
		q->reached |= hit;
		g->going &= NOT(hit);
	} else {
		fv sum = q->depth[0] + passed_in(t, q, full, brick, i, q->t, span);
		mv hit = full & le(q->target, sum);
		SET(hit, q->span, span);
		SET(full & NOT(hit), q->depth[0], sum);
		q->reached |= hit;
		g->going &= NOT(hit);
	}
	/* into the next cell */
	m = g->going;
	EACH(a, 3) {
		mv across = le(leave[a], out);
		if (any(empty))        /* along the other axes the ray has moved on, too */
			SET(m & empty, q->cell[a], fv_max(low[a], fv_min(low[a] + (many - 1.f), fv_trunc(q->at[a] + q->d[a] * out))));
		SET(m & across, q->cell[a], wall[a] + (q->up[a] - 1.f));
	}
	SET(m, q->t, fv_max(q->t, out));
	g->going &= lt(q->t, q->t1);
}

/* Where lanes that reached the target are, from entry; depth[] is then what is passed up to there. */
FN fv target_place(const struct scene *s, const struct volume *v, const struct tables *t, struct voxel_dda *q, mv m, struct waves w)
{
	m &= q->reached;
	if (IS_COUNTED(v) || !any(m))
		return q->t;
	fv p[8], f[4], span = q->span;
	iv i[3];
	indices(q, i);
	iv brick = brick_of(v, t, m, i);
	corners(t, m, IS_CLASSED(v) ? brick * N_WAVES + hero_of(s, w) : brick, i, p);
	EACH(k, 4)    /* four values fix the cubic, which is not negative */
		f[k] = fv_max(FV(0.f), density_along(q, p, q->t + span * ((float)k * 0.333333333f)));
	fv all = span * 0.125f * (f[0] + 3.f * (f[1] + f[2]) + f[3]);
	fv cubic[5] = { f[0], -5.5f * f[0] + 9.f * f[1] - 4.5f * f[2] + f[3], 9.f * f[0] - 22.5f * f[1] + 18.f * f[2] - 4.5f * f[3],
		-4.5f * f[0] + 13.5f * f[1] - 13.5f * f[2] + 4.5f * f[3], FV(0.f) };
	fv before = IS_CLASSED(v) ? hero_among(s, q->depth, w) : q->depth[0];
	fv share = SEL(lt(FV(0.f), all), fv_min(FV(1.f), (q->target - before) / all), FV(0.f)), on = span * invert_density(cubic, share, 4);
	if (IS_CLASSED(v))
		EACH_WAVE(j)
			SET(m, q->depth[j], q->depth[j] + passed_in(t, q, m, field_of(s, brick, w, j), i, q->t, on));
	else
		SET(m, q->depth[0], q->target);
	SET(m, q->t, q->t + on);
	return q->t;
}

FN void voxels_transmittance(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g, struct voxel_dda *q,
                             mv m, struct waves w, fv *out)
{
	fv thinnest = FV(FAR);
	(void)g;
	EACH_WAVE(j) {
		out[j] = BY_WAVE(v) ? q->depth[j] : of_wave(s, t->extinction, 0, m, w, j) * q->depth[0];
		thinnest = fv_min(thinnest, out[j]);
	}
	fv sure = fv_max(FV(0.f), thinnest - SHADOW_DEPTH);    /* e^-sure was the chance to come through */
	EACH_WAVE(j)
		out[j] = SEL(q->reached, FV(0.f), expneg(out[j] - sure));
}

/* Which class of a cube's particles is met: by count x c_ext of the hero. */
FN iv class_in(const struct scene *s, const struct volume *v, const struct tables *t, mv m, const struct voxel_dda *q, iv wave, fv u)
{
	iv i[3];
	indices(q, i);
	iv class = IV(0), row = (((i[2] - BRICK) * v->voxels[1] + (i[1] - BRICK)) * v->voxels[0] + (i[0] - BRICK)) * v->n_classes;
	fv all = FV(0.f), sum = FV(0.f);
	for (int k = 0; k < v->n_classes; k++)
		all += to_float(igather(m, t->count, row + k)) * gather(m, t->disc_radius2, k * N_WAVES + wave);
	for (int k = 0; k < v->n_classes; k++) {
		fv own = to_float(igather(m, t->count, row + k)) * gather(m, t->disc_radius2, k * N_WAVES + wave);
		class = SEL(lt(FV(0.f), own) & le(sum, u * all), IV(k), class);
		sum += own;
	}
	return class;
}

/* The same of densities: by each class's at the place, trilinear between its nodes, of which v->voxels are one more. */
FN iv class_at(const struct scene *s, const struct volume *v, const struct tables *t, mv m, const struct voxel_dda *q, iv wave, fv u)
{
	iv i[3], node[3][2];
	fv share[3][2];
	indices(q, i);
	EACH(a, 3) {
		iv last = IV(v->voxels[a] - 2), first = i[a] - (BRICK + 1);
		node[a][0] = SEL(ilt(first, IV(0)), IV(0), first);
		node[a][1] = iv_min(first + 1, last);
		share[a][1] = q->at[a] + q->d[a] * q->t - q->cell[a];
		share[a][0] = 1.f - share[a][1];
	}
	int nx = v->voxels[0] - 1, ny = v->voxels[1] - 1, nodes = nx * ny * (v->voxels[2] - 1);
	iv class = IV(0);
	fv all = FV(0.f), sum = FV(0.f);
	for (int pass = 0; pass < 2; pass++)
		for (int k = 0; k < v->n_classes; k++) {
			fv own = FV(0.f);
			for (int c = 0; c < 8; c++) {
				iv at = (node[2][c >> 2] * ny + node[1][c >> 1 & 1]) * nx + node[0][c & 1];
				own += share[2][c >> 2] * share[1][c >> 1 & 1] * share[0][c & 1] * gather(m, t->density, at + k * nodes);
			}
			own = fv_max(own, FV(0.f)) * gather(m, t->disc_radius2, k * N_WAVES + wave);
			if (pass) {
				class = SEL(lt(FV(0.f), own) & le(sum, u * all), IV(k), class);
				sum += own;
			} else {
				all += own;
			}
		}
	return class;
}

FN struct collision voxels_end(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g, struct voxel_dda *q,
                               mv m, struct waves w, const struct random *random, fv *flight_pdf)
{
	struct collision c = { m & q->reached, g->entry, target_place(s, v, t, q, m, w), IV(v->n_classes), IV(NONE), IV(0) };
	c.point = add(g->entry, scale(g->along, c.t));
	c.t += g->t0;
	if (IS_CLASSED(v))
		c.class = class_at(s, v, t, c.happened, q, hero_of(s, w), draw(random, DRAW_CLASS));
	else if (IS_COUNTED(v))
		c.class = v->only_class >= 0 ? IV(v->only_class)
		    : class_in(s, v, t, c.happened, q, hero_of(s, w), draw(random, DRAW_CLASS));
	EACH_WAVE(j) {
		fv own = of_wave(s, t->extinction, 0, m, w, j), depth = BY_WAVE(v) ? q->depth[j] : own * q->depth[0];
		fv rate = BY_WAVE(v) ? of_class(s, v, t->disc_radius2, c.happened, c.class, w, j) * v->largest_inverse : own;
		flight_pdf[j] = expneg(depth) * SEL(c.happened, rate, FV(1.f));
		if (CARRIED > 1 && any(m & g->forced))
			SET(g->forced, flight_pdf[j], flight_pdf[j] / one_less_exp(fv_max(q->whole[j], FV(1e-30f))));
	}
	return c;
}

#endif

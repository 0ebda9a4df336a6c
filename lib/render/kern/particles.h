/* particles - the particles around a ray: each is met with the probability C / A, where C is its extinction cross section at a
 * wavelength and A the area of the cylinder around the ray that must hold its centre. A = C is the explicit model (a disc that the
 * ray meets or not), a larger A the fat ray, whose transmittance prod(1 - C/A) has the same mean.
 *
 * Layer by layer of cells along the ray's main axis, in each layer the cells that the cylinder cuts, row by row along x. Every
 * particle lies in one cell and is looked at once. */
#ifndef KERN_PARTICLES_H
#define KERN_PARTICLES_H

#include "render/kern/random.h"
#include "render/kern/ray.h"

struct gather {
	mv going;
	mv flight;                 /* looks for the first particle met, else for the transmittance */
	/* what was found */
	fv depth[CARRIED];         /* of the first particle met, counted from entry */
	iv id[CARRIED];            /* the particle, or NONE */
	fv through[CARRIED];       /* transmittance */
	struct vec entry;          /* where the ray comes to the particles: from afar, floats would be too coarse */
	/* the ray, counted from there, and the depths between which a centre counts */
	struct vec along;
	iv skip;
	fv ahead, limit;
	/* layers across axis a, its main one; b and c are the next ones in turn */
	mv a_is_x, a_is_y;
	iv layer, left, step;      /* the next layer, and how many are left */
	fv origin_a, cell_a;       /* the grid along a; its low end relative to entry */
	fv slope_b, slope_c;       /* of the ray, from layer to layer */
	fv low_b, low_c, wide_b, wide_c;    /* entry, in cells from the low end, and how far from the ray a centre can be, in cells */
	fv inverse_cell_b, inverse_cell_c;
	fv inverse_a, back;        /* particles of a layer are no nearer than (its place along a) inverse_a - back */
	/* the cells of the layer: rows from x0 to x1; at row y, z; and the particles of that row */
	iv x0, x1, y0, y1, y, z, z1;
	iv n, to;
};

/* What axis a, b or c of each lane is among three values by x, y, z; and back. */
#define BY_A(g, v) SEL((g)->a_is_x, v[0], SEL((g)->a_is_y, v[1], v[2]))
#define BY_B(g, v) SEL((g)->a_is_x, v[1], SEL((g)->a_is_y, v[2], v[0]))
#define BY_C(g, v) SEL((g)->a_is_x, v[2], SEL((g)->a_is_y, v[0], v[1]))
#define BY_X(g, a, b, c) SEL((g)->a_is_x, a, SEL((g)->a_is_y, c, b))
#define BY_Y(g, a, b, c) SEL((g)->a_is_x, b, SEL((g)->a_is_y, a, c))
#define BY_Z(g, a, b, c) SEL((g)->a_is_x, c, SEL((g)->a_is_y, b, a))

/* Lanes m set out along r up to t_end. */
FN void gather_begin(const struct scene *s, struct gather *g, mv m, struct ray r, fv t_end, mv flight)
{
	fv t0, t1;
	clip_box(r, load3(s->grid_centre), load3(s->grid_reached), &t0, &t1);
	struct vec entry = add(r.from, scale(r.along, t0));
	t1 = fv_min(t1, t_end) - t0;
	set3(m, &g->entry, entry);
	set3(m, &g->along, r.along);
	SET(m, g->skip, r.skip);
	SET(m, g->ahead, -t0);
	SET(m, g->limit, t_end - t0);
	EACH_WAVE(j) {
		SET(m, g->depth[j], g->limit);
		SET(m, g->id[j], IV(NONE));
		SET(m, g->through[j], FV(1.f));
	}
	SET_TRUTH(m, g->flight, flight);
	const fv d[3] = { r.along.x, r.along.y, r.along.z }, at[3] = { entry.x, entry.y, entry.z };
	const fv low[3] = { FV(s->grid_low[0]), FV(s->grid_low[1]), FV(s->grid_low[2]) };
	const fv cell[3] = { FV(s->cell[0]), FV(s->cell[1]), FV(s->cell[2]) };
	const fv cells_per_m[3] = { FV(1.f / s->cell[0]), FV(1.f / s->cell[1]), FV(1.f / s->cell[2]) };
	const iv cells[3] = { IV(s->cells[0]), IV(s->cells[1]), IV(s->cells[2]) };
	fv x = fv_abs(d[0]), y = fv_abs(d[1]), z = fv_abs(d[2]);
	SET_TRUTH(m, g->a_is_x, lt(y, x) & lt(z, x));
	SET_TRUTH(m, g->a_is_y, NOT(lt(y, x)) & lt(z, y));
	fv inv[3] = { r.inverse.x, r.inverse.y, r.inverse.z }, d_a = BY_A(g, d), inverse_a = BY_A(g, inv), slope_b = BY_B(g, d) * inverse_a, slope_c = BY_C(g, d) * inverse_a;
	fv cell_a = BY_A(g, cell), inverse_b = BY_B(g, cells_per_m), inverse_c = BY_C(g, cells_per_m);
	fv wide_a = s->reach * fv_sqrt(fv_max(FV(0.f), 1.f - d_a * d_a)), origin = BY_A(g, low) - BY_A(g, at);
	fv start = -wide_a - origin, end = d_a * t1, inverse_cell = BY_A(g, cells_per_m);
	fv from = (fv_min(end, FV(0.f)) + start) * inverse_cell, to = (fv_max(end, FV(0.f)) + wide_a - origin) * inverse_cell;
	iv n = BY_A(g, cells), first = to_int(fv_min(fv_max(from, FV(0.f)), to_float(n))), last = to_int(fv_max(fv_min(to, to_float(n - 1)), FV(-1.f)));
	mv up = lt(FV(0.f), d_a);
	SET(m, g->layer, SEL(up, first, last));
	SET(m, g->left, last - first + 1);
	SET(m, g->step, SEL(up, IV(1), IV(-1)));
	SET(m, g->origin_a, origin);
	SET(m, g->cell_a, cell_a);
	SET(m, g->slope_b, slope_b);
	SET(m, g->slope_c, slope_c);
	SET(m, g->low_b, (BY_B(g, at) - BY_B(g, low)) * inverse_b);
	SET(m, g->low_c, (BY_C(g, at) - BY_C(g, low)) * inverse_c);
	/* how far a centre can be from the ray along an axis, in a plane across axis a; and along a */
	SET(m, g->wide_b, s->reach * fv_sqrt(1.f + slope_b * slope_b) * inverse_b);
	SET(m, g->wide_c, s->reach * fv_sqrt(1.f + slope_c * slope_c) * inverse_c);
	SET(m, g->inverse_cell_b, inverse_b);
	SET(m, g->inverse_cell_c, inverse_c);
	SET(m, g->inverse_a, inverse_a);
	SET(m, g->back, wide_a * fv_abs(inverse_a));
	SET(m, g->y, IV(0));
	SET(m, g->y1, IV(0));
	SET(m, g->z, IV(0));
	SET(m, g->z1, IV(0));
	SET(m, g->n, IV(0));
	SET(m, g->to, IV(0));
	SET_TRUTH(m, g->going, lt(FV(0.f), t1) & le(FV(0.f), to) & lt(from, to_float(n)));
}

/* The indices of cells [*from, *to] of n that the range low..low + wide in cells touches. */
FN mv cells_touched(fv a, fv b, fv wide, iv n, iv *from, iv *to)
{
	fv low = fv_min(a, b) - wide, high = fv_max(a, b) + wide, end = to_float(n);
	*from = to_int(fv_min(fv_max(low, FV(0.f)), end));
	*to = to_int(fv_max(fv_min(high, end - 1.f), FV(-1.f)));
	return le(FV(0.f), high) & lt(low, end);
}

/* Lanes m, whose row is done, go to the next one, of a further layer if need be, or end. */
FN void gather_row(const struct scene *s, const struct tables *t, struct gather *g, mv m)
{
	const iv cells[3] = { IV(s->cells[0]), IV(s->cells[1]), IV(s->cells[2]) };
	SET(m, g->y, g->y + 1);
	mv over = m & ilt(g->y1, g->y);
	SET(over, g->y, g->y0);
	SET(over, g->z, g->z + 1);
	over &= ilt(g->z1, g->z);
	if (any(over)) {
		fv face = g->origin_a + to_float(g->layer) * g->cell_a, nearest = face + SEL(ilt(g->step, IV(0)), g->cell_a, FV(0.f));
		/* what this layer and further ones can still change */
		fv furthest = g->depth[0], brightest = g->through[0];
		EACH_WAVE(j) {
			furthest = fv_max(furthest, g->depth[j]);
			brightest = fv_max(brightest, g->through[j]);
		}
		mv done = le(furthest, nearest * g->inverse_a - g->back) | le(brightest, FV(0.f)) | ilt(g->left, IV(1))
		    | (NOT(g->flight) & lt(furthest, g->limit));
		g->going &= NOT(over & done);
		m &= g->going;
		over &= g->going;
		fv b = g->low_b + face * g->slope_b * g->inverse_cell_b, c = g->low_c + face * g->slope_c * g->inverse_cell_c;
		iv b0, b1, c0, c1;
		mv some = cells_touched(b, b + g->cell_a * g->slope_b * g->inverse_cell_b, g->wide_b, BY_B(g, cells), &b0, &b1)
		    & cells_touched(c, c + g->cell_a * g->slope_c * g->inverse_cell_c, g->wide_c, BY_C(g, cells), &c0, &c1);
		SET(over, g->x0, BY_X(g, g->layer, b0, c0));
		SET(over, g->x1, BY_X(g, g->layer, b1, c1));
		SET(over, g->y0, BY_Y(g, g->layer, b0, c0));
		SET(over, g->y1, BY_Y(g, g->layer, b1, c1));
		SET(over, g->z, BY_Z(g, g->layer, b0, c0));
		SET(over, g->z1, BY_Z(g, g->layer, b1, c1));
		SET(over, g->y, g->y0);
		mv empty = over & NOT(some);    /* its one row is done at once */
		SET(empty, g->y, g->y1);
		SET(empty, g->z, g->z1);
		m &= NOT(empty);
		SET(over, g->layer, g->layer + g->step);
		SET(over, g->left, g->left - 1);
	}
	iv row = (g->z * s->cells[1] + g->y) * s->cells[0];
	SET(m, g->n, igather(m, t->first, row + g->x0));
	SET(m, g->to, igather(m, t->first, row + g->x1 + 1));
}

/* Probability that a particle whose disc is C / pi is met by a fat ray that holds it. */
FN fv hit_probability(const struct scene *s, fv disc)
{
	fv share = disc * (PI / s->fat);
	return s->attenuation == ATTENUATION_EXPONENTIAL ? 1.f - expneg(share) : fv_min(share, FV(1.f));
}

/* A number in [0, 1) of a particle and a vertex; for all wavelengths the same, so that they meet the same particles. */
FN fv coin(const struct random *random, iv id)
{
	return unit_of(mix(unsigned_of(id) * 0x9e3779b1u + random->counter, random->key ^ 0x5bd1e995u));
}

/* Where particle n is, and its class. */
FN struct vec particle_at(const struct tables *t, mv m, iv n, iv *class)
{
	fv q[4];
	gather4(m, t->particle, 4 * n, 0, q);
	*class = signed_of(float_bits(q[3]));
	return vec3(q[0], q[1], q[2]);
}

/* Lanes m take the next particle of their row into account. */
FN void gather_particle(const struct scene *s, const struct tables *t, struct gather *g, mv m, struct waves w, const struct random *random)
{
	iv class, n = g->n;
	struct vec v = sub(particle_at(t, m, n, &class), g->entry);
	fv depth = dot3(v, g->along);
	struct vec off = sub(v, scale(g->along, depth));    /* no cancellation of squares */
	fv d2 = dot3(off, off);
	SET(m, g->n, n + 1);
	m &= lt(d2, FV(s->reach2)) & lt(g->ahead, depth) & lt(depth, g->limit) & NOT(ieq(n, g->skip));
	fv toss = TRANSPORT == TRANSPORT_FAT_RAY ? coin(random, n) : FV(0.f);
	EACH_WAVE(j) {
		fv disc = of_class(s, t->disc, m, class, w, j);
		mv met = m;
		if (TRANSPORT == TRANSPORT_EXPLICIT) {
			met &= lt(d2, disc);
		} else {
			fv p = hit_probability(s, disc);
			SET(m & NOT(g->flight), g->through[j], g->through[j] * (1.f - p));
			met &= g->flight & lt(toss, p);
		}
		met &= lt(depth, g->depth[j]);
		SET(met, g->depth[j], depth);
		SET(met, g->id[j], n);
	}
}

/* Lanes that wait for the others to end a row, at most; none of one lane. */
#define ROW_WAIT (LANES / 2)

FN void gather_on(const struct scene *s, const struct tables *t, struct gather *g, struct waves w, const struct random *random)
{
	mv busy = g->going & ilt(g->n, g->to);
	int n = count(busy), least_busy = count(g->going) - ROW_WAIT;
	while (n > 0) {
		gather_particle(s, t, g, busy, w, random);
		busy = g->going & ilt(g->n, g->to);
		n = count(busy);
		if (n < least_busy)
			break;
	}
	gather_row(s, t, g, g->going & NOT(busy));
}

/* The transmittance of a ray that has ended. */
FN fv gather_through(const struct scene *s, const struct gather *g, int j)
{
	return TRANSPORT == TRANSPORT_EXPLICIT ? SEL(ieq(g->id[j], IV(NONE)), FV(1.f), FV(0.f)) : g->through[j];
}

#endif

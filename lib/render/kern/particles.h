/* particles - the particles around a ray: each is met with the probability C / A, where C is its extinction cross section at a
 * wavelength and A the area of the cylinder around the ray that must hold its centre. A = C is the explicit model (a disc that the
 * ray meets or not), a larger A the fat ray, whose transmittance prod(1 - C/A) has the same mean.
 *
 * Layer by layer of cells along the ray's main axis, in each layer the cells that the cylinder cuts, row by row along x. Every
 * particle lies in one cell and is looked at once. */
#ifndef KERN_PARTICLES_H
#define KERN_PARTICLES_H

#include "render/kern/traversal.h"

#define USES_PARTICLES(v) (TRANSPORT_OF(v) == TRANSPORT_EXPLICIT || TRANSPORT_OF(v) == TRANSPORT_FAT_RAY)

/* A flight looks for the first particle met, a shadow ray for the transmittance. */
struct particle_query {
	/* what was found */
	fv depth[CARRIED];         /* of the first particle met, counted from entry */
	iv id[CARRIED];            /* the particle, or NONE */
	fv through[CARRIED];       /* transmittance */
	iv skip;                   /* the particle that the ray starts from */
	fv ahead, limit;           /* between these depths a centre counts */
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
#define BY_A(q, v) SEL((q)->a_is_x, v[0], SEL((q)->a_is_y, v[1], v[2]))
#define BY_B(q, v) SEL((q)->a_is_x, v[1], SEL((q)->a_is_y, v[2], v[0]))
#define BY_C(q, v) SEL((q)->a_is_x, v[2], SEL((q)->a_is_y, v[0], v[1]))
#define BY_X(q, a, b, c) SEL((q)->a_is_x, a, SEL((q)->a_is_y, c, b))
#define BY_Y(q, a, b, c) SEL((q)->a_is_x, b, SEL((q)->a_is_y, a, c))
#define BY_Z(q, a, b, c) SEL((q)->a_is_x, c, SEL((q)->a_is_y, b, a))

FN void particles_begin(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g, struct particle_query *q,
                        mv m, struct ray r, fv t_end, mv flight, struct waves w, const struct random *random)
{
	fv t0, t1;
	(void)s, (void)t, (void)w, (void)random;
	clip_box(r, load3(v->grid_centre), load3(v->grid_reached), &t0, &t1);
	struct vec entry = add(r.from, scale(r.along, t0));
	t1 = fv_min(t1, t_end) - t0;
	set3(m, &g->entry, entry);
	set3(m, &g->along, r.along);
	SET(m, g->t0, t0);
	SET(m, q->skip, r.skip);
	SET(m, q->ahead, -t0);
	SET(m, q->limit, t_end - t0);
	EACH_WAVE(j) {
		SET(m, q->depth[j], q->limit);
		SET(m, q->id[j], IV(NONE));
		SET(m, q->through[j], FV(1.f));
	}
	SET_TRUTH(m, g->flight, flight);
	const fv d[3] = { r.along.x, r.along.y, r.along.z }, at[3] = { entry.x, entry.y, entry.z };
	const fv low[3] = { FV(v->grid_low[0]), FV(v->grid_low[1]), FV(v->grid_low[2]) };
	const fv cell[3] = { FV(v->cell[0]), FV(v->cell[1]), FV(v->cell[2]) };
	const fv cells_per_m[3] = { FV(1.f / v->cell[0]), FV(1.f / v->cell[1]), FV(1.f / v->cell[2]) };
	const iv cells[3] = { IV(v->cells[0]), IV(v->cells[1]), IV(v->cells[2]) };
	fv x = fv_abs(d[0]), y = fv_abs(d[1]), z = fv_abs(d[2]);
	SET_TRUTH(m, q->a_is_x, lt(y, x) & lt(z, x));
	SET_TRUTH(m, q->a_is_y, NOT(lt(y, x)) & lt(z, y));
	fv inv[3] = { r.inverse.x, r.inverse.y, r.inverse.z }, d_a = BY_A(q, d), inverse_a = BY_A(q, inv);
	fv slope_b = BY_B(q, d) * inverse_a, slope_c = BY_C(q, d) * inverse_a;
	fv cell_a = BY_A(q, cell), inverse_b = BY_B(q, cells_per_m), inverse_c = BY_C(q, cells_per_m);
	fv wide_a = v->query_radius * fv_sqrt(fv_max(FV(0.f), 1.f - d_a * d_a)), origin = BY_A(q, low) - BY_A(q, at);
	fv start = -wide_a - origin, end = d_a * t1, inverse_cell = BY_A(q, cells_per_m);
	fv from = (fv_min(end, FV(0.f)) + start) * inverse_cell, to = (fv_max(end, FV(0.f)) + wide_a - origin) * inverse_cell;
	iv n = BY_A(q, cells), first = to_int(fv_min(fv_max(from, FV(0.f)), to_float(n))), last = to_int(fv_max(fv_min(to, to_float(n - 1)), FV(-1.f)));
	mv up = lt(FV(0.f), d_a);
	SET(m, q->layer, SEL(up, first, last));
	SET(m, q->left, last - first + 1);
	SET(m, q->step, SEL(up, IV(1), IV(-1)));
	SET(m, q->origin_a, origin);
	SET(m, q->cell_a, cell_a);
	SET(m, q->slope_b, slope_b);
	SET(m, q->slope_c, slope_c);
	SET(m, q->low_b, (BY_B(q, at) - BY_B(q, low)) * inverse_b);
	SET(m, q->low_c, (BY_C(q, at) - BY_C(q, low)) * inverse_c);
	/* how far a centre can be from the ray along an axis, in a plane across axis a; and along a */
	SET(m, q->wide_b, v->query_radius * fv_sqrt(1.f + slope_b * slope_b) * inverse_b);
	SET(m, q->wide_c, v->query_radius * fv_sqrt(1.f + slope_c * slope_c) * inverse_c);
	SET(m, q->inverse_cell_b, inverse_b);
	SET(m, q->inverse_cell_c, inverse_c);
	SET(m, q->inverse_a, inverse_a);
	SET(m, q->back, wide_a * fv_abs(inverse_a));
	SET(m, q->y, IV(0));
	SET(m, q->y1, IV(0));
	SET(m, q->z, IV(0));
	SET(m, q->z1, IV(0));
	SET(m, q->n, IV(0));
	SET(m, q->to, IV(0));
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

/* All that the kernels know of particles: those of a cell are in a row from its first one to the next cell's. */
FN iv first_particle(const struct tables *t, mv m, iv cell) { return igather(m, t->first, cell); }

/* Where particle n is, and its class. */
FN struct vec particle_at(const struct tables *t, mv m, iv n, iv *class)
{
	fv q[4];
	gather4(m, t->particle, 4 * n, 0, q);
	*class = signed_of(float_bits(q[3]));
	return vec3(q[0], q[1], q[2]);
}

/* Lanes m, whose row is done, go to the next one, of a further layer if need be, or end. */
FN void particles_row(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g,
                      struct particle_query *q, mv m)
{
	const iv cells[3] = { IV(v->cells[0]), IV(v->cells[1]), IV(v->cells[2]) };
	SET(m, q->y, q->y + 1);
	mv over = m & ilt(q->y1, q->y);
	SET(over, q->y, q->y0);
	SET(over, q->z, q->z + 1);
	over &= ilt(q->z1, q->z);
	if (any(over)) {
		fv face = q->origin_a + to_float(q->layer) * q->cell_a, nearest = face + SEL(ilt(q->step, IV(0)), q->cell_a, FV(0.f));
		/* what this layer and further ones can still change */
		fv furthest = q->depth[0], brightest = q->through[0];
		EACH_WAVE(j) {
			furthest = fv_max(furthest, q->depth[j]);
			brightest = fv_max(brightest, q->through[j]);
		}
		mv done = le(furthest, nearest * q->inverse_a - q->back) | le(brightest, FV(0.f)) | ilt(q->left, IV(1))
		    | (NOT(g->flight) & lt(furthest, q->limit));
		g->going &= NOT(over & done);
		m &= g->going;
		over &= g->going;
		fv b = q->low_b + face * q->slope_b * q->inverse_cell_b, c = q->low_c + face * q->slope_c * q->inverse_cell_c;
		iv b0, b1, c0, c1;
		mv some = cells_touched(b, b + q->cell_a * q->slope_b * q->inverse_cell_b, q->wide_b, BY_B(q, cells), &b0, &b1)
		    & cells_touched(c, c + q->cell_a * q->slope_c * q->inverse_cell_c, q->wide_c, BY_C(q, cells), &c0, &c1);
		SET(over, q->x0, BY_X(q, q->layer, b0, c0));
		SET(over, q->x1, BY_X(q, q->layer, b1, c1));
		SET(over, q->y0, BY_Y(q, q->layer, b0, c0));
		SET(over, q->y1, BY_Y(q, q->layer, b1, c1));
		SET(over, q->z, BY_Z(q, q->layer, b0, c0));
		SET(over, q->z1, BY_Z(q, q->layer, b1, c1));
		SET(over, q->y, q->y0);
		mv empty = over & NOT(some);    /* its one row is done at once */
		SET(empty, q->y, q->y1);
		SET(empty, q->z, q->z1);
		m &= NOT(empty);
		SET(over, q->layer, q->layer + q->step);
		SET(over, q->left, q->left - 1);
	}
	iv row = (q->z * v->cells[1] + q->y) * v->cells[0];
	SET(m, q->n, first_particle(t, m, row + q->x0));
	SET(m, q->to, first_particle(t, m, row + q->x1 + 1));
}

/* Probability that a particle of area C, pi disc_radius2, is met by a fat ray that holds it. */
FN fv hit_probability(const struct volume *v, fv disc_radius2)
{
	fv share = disc_radius2 * (PI / v->fat_area);
	return v->attenuation == ATTENUATION_EXPONENTIAL ? 1.f - expneg(share) : fv_min(share, FV(1.f));
}

/* A number in [0, 1) of a particle and a vertex; for all wavelengths the same, so that they meet the same particles. */
FN fv coin(const struct random *random, iv id)
{
	return unit_of(mix(unsigned_of(id) * 0x9e3779b1u + random->counter, random->key ^ 0x5bd1e995u));
}

/* Lanes m take the next particle of their row into account. */
FN void particles_take(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g, struct particle_query *q,
                       mv m, struct waves w, const struct random *random)
{
	iv class, n = q->n;
	struct vec to = sub(particle_at(t, m, n, &class), g->entry);
	fv depth = dot3(to, g->along);
	struct vec off = sub(to, scale(g->along, depth));    /* no cancellation of squares */
	fv d2 = dot3(off, off);
	SET(m, q->n, n + 1);
	m &= lt(d2, FV(v->query_radius2)) & lt(q->ahead, depth) & lt(depth, q->limit) & NOT(ieq(n, q->skip));
	fv toss = TRANSPORT_OF(v) == TRANSPORT_FAT_RAY ? coin(random, n) : FV(0.f);
	EACH_WAVE(j) {
		fv radius2 = of_class(s, v, t->disc_radius2, m, class, w, j);
		mv met = m;
		if (TRANSPORT_OF(v) == TRANSPORT_EXPLICIT) {
			met &= lt(d2, radius2);
		} else {
			fv p = hit_probability(v, radius2);
			SET(m & NOT(g->flight), q->through[j], q->through[j] * (1.f - p));
			met &= g->flight & lt(toss, p);
		}
		met &= lt(depth, q->depth[j]);
		SET(met, q->depth[j], depth);
		SET(met, q->id[j], n);
	}
}

/* Lanes that wait for the others to end a row, at most; none of one lane. */
#define ROW_WAIT (LANES / 2)

FN void particles_step(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g, struct particle_query *q,
                       struct waves w, const struct random *random)
{
	mv busy = g->going & ilt(q->n, q->to);
	int n = count(busy), least_busy = count(g->going) - ROW_WAIT;
	while (n > 0) {
		particles_take(s, v, t, g, q, busy, w, random);
		busy = g->going & ilt(q->n, q->to);
		n = count(busy);
		if (n < least_busy)
			break;
	}
	particles_row(s, v, t, g, q, g->going & NOT(busy));
}

FN void particles_transmittance(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g,
                                struct particle_query *q, mv m, struct waves w, fv *out)
{
	(void)s, (void)t, (void)g, (void)m, (void)w;
	EACH_WAVE(j)
		out[j] = TRANSPORT_OF(v) == TRANSPORT_EXPLICIT ? SEL(ieq(q->id[j], IV(NONE)), FV(1.f), FV(0.f)) : q->through[j];
}

FN struct collision particles_end(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g,
                                  struct particle_query *q, mv m, struct waves w, const struct random *random, fv *flight_pdf)
{
	struct collision c = { NO_LANE, g->entry, FV(0.f), IV(0), q->id[0], IV(0) };
	(void)random;
	EACH_WAVE(j)
		c.id = SEL(ieq(w.hero, IV(j)), q->id[j], c.id);
	c.happened = m & NOT(ieq(c.id, IV(NONE)));
	fv depth = hero_among(s, q->depth, w);
	c.point = add(g->entry, scale(g->along, depth));
	c.t = depth + g->t0;
	if (v->only_class >= 0)
		c.class = IV(v->only_class);
	else
		particle_at(t, c.happened, c.id, &c.class);
	EACH_WAVE(j)
		flight_pdf[j] = SEL(ieq(q->id[j], c.id), FV(1.f), FV(0.f));
	return c;
}

#endif

/* One build of the loops of Lorenz-Mie theory: compiled for each processor, with BUILD the name of what comes out, and LANES. */
#include "optics/mie/mie_lanes.h"

#define UNROLL 4
#include "optics/mie/mie_coefficients.h"

#include <math.h>
#include <string.h>

/* ------------------------------------------------------------------ sums */

/* Coefficients stand in the sums with the factor w = 2l+1. l, w, (l-1)(l+1)/l over w and the w before, (2l+1)/(l(l+1)) over w^2. */
enum { L, W, NEXT, CROSS, WEIGHTS };

INLINE void weights(double first, vec w[WEIGHTS])
{
	for (int i = 0; i < LANES; i++)
		LANE(&w[L], i) = first + i;
	vec l = w[L];
	w[W] = 2.0 * l + 1.0;
	w[NEXT] = (l - 1.0) * (l + 1.0) / (l * w[W] * (w[W] - 2.0));
	w[CROSS] = 1.0 / (l * (l + 1.0) * w[W]);
}

enum { EXT, SCA, ASYM, BACK_RE, BACK_IM, SUMS };

/* What an order adds, but for scattering; old: the order before. */
INLINE void addends(const vec w[WEIGHTS], const vec *a, const vec *b, const vec *old_a, const vec *old_b, vec t[SUMS])
{
	t[EXT] = a[0] + b[0];
	t[ASYM] = w[NEXT] * (old_a[0] * a[0] + old_a[1] * a[1] + old_b[0] * b[0] + old_b[1] * b[1]) +
	          w[CROSS] * (a[0] * b[0] + a[1] * b[1]);
	t[BACK_RE] = a[0] - b[0];
	t[BACK_IM] = a[1] - b[1];
}

/* ------------------------------------------------------------------ many spheres */

static int least_of(int a, int b) { return a < b ? a : b; }
static int most_of(int a, int b) { return a > b ? a : b; }

/* A vector of spheres: what does not change with the order, and what seldom does. */
struct vector {
	struct constants g;
	struct resonances resonances;
	double moved[LANES];       /* struct mie_sums */
};

struct many {
	struct upward k;
	vec sum[SUMS], old_a[2], old_b[2];
};

/* An order of a vector: coefficients, those of the order before, and sum[EXT] with it. */
struct order {
	vec a[2], b[2], old_a[2], old_b[2], chi_old, chi, share, ext;
};

/* What order l of those spheres may be off for which it counts. */
static void __attribute__((noinline)) on_resonance(struct vector *v, int l, const struct order *o)
{
	const struct constants *g = &v->g;
	truths counts = (o->share > v->resonances.from * o->ext) & (g->x <= (double)l) & (g->beyond > (double)l);
	for (int i = 0; i < LANES; i++) {
		if (!LANE(&counts, i))
			continue;
		struct mie_wave w = { l, { LANE(&o->a[0], i), LANE(&o->a[1], i) }, { LANE(&o->b[0], i), LANE(&o->b[1], i) },
			{ LANE(&o->old_a[0], i), LANE(&o->old_a[1], i) }, { LANE(&o->old_b[0], i), LANE(&o->old_b[1], i) },
			LANE(&o->chi_old, i), LANE(&o->chi, i) };
		v->moved[i] += mie_resonance(LANE(&g->x, i), CMPLX(LANE(&g->m_re, i), LANE(&g->m_im, i)), &w);
	}
}

/* Orders [from, to]. */
INLINE void orders(struct vector *v, struct many *many, const struct downward_orders *e, int u, const double *const w[WEIGHTS],
                   struct regime is, int from, int to)
{
	const int with_p = !is.absorb && !is.near;
	if (from > to)
		return;
	const struct constants g = v->g;
	struct many m = *many;
	const vec least = v->resonances.from * m.sum[EXT];    /* the sum grows: more than counts is looked at, none is missed */
	for (int l = from; l <= to; l++) {
		int i = l * UNROLL + u;
		struct downward f;
		struct coefficients_of_order own;
		vec t[SUMS], weight[WEIGHTS];
		for (int j = 0; j < WEIGHTS; j++)
			weight[j] = each(w[j][l]);
		if (is.near || is.from_x)
			f.ex = e->x[i];
		if (is.near || is.from_y)
			f.er = e->y_re[i];
		if (is.absorb && (is.near || is.from_y))
			f.ei = e->y_im[i];
		if (is.absorb && !is.near) {
			f.size = e->p.size[i];
			f.re = e->p.re[i];
			f.im = e->p.im[i];
		}
		upward_to(&m.k, &g, with_p, w[L][l], w[W][l - 1], is.from_x, is.from_x ? e->x[i - UNROLL] : each(0));
		coefficients_of(is, &g, weight[L], weight[W], &m.k, &f, &own);
		addends(weight, own.a, own.b, m.old_a, m.old_b, t);
		m.sum[EXT] += t[EXT];
		m.sum[ASYM] += t[ASYM];
		m.sum[BACK_RE] = t[BACK_RE] - m.sum[BACK_RE];
		m.sum[BACK_IM] = t[BACK_IM] - m.sum[BACK_IM];
		if (is.absorb)
			m.sum[SCA] += own.sca;
		if (is.narrow) {
			vec share = (is.absorb ? own.sca : t[EXT]) * own.chi2;
			if (__builtin_expect(any_above(share, least), 0)) {
				const struct order o = { { own.a[0], own.a[1] }, { own.b[0], own.b[1] }, { m.old_a[0], m.old_a[1] },
					{ m.old_b[0], m.old_b[1] }, m.k.chi_old, m.k.chi, share, m.sum[EXT] };
				on_resonance(v, l, &o);
			}
		}
		m.old_a[0] = own.a[0];
		m.old_a[1] = own.a[1];
		m.old_b[0] = own.b[0];
		m.old_b[1] = own.b[1];
	}
	*many = m;
}

INLINE void spheres(struct mie_block *b, int first, const double *const w[WEIGHTS], int absorb, int near)
{
	struct spheres s = { .most = 0, .absorb = absorb, .near = near };
	for (int i = 0; i < WIDTH; i++) {
		LANE(s.x, i) = b->x[first + i];
		LANE(s.m_re, i) = b->m_re[first + i];
		LANE(s.m_im, i) = absorb ? b->m_im[first + i] : 0;
		LANE(s.terms, i) = b->terms[first + i];
		s.most = b->terms[first + i] > s.most ? b->terms[first + i] : s.most;
	}
	struct downward_orders e = downward_all(&s, (vec *)b->room, NULL);
	for (int u = 0; u < UNROLL; u++) {
		struct vector v = { .g = constants_of(absorb, s.x[u], s.m_re[u], s.m_im[u], e.beyond[u], s.terms[u]) };
		v.resonances = resonances_of(absorb, &v.g);
		struct many m = { .k = upward_start(&v.g, !absorb && !near) };
		int x = e.from_x, y = near ? s.most + 1 : e.from_y, low = x < y ? x : y, high = x < y ? y : x, narrow = 0;
		for (int i = 0; i < LANES; i++) {
			double beyond = LANE(&v.g.beyond, i);
			if (LANE(&v.resonances.from, i) < INFINITY && beyond > narrow)
				narrow = beyond < s.most + 1 ? (int)beyond - 1 : s.most;
		}
		orders(&v, &m, &e, u, w, (struct regime){ absorb, near, 0, 0, 0 }, 1, low - 1);
		if (x < y) {
			orders(&v, &m, &e, u, w, (struct regime){ absorb, near, 1, 0, 1 }, low, least_of(narrow, high - 1));
			orders(&v, &m, &e, u, w, (struct regime){ absorb, near, 1, 0, 0 }, most_of(low, narrow + 1), high - 1);
		} else if (!near) {
			orders(&v, &m, &e, u, w, (struct regime){ absorb, near, 0, 1, 0 }, low, high - 1);
		}
		if (!near) {
			orders(&v, &m, &e, u, w, (struct regime){ absorb, near, 1, 1, 1 }, high, least_of(narrow, s.most));
			orders(&v, &m, &e, u, w, (struct regime){ absorb, near, 1, 1, 0 }, most_of(high, narrow + 1), s.most);
		}
		for (int i = 0; i < LANES; i++) {
			vec *q = m.sum;
			b->sums[first + u * LANES + i] = (struct mie_sums){ .ext = LANE(&q[EXT], i), .sca = LANE(&q[SCA], i),
				.asym = LANE(&q[ASYM], i), .back_re = LANE(&q[BACK_RE], i), .back_im = LANE(&q[BACK_IM], i), .moved = v.moved[i],
				.broad = LANE(&v.resonances.broad, i) };
		}
	}
}

static void block(struct mie_block *b)
{
	double *w[WEIGHTS];
	int most = 0;
	for (int i = 0; i < MIE_BLOCK; i++)
		most = b->terms[i] > most ? b->terms[i] : most;
	for (int j = 0; j < WEIGHTS; j++)
		w[j] = b->room + (6 * MIE_BLOCK + j) * ((size_t)most + 16);
	for (int l = 0; l <= most; l += LANES) {
		vec v[WEIGHTS];
		weights(l, v);
		for (int j = 0; j < WEIGHTS; j++)
			memcpy(w[j] + l, &v[j], sizeof(vec));
	}
	const double *const read[WEIGHTS] = { w[0], w[1], w[2], w[3] };
	for (int first = 0; first < MIE_BLOCK; first += WIDTH)
		if (b->near && b->absorbs)
			spheres(b, first, read, 1, 1);
		else if (b->near)
			spheres(b, first, read, 0, 1);
		else if (b->absorbs)
			spheres(b, first, read, 1, 0);
		else
			spheres(b, first, read, 0, 0);
}

/* ------------------------------------------------------------------ one sphere */

INLINE vec load(const double *p)
{
	vec v;
	memcpy(&v, p, sizeof v);
	return v;
}

INLINE void store(double *p, vec v) { memcpy(p, &v, sizeof v); }

INLINE void row(const struct mie_row *r, struct regime is)
{
	struct constants g = constants_of(is.absorb, each(r->x), each(r->m_re), each(r->m_im), each(r->beyond), each(INFINITY));
	const int weighted = r->weighted;
	for (int i = 0; i < r->count; i += LANES) {
		struct upward k = { .psi_old = load(r->psi + i), .psi = load(r->psi + i + 1),
			.chi_old = load(r->chi + i), .chi = load(r->chi + i + 1) };
		struct downward f;
		struct coefficients_of_order own;
		vec w[WEIGHTS];
		weights(r->first + i, w);
		if (!is.absorb && !is.near) {
			k.p_old = load(r->p + i);
			k.p = load(r->p + i + 1);
			k.below = k.p_old * g.inv_re;
		}
		if (is.near || is.from_x)
			f.ex = load(r->ex + i);
		if (is.near || is.from_y)
			f.er = load(r->er + i);
		if (is.absorb && (is.near || is.from_y))
			f.ei = load(r->ei + i);
		if (is.absorb && !is.near) {
			f.size = load(r->size + i);
			f.re = load(r->re + i);
			f.im = load(r->im + i);
		}
		coefficients_of(is, &g, w[L], weighted ? w[W] : each(1), &k, &f, &own);
		store(r->a_re + i, own.a[0]);
		store(r->a_im + i, own.a[1]);
		store(r->b_re + i, own.b[0]);
		store(r->b_im + i, own.b[1]);
		if (is.absorb)
			store(r->sca + i, own.sca);
	}
}

INLINE void row_of(const struct mie_row *r, int absorb, int near)
{
	int last = r->first + r->count - 1, from_x = r->x <= last, from_y = !near && r->beyond <= last;
	if (from_x && from_y)
		row(r, (struct regime){ absorb, near, 1, 1, 0 });
	else if (from_x)
		row(r, (struct regime){ absorb, near, 1, 0, 0 });
	else if (from_y)
		row(r, (struct regime){ absorb, near, 0, 1, 0 });
	else
		row(r, (struct regime){ absorb, near, 0, 0, 0 });
}

static void waves_of_one(const struct mie_row *r)
{
	if (r->near && r->absorbs)
		row_of(r, 1, 1);
	else if (r->near)
		row_of(r, 0, 1);
	else if (r->absorbs)
		row_of(r, 1, 0);
	else
		row_of(r, 0, 0);
}

/* What the order at i of a row may be off. */
static double resonance(const struct mie_row *r, int i)
{
	double l = r->first + i;
	struct mie_wave w = { .l = r->first + i, .a = { r->a_re[i], r->a_im[i] }, .b = { r->b_re[i], r->b_im[i] },
		.old_a = { r->a_re[i - 1], r->a_im[i - 1] }, .old_b = { r->b_re[i - 1], r->b_im[i - 1] },
		.chi_old = r->chi[i], .chi = r->chi[i + 1] };
	return l < r->x || l >= r->beyond ? 0 : mie_resonance(r->x, CMPLX(r->m_re, r->m_im), &w);
}

/* One order after the other, as in a block. */
INLINE struct mie_sums sum(const struct mie_row *r, double (*t)[MIE_CHUNK + MIE_SPARE], int absorbs, int narrow, double from,
                         struct mie_sums s)
{
	for (int i = 0; i < r->count; i++) {
		s.ext += t[EXT][i];
		s.asym += t[ASYM][i];
		s.back_re = t[BACK_RE][i] - s.back_re;
		s.back_im = t[BACK_IM][i] - s.back_im;
		if (absorbs)
			s.sca += r->sca[i];
		if (narrow && (absorbs ? r->sca[i] : t[EXT][i]) * (r->chi[i + 1] * r->chi[i + 1]) > from * s.ext)
			s.moved += resonance(r, i);
	}
	return s;
}

static void sums_of_one(const struct mie_row *r, struct mie_sums *sums)
{
	const struct constants g = constants_of(r->absorbs, each(r->x), each(r->m_re), each(r->m_im), each(r->beyond), each(INFINITY));
	const struct resonances resonances = resonances_of(r->absorbs, &g);
	double from = LANE(&resonances.from, 0);
	double t[SUMS][MIE_CHUNK + MIE_SPARE];
	for (int i = 0; i < r->count; i += LANES) {
		const vec old_a[2] = { load(r->a_re + i - 1), load(r->a_im + i - 1) };
		const vec old_b[2] = { load(r->b_re + i - 1), load(r->b_im + i - 1) };
		const vec a[2] = { load(r->a_re + i), load(r->a_im + i) }, b[2] = { load(r->b_re + i), load(r->b_im + i) };
		vec w[WEIGHTS], own[SUMS];
		weights(r->first + i, w);
		addends(w, a, b, old_a, old_b, own);
		store(&t[EXT][i], own[EXT]);
		store(&t[ASYM][i], own[ASYM]);
		store(&t[BACK_RE][i], own[BACK_RE]);
		store(&t[BACK_IM][i], own[BACK_IM]);
	}
	sums->broad = LANE(&resonances.broad, 0);
	int narrow = from < INFINITY && r->first + r->count > r->x && r->first < r->beyond;
	if (r->absorbs)
		*sums = narrow ? sum(r, t, 1, 1, from, *sums) : sum(r, t, 1, 0, 0, *sums);
	else
		*sums = narrow ? sum(r, t, 0, 1, from, *sums) : sum(r, t, 0, 0, 0, *sums);
}

/* ------------------------------------------------------------------ many angles */

/* pi_l is carried with the difference v_l = pi_l - pi_{l-1} (after Wiscombe 1979, with mu = 1 - c put in), so that c counts with all its
 * digits: v_{l+1} = ((l+1) v_l - (2l+1) c pi_l)/l, (pi_l + tau_l)/l = (l+1)/l v_l - c pi_l. Of unroll vectors of angles, sums from k[l][0]
 * on, and twice as many from there if both. */
INLINE void sum_waves(int both, int unroll, int n, const struct mie_factors *restrict k, int side, const double *c_, int first,
                      struct mie_angles *restrict a)
{
	vec c[UNROLL], p[UNROLL], v[UNROLL], sum[UNROLL][8];
	for (int u = 0; u < unroll; u++) {
		memcpy(&p[u], &a->pi[first + u * LANES], sizeof(vec));
		memcpy(&v[u], &a->rise[first + u * LANES], sizeof(vec));
		for (int i = 0; i < (both ? 8 : 4); i++)
			memcpy(&sum[u][i], &a->sum[i][first + u * LANES], sizeof(vec));
	}
	for (int i = 0; i < unroll * LANES; i++)
		LANE(c, i) = c_[first + i];
	for (int l = 0; l < n; l++) {
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
	for (int u = 0; u < unroll; u++) {
		memcpy(&a->pi[first + u * LANES], &p[u], sizeof(vec));
		memcpy(&a->rise[first + u * LANES], &v[u], sizeof(vec));
		for (int i = 0; i < (both ? 8 : 4); i++)
			memcpy(&a->sum[i][first + u * LANES], &sum[u][i], sizeof(vec));
	}
}

static void angles(int n, const struct mie_factors *k, int sides, const double *c, struct mie_angles *a)
{
	int both = sides == MIE_PAIR, width = LANES * (both ? UNROLL / 2 : UNROLL);
	for (int first = 0; first < MIE_ANGLES; first += width) {
		if (both)
			sum_waves(1, UNROLL / 2, n, k, 0, c, first, a);
		else
			sum_waves(0, UNROLL, n, k, sides == MIE_BEHIND, c, first, a);
	}
}

const struct mie_lanes BUILD = { block, waves_of_one, sums_of_one, angles };

/* mie_solve - the partial waves of WIDTH spheres side by side. Included with LANES and UNROLL set.
 *
 * Symbols. psi_l, chi_l, xi_l = psi_l - i chi_l Riccati-Bessel functions with psi_0 = sin, chi_0 = cos;
 * y = m x; E_l(z) = -psi_{l+1}(z)/psi_l(z), so that D_l(z) = psi_l'(z)/psi_l(z) = E_l(z) + (l+1)/z.
 *
 * With a_l = A/(A - iC), A = f psi_l - psi_{l-1}, C = f chi_l - chi_{l-1}, f = D_l(y)/m + l/x (m D_l(y) + l/x for b_l;
 * Bohren and Huffman 1983, eq 4.88), and the Wronskian psi_l chi_{l-1} - psi_{l-1} chi_l = -1,
 *
 *     a_l = (|A|^2 - Im f + i Re(A* C)) / (|A|^2 + |C|^2 - 2 Im f),    Im f <= 0.
 *
 * Every sum here but Re(A* C) has terms of one sign: extinction by a weak absorber is not lost, and Re a_l >= |a_l|^2 holds.
 *
 * Below |y|, f comes without a division from psi_l(y) itself: f = p_{l-1}/(m p_l) + l (1 - 1/m^2)/x, for b_l m p_{l-1}/p_l, with p any
 * multiple of psi(y). A .. D are computed times p_l, or times |p_l|^2 where y is complex, with Im(p_{l-1} p_l*) a sum of terms of one sign.
 * p ascends where y is real, and descends where it is not: upward it would drown in what grows with Im y.
 *
 * From |y| on, E in place of D removes the terms (l+1)/z which cancel in b_l where z is small, so that no separate series is needed there.
 *
 * Where m is near 1, A is small: f - psi_{l-1}/psi_l = d_l/m + E_l(x) (1/m - 1) + (l+1)/x (1/m^2 - 1), for b_l m d_l + E_l(x) (m - 1), with
 * d_l = E_l(y) - E_l(x) by its own recurrence d_{l-1} = [(2l+1)/y - (2l+1)/x + d_l] E_{l-1}(x) E_{l-1}(y), has the digits of m - 1. */
#ifndef OPTICS_MIE_SOLVE_H
#define OPTICS_MIE_SOLVE_H

#include "optics/numerics/lane_math.h"
#include "optics/numerics/vec_sincos.h"

#include <limits.h>
#include <math.h>
#include <stddef.h>

/* First order of the downward recurrence that leaves no trace at order n (rounding included) of its start with 0; even. With
 * l = |z| + t |z|^(1/3), psi_l/chi_l falls as e^(-1.89 t^(3/2)) beyond |z|; it must fall by 1e-17 from n on, and a few orders do where |z| is
 * small. Below |z|, where |E_l|^2 = 1 - 2 l Im z / |z|^2 and less, an absorbing sphere forgets the start earlier: where the product of these is e^-45. */
INLINE int ratio_downward_start(int n, double re, double im)
{
	double z = sqrt(re * re + im * im), edge = lane_cbrt(z), t = (n - z) / edge;
	double beyond = (n > z ? n : z) + 8 + (int)(edge * (t > 3 ? 14 / sqrt(t) : 8));
	double forgotten = im > 0 ? sqrt((double)n * n + 45 * z * z / im) + 8 : INFINITY;
	return (int)(forgotten < beyond ? forgotten : beyond) & ~1;
}

/* What descends by ratios: E_l(z), 1/z = inv, from order `top` (even) to `low`, stored for l <= n + 1. Before its own start, at orders
 * above it, a lane's is 0; least: of these starts. */
struct ratio_downward {
	int top, least, low, n;
	const vec *inv, *start;
	vec *e, v[UNROLL];
};

/* E_{l-1} = -1 / ((2l+1)/z + E_l), two orders to a division. Nothing where the descent is at its end. */
INLINE void ratio_downward_two(struct ratio_downward *f)
{
	int l = f->top, n = f->n;
	if (l < 2 || l <= f->low)
		return;
	double k1 = 2.0 * l + 1, k2 = 2.0 * l - 1;
	EACH(u) {
		/* where psi_{l-1} or psi_{l-2} passes a zero, the next step brings it back */
		vec t1 = not_zero(k1 * f->inv[u] + f->v[u]), t2 = not_zero(k2 * f->inv[u] * t1 - 1.0), r = 1.0 / (t1 * t2);
		vec e1 = -(t2 * r), e2 = -((t1 * t1) * r);
		if (l > f->least) {
			truths begun = (f->start[u] >= (double)l);
			e1 = PICK(begun, e1, each(0));
			e2 = PICK(begun, e2, each(0));
		}
		if (l - 1 <= n + 1)
			f->e[(l - 1) * UNROLL + u] = e1;
		if (l - 2 <= n + 1)
			f->e[(l - 2) * UNROLL + u] = e2;
		f->v[u] = e2;
	}
	f->top = l - 2;
}

INLINE void ratio_downward_to_end(struct ratio_downward *f)
{
	struct ratio_downward own = *f;
	while (own.top >= 2 && own.top > own.low)
		ratio_downward_two(&own);
	f->top = own.top;
}

/* The same for complex z, all of it; |t|^2 is kept off zero alike. Into at_r, at_i besides, E at a lane's own order `at`, none above
 * `most`; 0 where that is above its start. */
INLINE void ratio_downward_complex(int top, int least, int low, int n, const vec *inv_r, const vec *inv_i, const vec *start, vec *er, vec *ei,
                           int most, const vec *at, vec *at_r, vec *at_i)
{
	vec vr[UNROLL], vi[UNROLL];
	EACH(u)
		vr[u] = vi[u] = at_r[u] = at_i[u] = each(0);
	for (int l = top; l >= 2 && l > low; l -= 2) {
		double k1 = 2.0 * l + 1, k2 = 2.0 * l - 1;
		EACH(u) {
			vec pr = k1 * inv_r[u] + vr[u], pi = k1 * inv_i[u] + vi[u];
			vec kr = k2 * inv_r[u], ki = k2 * inv_i[u];
			vec qr = kr * pr - ki * pi - 1.0, qi = kr * pi + ki * pr;
			vec p2 = not_zero(pr * pr + pi * pi), q2 = not_zero(qr * qr + qi * qi), r = 1.0 / (p2 * q2), rp = r * q2, rq = r * p2;
			vec e1r = -(pr * rp), e1i = pi * rp;    /* -1/p, -p/q */
			vec e2r = -((pr * qr + pi * qi) * rq), e2i = -((pi * qr - pr * qi) * rq);
			if (l > least) {
				truths begun = (start[u] >= (double)l);
				e1r = PICK(begun, e1r, each(0));
				e1i = PICK(begun, e1i, each(0));
				e2r = PICK(begun, e2r, each(0));
				e2i = PICK(begun, e2i, each(0));
			}
			if (l - 2 <= most) {
				truths at1 = (at[u] == l - 1.0), at2 = (at[u] == l - 2.0);
				at_r[u] = PICK(at1, e1r, PICK(at2, e2r, at_r[u]));
				at_i[u] = PICK(at1, e1i, PICK(at2, e2i, at_i[u]));
			}
			if (l - 1 <= n + 1) {
				er[(l - 1) * UNROLL + u] = e1r;
				ei[(l - 1) * UNROLL + u] = e1i;
			}
			if (l - 2 <= n + 1) {
				er[(l - 2) * UNROLL + u] = e2r;
				ei[(l - 2) * UNROLL + u] = e2i;
			}
			vr[u] = e2r;
			vi[u] = e2i;
		}
	}
}

/* A power of 2 that brings a near 1; a = 0 stays. */
INLINE vec to_one(vec a)
{
	const int64_t exponent = (int64_t)2047 << 52, twice = (int64_t)2046 << 52;
	return of_bits(twice - (bits_of(a) & exponent));
}

/* Where p_l ~ psi_l(z) descends: 1/z; and the order at which a lane begins, with p = 1 and E given; most, least of these. */
struct psi_course {
	vec inv_r[UNROLL], inv_i[UNROLL], at[UNROLL], at_r[UNROLL], at_i[UNROLL];
	int most, least;
};

/* Where it is: p_l, p_{l+1}, (2l+1)/z, and re and im of p_l p_{l+1}*. */
struct psi_downward {
	vec vr[UNROLL], vi[UNROLL], tr[UNROLL], ti[UNROLL], kr[UNROLL], ki[UNROLL], re[UNROLL], im[UNROLL];
};

/* What is kept of it, order l at [(l - base) UNROLL], of orders to n: |p_l|^2, and re and im of p_{l-1} p_l*. */
struct psi_products {
	vec *size, *re, *im;
	int base, n;
};

INLINE void psi_downward_one(struct psi_downward *d, const struct psi_course *c, int l, const struct psi_products *t)
{
	EACH(u) {
		if (l >= c->least) {
			truths here = (c->at[u] == (double)l);
			d->vr[u] = PICK(here, each(1), d->vr[u]);
			d->vi[u] = PICK(here, each(0), d->vi[u]);
			d->tr[u] = PICK(here, -c->at_r[u], d->tr[u]);
			d->ti[u] = PICK(here, -c->at_i[u], d->ti[u]);
			d->re[u] = PICK(here, -c->at_r[u], d->re[u]);
			d->im[u] = PICK(here, c->at_i[u], d->im[u]);
		}
		vec kr = d->kr[u], ki = d->ki[u], vr = d->vr[u], vi = d->vi[u], v2 = vr * vr + vi * vi;
		vec ur = (kr * vr - d->tr[u]) - ki * vi, ui = (kr * vi - d->ti[u]) + ki * vr;
		d->re[u] = kr * v2 - d->re[u];
		d->im[u] += ki * v2;
		if (l <= t->n) {
			int i = (l - t->base) * UNROLL + u;
			t->size[i] = v2;
			t->re[i] = d->re[u];
			t->im[i] = d->im[u];
		}
		d->tr[u] = vr;
		d->ti[u] = vi;
		d->vr[u] = ur;
		d->vi[u] = ui;
	}
}

INLINE struct psi_downward psi_downward_start(void)
{
	struct psi_downward d;
	EACH(u)
		d.vr[u] = d.vi[u] = d.tr[u] = d.ti[u] = d.re[u] = d.im[u] = each(0);
	return d;
}

/* From order `top` to low + 1, both even. Scaling by powers of 2 changes no digit. One sphere's x, if given, falls meanwhile: neither waits
 * for the other. */
INLINE void psi_downward(struct psi_downward *state, const struct psi_course *c, int top, int low, const struct psi_products *t, struct ratio_downward *x)
{
	struct psi_downward d = *state;
	for (int l = top; l > low; l -= 2) {
		EACH(u) {
			d.kr[u] = (2.0 * l + 1) * c->inv_r[u];
			d.ki[u] = (2.0 * l + 1) * c->inv_i[u];
		}
		psi_downward_one(&d, c, l, t);
		EACH(u) {
			d.kr[u] = d.kr[u] - 2.0 * c->inv_r[u];
			d.ki[u] = d.ki[u] - 2.0 * c->inv_i[u];
		}
		psi_downward_one(&d, c, l - 1, t);
		EACH(u) {
			if (l % 8 == 0) {      /* |p| grows by no more than 9 an order, and 3 where it is kept */
				vec f = to_one(size_of(d.vr[u]) + size_of(d.vi[u]));
				d.vr[u] *= f;
				d.vi[u] *= f;
				d.tr[u] *= f;
				d.ti[u] *= f;
				d.re[u] = d.re[u] * f * f;
				d.im[u] = d.im[u] * f * f;
			}
		}
		if (WIDTH == 1 && x && l % 4 == 0)
			ratio_downward_two(x);
	}
	*state = d;
}

/* E_l(x), and d_l in place of E_l(y), for m near 1: inv is 1/x, rise 1/y - 1/x. */
INLINE void ratio_downward_near(int top, int least, int n, int absorb, const vec *inv, const vec *rise_r, const vec *rise_i, const vec *start,
                        vec *ex, vec *dr, vec *di)
{
	vec v[UNROLL], pr[UNROLL], pi[UNROLL];
	EACH(u)
		v[u] = pr[u] = pi[u] = each(0);
	for (int l = top; l >= 1; l--) {
		double k = 2.0 * l + 1;
		EACH(u) {
			vec t = not_zero(k * inv[u] + v[u]), nr = k * rise_r[u] + pr[u];
			if (absorb) {
				vec ni = k * rise_i[u] + pi[u], yr = t + nr, y2 = not_zero(yr * yr + ni * ni), r = 1.0 / (t * y2);
				v[u] = -(y2 * r);
				pr[u] = (nr * yr + ni * ni) * r;
				pi[u] = (ni * yr - nr * ni) * r;
			} else {
				vec y = not_zero(t + nr), r = 1.0 / (t * y);
				v[u] = -(y * r);
				pr[u] = nr * r;
			}
			if (l > least) {
				truths begun = (start[u] >= (double)l);
				v[u] = PICK(begun, v[u], each(0));
				pr[u] = PICK(begun, pr[u], each(0));
				pi[u] = PICK(begun, pi[u], each(0));
			}
			if (l - 1 > n)
				continue;
			ex[(l - 1) * UNROLL + u] = v[u];
			dr[(l - 1) * UNROLL + u] = pr[u];
			if (absorb)
				di[(l - 1) * UNROLL + u] = pi[u];
		}
	}
}

struct spheres {
	vec x[UNROLL], m_re[UNROLL], m_im[UNROLL];
	vec terms[UNROLL];         /* of each; its coefficients beyond count as 0 */
	int most, absorb, near;    /* the largest of terms; some Im m > 0; all |m - 1| < MIE_NEAR */
};

/* What descends, order l of vector u at [l * UNROLL + u]; and the first orders at which some sphere has l >= x, l >= |y|. */
struct downward_orders {
	vec *x, *y_re, *y_im;          /* E_l(x), l >= x - 1; E_l(y), l >= |y|; or, m near 1, E_l(x) and d_l of all orders */
	struct psi_products p;                /* l < |y|, absorbing spheres only */
	struct psi_course course;          /* of p */
	vec beyond[UNROLL];            /* |y|, rounded up */
	int from_x, from_y;
};

#define RATIOS 6                       /* arrays of most + 2 orders in these, or 3 with marks */

/* marks: NULL, or nothing is kept of p but marks[i], where it is at order i MIE_CHUNK, of those below most + MIE_CHUNK. */
INLINE struct downward_orders downward_all(const struct spheres *s, vec *room, struct psi_downward *marks)
{
	size_t rows = ((size_t)s->most + 2) * UNROLL;
	struct downward_orders e = { .x = room, .y_re = room + rows, .y_im = room + 2 * rows };
	struct psi_course *c = &e.course;
	vec inv_x[UNROLL], inv_re[UNROLL], inv_im[UNROLL], start_x[UNROLL], start_y[UNROLL];
	int top_x = 0, top_y = 0, low_x = INT_MAX, low_y = INT_MAX, n = s->most;
	c->most = 0;
	c->least = INT_MAX;
	e.from_x = e.from_y = n + 1;
	for (int i = 0; i < WIDTH; i++) {
		double x = LANE(s->x, i), re = LANE(s->m_re, i) * x, im = s->absorb ? LANE(s->m_im, i) * x : 0;
		double y = s->absorb ? sqrt(re * re + im * im) : re;
		int own = (int)LANE(s->terms, i), start = ratio_downward_start(own, x, 0), beyond = y < 2e9 ? (int)ceil(y) : INT_MAX - 1;
		LANE(start_x, i) = start;
		top_x = start > top_x ? start : top_x;
		low_x = start < low_x ? start : low_x;
		e.from_x = x < e.from_x ? (int)ceil(x) : e.from_x;
		if (s->absorb || s->near || beyond <= own) {
			int begin = ratio_downward_start(own, re, im), first = own < beyond || begin < beyond ? begin : beyond - 1;
			LANE(start_y, i) = begin;
			low_y = begin < low_y ? begin : low_y;
			LANE(c->at, i) = first;
			c->most = first > c->most ? first : c->most;
			c->least = first < c->least ? first : c->least;
			if (s->near || first < begin)
				top_y = begin > top_y ? begin : top_y;
		} else {
			LANE(start_y, i) = 0;
			LANE(c->at, i) = 0;
			low_y = 0;
		}
		LANE(e.beyond, i) = beyond;
		e.from_y = beyond < e.from_y ? beyond : e.from_y;
	}
	EACH(u) {
		inv_x[u] = 1.0 / s->x[u];
		if (s->absorb) {
			vec yr = s->m_re[u] * s->x[u], yi = s->m_im[u] * s->x[u], r = 1.0 / (yr * yr + yi * yi);
			inv_re[u] = yr * r;
			inv_im[u] = -(yi * r);
		} else {
			inv_re[u] = 1.0 / (s->m_re[u] * s->x[u]);
			inv_im[u] = each(0);
		}
	}
	if (s->near) {
		EACH(u) {          /* 1/y - 1/x = (1/m - 1)/x */
			vec re = s->m_re[u], im = s->absorb ? s->m_im[u] : each(0), m2 = re * re + im * im;
			inv_re[u] = (re * (1.0 - re) - im * im) / m2 * inv_x[u];
			inv_im[u] = -(im / m2 * inv_x[u]);
			start_y[u] = larger(start_x[u], start_y[u]);
		}
		ratio_downward_near(top_x > top_y ? top_x : top_y, low_x > low_y ? low_x : low_y, n, s->absorb, inv_x, inv_re, inv_im, start_y,
		            e.x, e.y_re, e.y_im);
		return e;
	}
	struct ratio_downward x = { .top = top_x, .least = low_x, .low = e.from_x - 1, .n = n, .inv = inv_x, .start = start_x, .e = e.x };
	struct ratio_downward y = { .top = top_y, .least = low_y, .low = e.from_y - 1, .n = n, .inv = inv_re, .start = start_y, .e = e.y_re };
	EACH(u)
		x.v[u] = y.v[u] = each(0);
	if (s->absorb) {
		EACH(u) {
			c->inv_r[u] = inv_re[u];
			c->inv_i[u] = inv_im[u];
		}
		ratio_downward_complex(top_y, low_y, c->least, n, inv_re, inv_im, start_y, e.y_re, e.y_im, c->most, c->at, c->at_r, c->at_i);
		struct psi_downward d = psi_downward_start();
		int l = (c->most + 1) & ~1;
		if (!marks) {
			e.p = (struct psi_products){ room + 3 * rows, room + 4 * rows, room + 5 * rows, 0, n };
			psi_downward(&d, c, l, 0, &e.p, &x);
		}
		for (int low; marks && l > MIE_CHUNK; l = low) {
			low = (l - 1) / MIE_CHUNK * MIE_CHUNK;
			psi_downward(&d, c, l, low, &(struct psi_products){ .n = 0 }, &x);
			if (low < n + MIE_CHUNK)
				marks[low / MIE_CHUNK] = d;
		}
	} else {
		for (; WIDTH == 1 && y.top > y.low && x.top > x.low; ratio_downward_two(&y))
			ratio_downward_two(&x);
		ratio_downward_to_end(&y);
	}
	ratio_downward_to_end(&x);
	return e;
}

/* ------------------------------------------------------------------ upward */

#define CHI_MAX 1e120    /* beyond, a_l and b_l are below 1e-240 and chi^2 would overflow */

/* What does not change with the order, of a vector of spheres. */
struct constants {
	vec x, beyond, terms, inv_x, m_re, m_im;
	vec inv_re, inv_im, norm, less;      /* 1/m, |m|^2, Re 1/m - 1 */
	vec c_re, c_im;                      /* (1 - 1/m^2)/x */
	vec cm_re, cm_im;                    /* |m|^2 times that */
};

INLINE struct constants constants_of(int absorb, vec x, vec m_re, vec m_im, vec beyond, vec terms)
{
	struct constants g = { .x = x, .beyond = beyond, .terms = terms, .inv_x = 1.0 / x, .m_re = m_re, .m_im = m_im };
	if (absorb) {
		vec m2 = m_re * m_re + m_im * m_im, vr = m_re / m2, vi = -(m_im / m2), v2r = vr * vr - vi * vi, v2i = 2.0 * (vr * vi);
		g.inv_re = vr;
		g.inv_im = vi;
		g.norm = m2;
		g.c_re = (((m_re - 1.0) * (m_re + 1.0) - m_im * m_im) * v2r - 2.0 * (m_re * m_im) * v2i) * g.inv_x;    /* (m^2 - 1)/m^2 */
		g.c_im = -v2i * g.inv_x;
		g.cm_re = g.c_re * m2;
		g.cm_im = g.c_im * m2;
		g.less = (m_re * (1.0 - m_re) - m_im * m_im) / m2;
	} else {
		g.inv_re = 1.0 / m_re;
		g.inv_im = g.c_im = g.cm_re = g.cm_im = g.norm = each(0);
		g.c_re = (m_re - 1.0) * (m_re + 1.0) * (g.inv_re * g.inv_re) * g.inv_x;
		g.less = (1.0 - m_re) * g.inv_re;
	}
	return g;
}

/* Riccati-Bessel functions of two neighbouring orders, old is l - 1; p, of y, where it ascends, and p_{l-1}/m. */
struct upward {
	vec psi_old, psi, chi_old, chi, p_old, p, below;
};

/* Order 0; p from sin y where it ascends. */
INLINE struct upward upward_start(const struct constants *g, int with_p)
{
	struct upward k;
	vec_sincos(g->x, &k.psi, &k.psi_old);
	k.chi_old = -k.psi;
	k.chi = k.psi_old;
	k.p = k.p_old = k.below = each(0);
	if (with_p)
		vec_sincos(g->m_re * g->x, &k.p, &k.p_old);
	return k;
}

/* A step to order l. psi upward while l < x, by ratios beyond (upward it would be lost there; ratios fail where psi passes a zero); chi
 * upward. odd: 2 l - 1; ratio: E_{l-1}(x); from_x: some sphere has l >= x. */
INLINE void upward_to(struct upward *k, const struct constants *g, int with_p, double l, double odd, int from_x, vec ratio)
{
	vec w = odd * g->inv_x, psi = w * k->psi - k->psi_old, chi = w * k->chi - k->chi_old;
	if (from_x)
		psi = PICK((g->x > l), psi, -(ratio * k->psi));
	k->psi_old = k->psi;
	k->psi = psi;
	k->chi_old = k->chi;
	k->chi = chi;
	if (with_p) {
		vec below = k->p * g->inv_re, p = w * below - k->p_old;
		k->below = below;
		k->p_old = k->p;
		k->p = p;
	}
}

/* What descended to an order, of a vector: as in struct downward_orders. */
struct downward {
	vec ex, er, ei, size, re, im;
};

/* a_l, b_l times `weight`: a[0] real part, a[1] imaginary part; and weight (|a_l|^2 + |b_l|^2), absorbing spheres only. absorb, near: as of
 * spheres; from_x, from_y: some has l >= x, l >= |y|. */
INLINE void coefficients_of(int absorb, int near, int from_x, int from_y, const struct constants *g, vec l, vec weight, const struct upward *k,
                     const struct downward *e, vec *a, vec *b, vec *sca)
{
	vec psi = k->psi, chi = k->chi, mr = g->m_re, mi = g->m_im;
	vec far, fai = each(0), fbr, fbi = each(0), sa, sb;                   /* f_a times sa, f_b times sb */
	vec ear = each(0), eai = each(0), ebr = each(0), ebi = each(0);    /* f_a, f_b less t = (2l+1)/x, from E */
	vec t = (2.0 * l + 1.0) * g->inv_x;
	truths beyond = (g->beyond <= l), outside = (g->x <= l);
	if (near || from_y) {
		vec er = near ? e->er + e->ex : e->er, ei = e->ei;
		ear = er * g->inv_re - (l + 1.0) * g->c_re;
		ebr = er * mr;
		if (absorb) {
			ear = ear - ei * g->inv_im;
			eai = er * g->inv_im + ei * g->inv_re - (l + 1.0) * g->c_im;
			ebr = ebr - ei * mi;
			ebi = er * mi + ei * mr;
		}
	}
	if (near) {
		sa = sb = each(1);
		far = ear + t;
		fai = eai;
		fbr = ebr + t;
		fbi = ebi;
	} else if (absorb) {           /* 1/m = m* / |m|^2 */
		vec rr = e->re * mr, ii = e->im * mi, ri = e->re * mi, ir = e->im * mr, size = l * e->size;
		sa = e->size * g->norm;
		sb = e->size;
		far = rr + ii + size * g->cm_re;
		fai = ir - ri + size * g->cm_im;
		fbr = rr - ii;
		fbi = ri + ir;
	} else {
		sa = sb = k->p;
		far = k->below + l * g->c_re * k->p;
		fbr = k->p_old * mr;
	}
	if (!near && from_y) {
		far = PICK(beyond, ear + t, far);
		fai = PICK(beyond, eai, fai);
		fbr = PICK(beyond, ebr + t, fbr);
		fbi = PICK(beyond, ebi, fbi);
		sa = PICK(beyond, each(1), sa);
		sb = PICK(beyond, each(1), sb);
	}
	vec A, B, C, D, r, ra, rb;
	if (absorb && !near) {
		A = far * psi - sa * k->psi_old;
		B = fbr * psi - sb * k->psi_old;
		C = far * chi - sa * k->chi_old;
		D = fbr * chi - sb * k->chi_old;
	} else {
		vec psi_old = near ? k->psi_old : sb * k->psi_old, chi_old = near ? k->chi_old : sb * k->chi_old;
		A = far * psi - psi_old;
		B = fbr * psi - psi_old;
		C = far * chi - chi_old;
		D = fbr * chi - chi_old;
	}
	if (near) {                /* but within x only where the error of psi does not count for more */
		vec p = e->er * g->inv_re + e->ex * g->less - (l + 1.0) * g->c_re, q = e->er * mr + e->ex * (mr - 1.0);
		if (absorb) {
			p = p - e->ei * g->inv_im;
			q = q - e->ei * mi;
		}
		A = PICK(outside | ((p < 1.0) & (p > -1.0)), p * psi, A);
		B = PICK(outside | ((q < 1.0) & (q > -1.0)), q * psi, B);
	} else if (from_x && from_y) {    /* beyond both with psi_{l-1}/psi_l = E_l(x) + (2l+1)/x taken off by hand */
		A = PICK(outside & beyond, (ear - e->ex) * psi, A);
		B = PICK(outside & beyond, (ebr - e->ex) * psi, B);
	}
	if (absorb) {
		vec Ai = fai * psi, Bi = fbi * psi, Ci = fai * chi, Di = fbi * chi, fa = sa * fai, fb = sb * fbi;
		vec a2 = A * A + Ai * Ai, b2 = B * B + Bi * Bi, aa = a2 - fa, bb = b2 - fb;
		vec na = aa + (C * C + Ci * Ci - fa), nb = bb + (D * D + Di * Di - fb);
		r = weight / (na * nb);
		ra = r * nb;
		rb = r * na;
		a[0] = aa * ra;
		a[1] = (A * C + Ai * Ci) * ra;
		b[0] = bb * rb;
		b[1] = (B * D + Bi * Di) * rb;
		*sca = a2 * ra + b2 * rb;
	} else {
		vec a2 = A * A, b2 = B * B, na = a2 + C * C, nb = b2 + D * D;
		r = weight / (na * nb);
		ra = r * nb;
		rb = r * na;
		a[0] = a2 * ra;
		a[1] = A * C * ra;
		b[0] = b2 * rb;
		b[1] = B * D * rb;
	}
	if (!from_x)
		return;
	truths good = (g->terms >= l) & (chi <= CHI_MAX) & (chi >= -CHI_MAX);
	for (int c = 0; c < 2; c++) {
		a[c] = PICK(good, a[c], each(0));
		b[c] = PICK(good, b[c], each(0));
	}
	if (absorb)
		*sca = PICK(good, *sca, each(0));
}

#endif

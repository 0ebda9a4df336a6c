/* mie_downward - what Lorenz-Mie theory has by downward recurrence, of WIDTH spheres side by side. Included with LANES and UNROLL set.
 *
 * Upward, psi_l(z) would be lost where l > |z|, and at any order for complex z. Its ratios E_l(z) = -psi_{l+1}(z)/psi_l(z) come down,
 * two to a division, from 0 at an order high enough, to |z|. Below, where they come near poles, an absorbing sphere goes on with p_l, a
 * multiple of psi_l(y), which needs no division. For m near 1, d_l = E_l(y) - E_l(x) comes down beside E_l(x).
 * Source: Gautschi 1967, SIAM Review 9, 24, on minimal solutions. Symbols as in mie_coefficients.h. */
#ifndef OPTICS_MIE_DOWNWARD_H
#define OPTICS_MIE_DOWNWARD_H

#include "optics/mie/mie_lanes.h"
#include "optics/numerics/lane_math.h"
#include "optics/numerics/vec.h"

#include <limits.h>
#include <math.h>
#include <stddef.h>

/* The order, even, at which E_l(z) may begin with 0 so that no trace of that is left at order n. Beyond |z|, at l = |z| + t |z|^(1/3),
 * psi_l/chi_l falls as e^(-1.89 t^(3/2)): so far that it falls by 1e-17 from n on, and a few orders more for small |z|. Below |z|, where
 * |E_l|^2 is 1 - 2 l Im z / |z|^2 at most, absorption forgets the start earlier: where the product of these is e^-45. */
INLINE int ratio_downward_start(int n, double re, double im)
{
	double z = sqrt(re * re + im * im), edge = lane_cbrt(z), t = (n - z) / edge;
	double beyond = (n > z ? n : z) + 8 + (int)(edge * (t > 3 ? 14 / sqrt(t) : 8));
	double forgotten = im > 0 ? sqrt((double)n * n + 45 * z * z / im) + 8 : INFINITY;
	return (int)(forgotten < beyond ? forgotten : beyond) & ~1;
}

/* E_l(z), 1/z = inv, from order `top` (even) down to `low`, stored for l <= n + 1. At orders above its own start a lane has 0; least:
 * the least of these starts. */
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
INLINE void ratio_downward_complex(int top, int least, int low, int n, const vec *inv_r, const vec *inv_i, const vec *start,
                                   vec *er, vec *ei, int most, const vec *at, vec *at_r, vec *at_i)
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

/* The course of p_l ~ psi_l(z): 1/z; the order `at' where a lane begins, with p = 1 and E given; most, least of these. */
struct psi_course {
	vec inv_r[UNROLL], inv_i[UNROLL], at[UNROLL], at_r[UNROLL], at_i[UNROLL];
	int most, least;
};

/* The state at an order: p_l, p_{l+1}, (2l+1)/z, and re and im of p_l p_{l+1}*. */
struct psi_downward {
	vec vr[UNROLL], vi[UNROLL], tr[UNROLL], ti[UNROLL], kr[UNROLL], ki[UNROLL], re[UNROLL], im[UNROLL];
};

/* What is kept of orders up to n, order l at [(l - base) UNROLL]: |p_l|^2, and re and im of p_{l-1} p_l*. */
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

/* From order `top` to low + 1, both even. Scaling by powers of 2 changes no digit. The ratios of a sphere that is alone, if given, go
 * down meanwhile: so neither waits for the other. */
INLINE void psi_downward(struct psi_downward *state, const struct psi_course *c, int top, int low, const struct psi_products *t,
                         struct ratio_downward *x)
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
INLINE void ratio_downward_near(int top, int least, int n, int absorb, const vec *inv, const vec *rise_r, const vec *rise_i,
                                const vec *start, vec *ex, vec *dr, vec *di)
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

/* All that comes downward, order l of vector u at [l * UNROLL + u]; and the first orders at which some sphere has l >= x, l >= |y|. */
struct downward_orders {
	vec *x, *y_re, *y_im;          /* E_l(x), l >= x - 1; E_l(y), l >= |y|; or, m near 1, E_l(x) and d_l of all orders */
	struct psi_products p;         /* l < |y|, absorbing spheres only */
	struct psi_course course;      /* of p */
	vec beyond[UNROLL];            /* |y|, rounded up */
	int from_x, from_y;
};

#define DOWNWARD_ARRAYS 6              /* of most + 2 orders in these, or 3 with marks */

/* Where a lane's ratios begin, and the highest and lowest of these orders; y: 0 where a sphere needs none. */
struct downward_starts {
	vec x[UNROLL], y[UNROLL];
	int top_x, top_y, low_x, low_y;
};

/* Into *e where |x|, |y| are passed, and where p begins. */
INLINE struct downward_starts downward_starts(const struct spheres *s, struct downward_orders *e)
{
	struct downward_starts d = { .low_x = INT_MAX, .low_y = INT_MAX };
	struct psi_course *c = &e->course;
	c->most = 0;
	c->least = INT_MAX;
	e->from_x = e->from_y = s->most + 1;
	for (int i = 0; i < WIDTH; i++) {
		double x = LANE(s->x, i), re = LANE(s->m_re, i) * x, im = s->absorb ? LANE(s->m_im, i) * x : 0;
		double y = s->absorb ? sqrt(re * re + im * im) : re;
		int own = (int)LANE(s->terms, i), start = ratio_downward_start(own, x, 0), beyond = y < 2e9 ? (int)ceil(y) : INT_MAX - 1;
		LANE(d.x, i) = start;
		d.top_x = start > d.top_x ? start : d.top_x;
		d.low_x = start < d.low_x ? start : d.low_x;
		e->from_x = x < e->from_x ? (int)ceil(x) : e->from_x;
		if (s->absorb || s->near || beyond <= own) {
			int begin = ratio_downward_start(own, re, im), first = own < beyond || begin < beyond ? begin : beyond - 1;
			LANE(d.y, i) = begin;
			d.low_y = begin < d.low_y ? begin : d.low_y;
			LANE(c->at, i) = first;
			c->most = first > c->most ? first : c->most;
			c->least = first < c->least ? first : c->least;
			if (s->near || first < begin)
				d.top_y = begin > d.top_y ? begin : d.top_y;
		} else {
			LANE(d.y, i) = 0;
			LANE(c->at, i) = 0;
			d.low_y = 0;
		}
		LANE(e->beyond, i) = beyond;
		e->from_y = beyond < e->from_y ? beyond : e->from_y;
	}
	return d;
}

/* 1/x, 1/y; or, for m near 1, 1/y - 1/x = (1/m - 1)/x in place of the latter. */
INLINE void downward_inverses(const struct spheres *s, vec *inv_x, vec *inv_re, vec *inv_im)
{
	EACH(u) {
		inv_x[u] = 1.0 / s->x[u];
		if (s->near) {
			vec re = s->m_re[u], im = s->absorb ? s->m_im[u] : each(0), m2 = re * re + im * im;
			inv_re[u] = (re * (1.0 - re) - im * im) / m2 * inv_x[u];
			inv_im[u] = -(im / m2 * inv_x[u]);
		} else if (s->absorb) {
			vec yr = s->m_re[u] * s->x[u], yi = s->m_im[u] * s->x[u], r = 1.0 / (yr * yr + yi * yi);
			inv_re[u] = yr * r;
			inv_im[u] = -(yi * r);
		} else {
			inv_re[u] = 1.0 / (s->m_re[u] * s->x[u]);
			inv_im[u] = each(0);
		}
	}
}

/* p of all orders into e->p; or, with marks, nothing but the state at order i MIE_CHUNK into marks[i], of those below most + MIE_CHUNK.
 * The ratios of x go down meanwhile. */
INLINE void downward_p(struct downward_orders *e, int n, vec *room, size_t rows, struct psi_downward *marks, struct ratio_downward *x)
{
	struct psi_downward d = psi_downward_start();
	const struct psi_course *c = &e->course;
	int l = (c->most + 1) & ~1;
	if (!marks) {
		e->p = (struct psi_products){ .size = room, .re = room + rows, .im = room + 2 * rows, .base = 0, .n = n };
		psi_downward(&d, c, l, 0, &e->p, x);
	}
	for (int low; marks && l > MIE_CHUNK; l = low) {
		low = (l - 1) / MIE_CHUNK * MIE_CHUNK;
		psi_downward(&d, c, l, low, &(struct psi_products){ .n = 0 }, x);
		if (low < n + MIE_CHUNK)
			marks[low / MIE_CHUNK] = d;
	}
}

/* In room, DOWNWARD_ARRAYS of s->most + 2 orders; marks: NULL, or as of downward_p. */
INLINE struct downward_orders downward_all(const struct spheres *s, vec *room, struct psi_downward *marks)
{
	size_t rows = ((size_t)s->most + 2) * UNROLL;
	struct downward_orders e = { .x = room, .y_re = room + rows, .y_im = room + 2 * rows };
	struct psi_course *c = &e.course;
	struct downward_starts d = downward_starts(s, &e);
	vec inv_x[UNROLL], inv_re[UNROLL], inv_im[UNROLL];
	int n = s->most;
	downward_inverses(s, inv_x, inv_re, inv_im);
	if (s->near) {
		EACH(u)
			d.y[u] = larger(d.x[u], d.y[u]);
		ratio_downward_near(d.top_x > d.top_y ? d.top_x : d.top_y, d.low_x > d.low_y ? d.low_x : d.low_y, n, s->absorb,
		                    inv_x, inv_re, inv_im, d.y, e.x, e.y_re, e.y_im);
		return e;
	}
	struct ratio_downward x = { .top = d.top_x, .least = d.low_x, .low = e.from_x - 1, .n = n, .inv = inv_x, .start = d.x, .e = e.x };
	struct ratio_downward y = { .top = d.top_y, .least = d.low_y, .low = e.from_y - 1, .n = n, .inv = inv_re, .start = d.y,
		.e = e.y_re };
	EACH(u)
		x.v[u] = y.v[u] = each(0);
	if (s->absorb) {
		EACH(u) {
			c->inv_r[u] = inv_re[u];
			c->inv_i[u] = inv_im[u];
		}
		ratio_downward_complex(d.top_y, d.low_y, c->least, n, inv_re, inv_im, d.y, e.y_re, e.y_im, c->most, c->at, c->at_r, c->at_i);
		downward_p(&e, n, room + 3 * rows, rows, marks, &x);
	} else {
		for (; WIDTH == 1 && y.top > y.low && x.top > x.low; ratio_downward_two(&y))
			ratio_downward_two(&x);
		ratio_downward_to_end(&y);
	}
	ratio_downward_to_end(&x);
	return e;
}

#endif

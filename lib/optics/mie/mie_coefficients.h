/* mie_coefficients - a_l and b_l of spheres or of orders side by side, from what goes downward and upward. Included with LANES and UNROLL
 * set.
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
 * Where m is near 1, A is small: f - psi_{l-1}/psi_l = d_l/m + E_l(x) (1/m - 1) + (l+1)/x (1/m^2 - 1), for b_l m d_l + E_l(x)
 * (m - 1), with d_l = E_l(y) - E_l(x) by its own recurrence d_{l-1} = [(2l+1)/y - (2l+1)/x + d_l] E_{l-1}(x) E_{l-1}(y), has
 * the digits of m - 1. */
#ifndef OPTICS_MIE_COEFFICIENTS_H
#define OPTICS_MIE_COEFFICIENTS_H

#include "optics/mie/mie_downward.h"
#include "optics/mie/mie_upward.h"

/* What came downward to an order, of a vector: as in struct downward_orders. */
struct downward {
	vec ex, er, ei, size, re, im;
};

/* What is known of a vector's spheres, at the orders at hand, when this is compiled: absorb, near as of struct spheres; some has l >= x,
 * l >= |y|; some may have a narrow resonance. */
struct regime {
	int absorb, near, from_x, from_y, narrow;
};

/* f of a_l and b_l, less (2l+1)/x, from E. */
struct excess {
	vec a_re, a_im, b_re, b_im;
};

INLINE struct excess excess_of(struct regime is, const struct constants *g, vec l, const struct downward *e)
{
	struct excess f;
	vec er = is.near ? e->er + e->ex : e->er, ei = e->ei, mr = g->m_re, mi = g->m_im;
	f.a_im = f.b_im = each(0);
	f.a_re = er * g->inv_re - (l + 1.0) * g->c_re;
	f.b_re = er * mr;
	if (is.absorb) {
		f.a_re = f.a_re - ei * g->inv_im;
		f.a_im = er * g->inv_im + ei * g->inv_re - (l + 1.0) * g->c_im;
		f.b_re = f.b_re - ei * mi;
		f.b_im = er * mi + ei * mr;
	}
	return f;
}

/* f of a_l and b_l, times scales without phase. */
struct scaled {
	vec a_re, a_im, b_re, b_im, a_scale, b_scale;
};

/* From p within |y|, from E beyond, or of all orders where m is near 1. */
INLINE struct scaled scaled_of(struct regime is, const struct constants *g, vec l, const struct upward *k, const struct downward *e,
                               const struct excess *more)
{
	struct scaled f;
	vec t = (2.0 * l + 1.0) * g->inv_x, mr = g->m_re, mi = g->m_im;
	f.a_im = f.b_im = each(0);
	if (is.near) {
		f.a_scale = f.b_scale = each(1);
		f.a_re = more->a_re + t;
		f.a_im = more->a_im;
		f.b_re = more->b_re + t;
		f.b_im = more->b_im;
		return f;
	}
	if (is.absorb) {           /* 1/m = m* / |m|^2 */
		vec rr = e->re * mr, ii = e->im * mi, ri = e->re * mi, ir = e->im * mr, size = l * e->size;
		f.a_scale = e->size * g->norm;
		f.b_scale = e->size;
		f.a_re = rr + ii + size * g->cm_re;
		f.a_im = ir - ri + size * g->cm_im;
		f.b_re = rr - ii;
		f.b_im = ri + ir;
	} else {
		f.a_scale = f.b_scale = k->p;
		f.a_re = k->below + l * g->c_re * k->p;
		f.b_re = k->p_old * mr;
	}
	if (is.from_y) {
		truths beyond = (g->beyond <= l);
		f.a_re = PICK(beyond, more->a_re + t, f.a_re);
		f.a_im = PICK(beyond, more->a_im, f.a_im);
		f.b_re = PICK(beyond, more->b_re + t, f.b_re);
		f.b_im = PICK(beyond, more->b_im, f.b_im);
		f.a_scale = PICK(beyond, each(1), f.a_scale);
		f.b_scale = PICK(beyond, each(1), f.b_scale);
	}
	return f;
}

/* Real parts of A and C of a_l, and of those of b_l, named B and D; as scaled. */
struct parts {
	vec a, c, b, d;
};

INLINE struct parts parts_of(struct regime is, const struct constants *g, vec l, const struct upward *k, const struct downward *e,
                             const struct excess *more, const struct scaled *f)
{
	struct parts p;
	vec psi = k->psi, chi = k->chi;
	truths outside = (g->x <= l), beyond = (g->beyond <= l);
	if (is.absorb && !is.near) {
		p.a = f->a_re * psi - f->a_scale * k->psi_old;
		p.b = f->b_re * psi - f->b_scale * k->psi_old;
		p.c = f->a_re * chi - f->a_scale * k->chi_old;
		p.d = f->b_re * chi - f->b_scale * k->chi_old;
	} else {
		vec psi_old = is.near ? k->psi_old : f->b_scale * k->psi_old, chi_old = is.near ? k->chi_old : f->b_scale * k->chi_old;
		p.a = f->a_re * psi - psi_old;
		p.b = f->b_re * psi - psi_old;
		p.c = f->a_re * chi - chi_old;
		p.d = f->b_re * chi - chi_old;
	}
	if (is.near) {                /* by differences; but within x only where the error of psi does not count for more */
		vec a = e->er * g->inv_re + e->ex * g->less - (l + 1.0) * g->c_re, b = e->er * g->m_re + e->ex * (g->m_re - 1.0);
		if (is.absorb) {
			a = a - e->ei * g->inv_im;
			b = b - e->ei * g->m_im;
		}
		p.a = PICK(outside | ((a < 1.0) & (a > -1.0)), a * psi, p.a);
		p.b = PICK(outside | ((b < 1.0) & (b > -1.0)), b * psi, p.b);
	} else if (is.from_x && is.from_y) {    /* beyond both with psi_{l-1}/psi_l = E_l(x) + (2l+1)/x taken off by hand */
		p.a = PICK(outside & beyond, (more->a_re - e->ex) * psi, p.a);
		p.b = PICK(outside & beyond, (more->b_re - e->ex) * psi, p.b);
	}
	return p;
}

/* a_l, b_l times a weight: [0] real part, [1] imaginary part; sca: weight (|a_l|^2 + |b_l|^2), absorbing spheres only; chi2:
 * chi_l^2, where some l >= x. */
struct coefficients_of_order {
	vec a[2], b[2], sca, chi2;
};

INLINE void coefficients_of(struct regime is, const struct constants *g, vec l, vec weight, const struct upward *k,
                            const struct downward *e, struct coefficients_of_order *out)
{
	struct excess more;
	if (is.near || is.from_y)
		more = excess_of(is, g, l, e);
	struct scaled f = scaled_of(is, g, l, k, e, &more);
	struct parts p = parts_of(is, g, l, k, e, &more, &f);
	vec r, ra, rb;
	if (is.absorb) {
		vec Ai = f.a_im * k->psi, Bi = f.b_im * k->psi, Ci = f.a_im * k->chi, Di = f.b_im * k->chi;
		vec fa = f.a_scale * f.a_im, fb = f.b_scale * f.b_im;
		vec a2 = p.a * p.a + Ai * Ai, b2 = p.b * p.b + Bi * Bi, aa = a2 - fa, bb = b2 - fb;
		vec na = aa + (p.c * p.c + Ci * Ci - fa), nb = bb + (p.d * p.d + Di * Di - fb);
		r = weight / (na * nb);
		ra = r * nb;
		rb = r * na;
		out->a[0] = aa * ra;
		out->a[1] = (p.a * p.c + Ai * Ci) * ra;
		out->b[0] = bb * rb;
		out->b[1] = (p.b * p.d + Bi * Di) * rb;
		out->sca = a2 * ra + b2 * rb;
	} else {
		vec a2 = p.a * p.a, b2 = p.b * p.b, na = a2 + p.c * p.c, nb = b2 + p.d * p.d;
		r = weight / (na * nb);
		ra = r * nb;
		rb = r * na;
		out->a[0] = a2 * ra;
		out->a[1] = p.a * p.c * ra;
		out->b[0] = b2 * rb;
		out->b[1] = p.b * p.d * rb;
	}
	if (!is.from_x)
		return;
	out->chi2 = k->chi * k->chi;
	truths good = (g->terms >= l) & (out->chi2 <= CHI_MAX * CHI_MAX);
	out->a[0] = PICK(good, out->a[0], each(0));
	out->a[1] = PICK(good, out->a[1], each(0));
	out->b[0] = PICK(good, out->b[0], each(0));
	out->b[1] = PICK(good, out->b[1], each(0));
	if (is.absorb)
		out->sca = PICK(good, out->sca, each(0));
}

#endif

/* mie_upward - what Lorenz-Mie theory has by upward recurrence, of a vector of spheres: Riccati-Bessel functions of x, and of y = m x where
 * that is real. Included with LANES and UNROLL set; symbols as in mie_coefficients.h. */
#ifndef OPTICS_MIE_UPWARD_H
#define OPTICS_MIE_UPWARD_H

#include "optics/numerics/vec_sincos.h"

/* What does not change with the order, of a vector of spheres. */
struct constants {
	vec x, beyond, terms, inv_x, m_re, m_im;
	vec inv_re, inv_im, norm, less;      /* 1/m, |m|^2, Re 1/m - 1 */
	vec c_re, c_im;                      /* (1 - 1/m^2)/x */
	vec cm_re, cm_im;                    /* |m|^2 times that */
	vec reach, missed;                   /* h |m^2 - 1| (|m| + 1/|m|), 4 h |m^2 - 1| times that: h, what x is off */
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
		g.reach = size_of((m_re - 1.0) * (m_re + 1.0) - m_im * m_im) + 2.0 * (m_re * m_im);
		g.missed = size_of(vr) + size_of(vi);
	} else {
		g.inv_re = 1.0 / m_re;
		g.inv_im = g.c_im = g.cm_re = g.cm_im = g.norm = each(0);
		g.c_re = (m_re - 1.0) * (m_re + 1.0) * (g.inv_re * g.inv_re) * g.inv_x;
		g.less = (1.0 - m_re) * g.inv_re;
		g.reach = size_of((m_re - 1.0) * (m_re + 1.0));
		g.missed = g.inv_re;
	}
	vec moved = MIE_OFF * x * g.reach;
	g.reach = moved * (1.0 / g.missed + g.missed);
	g.missed = 4.0 * moved * g.reach;
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

/* A step to order l. chi goes upward; psi too while l < x, beyond by ratios: upward it would be lost there, and below x ratios fail
 * where psi passes a zero. odd: 2 l - 1; ratio: E_{l-1}(x); from_x: some sphere has l >= x. */
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

#endif

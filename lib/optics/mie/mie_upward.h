/* mie_upward - what Lorenz-Mie theory has by upward recurrence, of a vector of spheres: Riccati-Bessel functions of x, and of y = m x where
 * that is real. Included with LANES and UNROLL set; symbols as in mie_coefficients.h. */
#ifndef OPTICS_MIE_UPWARD_H
#define OPTICS_MIE_UPWARD_H

#include "optics/mie/mie_resonances.h"
#include "optics/numerics/vec_sincos.h"

/* What does not change with the order, of a vector of spheres. */
struct constants {
	vec x, beyond, terms, inv_x, m_re, m_im;
	vec inv_re, inv_im, norm, less;      /* 1/m, |m|^2, Re 1/m - 1 */
	vec c_re, c_im;                      /* (1 - 1/m^2)/x */
	vec cm_re, cm_im;                    /* |m|^2 times that */
};

/* What is known of resonances before the coefficients; see mie_resonances.h. */
struct resonances {
	/* an order counts beside all other rounding, where (2l+1) (|a_l|^2 + |b_l|^2) chi_l^2, over the sum of (2l+1) Re(a + b) so
	 * far, is above; INFINITY where none can: |m| x is too small, or absorption makes none narrow */
	vec from;
	vec broad;                           /* struct mie_sums; these stand below x where n > 3 */
};

#define LOWEST 2.5                           /* |m| x of the lowest one is above */

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

INLINE struct resonances resonances_of(int absorb, const struct constants *g)
{
	struct resonances r;
	vec x = g->x, mr = g->m_re, y = mr * x, contrast = size_of((mr - 1.0) * (mr + 1.0));
	truths none = (mr <= 1.0) | (y < LOWEST);
	if (absorb) {
		vec absorbed = g->m_im * x * (10.0 + x);
		contrast += g->m_im * (2.0 * mr + g->m_im);
		none |= (absorbed > 4.0 * mr);
	}
	/* up to n = 3 other rounding has them */
	r.broad = PICK(none | (x <= 1.0) | (contrast <= 8.0), each(0), 0.75 * (contrast - 8.0));
	r.from = PICK(none, each(INFINITY), MIE_RESONANCES_FROM / (MIE_OFF / DBL_EPSILON) * (10.0 + x + r.broad) / (contrast * x));
	return r;
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

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
 * E in place of D removes the terms (l+1)/z which cancel in b_l where z is small, so that no separate series is needed there.
 *
 * Where m is near 1, A is small: f - psi_{l-1}/psi_l = d_l/m + E_l(x) (1/m - 1) + (l+1)/x (1/m^2 - 1), for b_l m d_l + E_l(x) (m - 1), with
 * d_l = E_l(y) - E_l(x) by its own recurrence d_{l-1} = [(2l+1)/y - (2l+1)/x + d_l] E_{l-1}(x) E_{l-1}(y), has the digits of m - 1. */
#ifndef OPTICS_MIE_SOLVE_H
#define OPTICS_MIE_SOLVE_H

#include "optics/vec.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

/* First order of the downward recurrence that leaves no trace at order n (rounding included) of its start with 0; even. With
 * l = |z| + t |z|^(1/3), psi_l/chi_l falls as e^(-1.89 t^(3/2)) beyond |z|; it must fall by 1e-17 from n on. Below |z|, where
 * |E_l|^2 = 1 - 2 l Im z / |z|^2 and less, an absorbing sphere forgets the start earlier: where the product of these is e^-45. */
INLINE int ratios_start(int n, double re, double im)
{
	double z = sqrt(re * re + im * im), edge = cbrtf((float)z), t = (n - z) / edge;
	double beyond = (n > z ? n : z) + 18 + (int)(edge * (t > 3 ? 14 / sqrt(t) : 8));
	double forgotten = im > 0 ? sqrt((double)n * n + 45 * z * z / im) + 18 : INFINITY;
	return (int)(forgotten < beyond ? forgotten : beyond) & ~1;
}

/* E_l(z), 1/z = inv, down from order `top` (even) to `low`, stored for low <= l <= n + 1: E_{l-1} = -1 / ((2l+1)/z + E_l), two orders to a
 * division. Before its own start, at orders above it, a lane's is 0. */
INLINE void ratios_real(int top, int low, int n, const vec *inv, const vec *start, vec *e)
{
	vec v[UNROLL];
	EACH(u)
		v[u] = each(0);
	for (int l = top; l >= 2 && l > low; l -= 2) {
		double k1 = 2.0 * l + 1, k2 = 2.0 * l - 1;
		EACH(u) {
			/* where psi_{l-1} or psi_{l-2} passes a zero, the next step brings it back */
			vec t1 = not_zero(k1 * inv[u] + v[u]), t2 = not_zero(k2 * inv[u] * t1 - 1.0), r = 1.0 / (t1 * t2);
			vec e1 = -(t2 * r), e2 = -(t1 * (t1 * r));
			if (l - 1 > n) {
				truths begun = (start[u] >= (double)l);
				e1 = PICK(begun, e1, each(0));
				e2 = PICK(begun, e2, each(0));
			}
			if (l - 1 <= n + 1)
				e[(l - 1) * UNROLL + u] = e1;
			if (l - 2 <= n + 1)
				e[(l - 2) * UNROLL + u] = e2;
			v[u] = e2;
		}
	}
}

/* The same for complex z; |t|^2 is kept off zero alike. */
INLINE void ratios_complex(int top, int n, const vec *inv_r, const vec *inv_i, const vec *start, vec *er, vec *ei)
{
	vec vr[UNROLL], vi[UNROLL];
	EACH(u)
		vr[u] = vi[u] = each(0);
	for (int l = top; l >= 2; l -= 2) {
		double k1 = 2.0 * l + 1, k2 = 2.0 * l - 1;
		EACH(u) {
			vec pr = k1 * inv_r[u] + vr[u], pi = k1 * inv_i[u] + vi[u];
			vec kr = k2 * inv_r[u], ki = k2 * inv_i[u];
			vec qr = kr * pr - ki * pi - 1.0, qi = kr * pi + ki * pr;
			vec p2 = not_zero(pr * pr + pi * pi), q2 = not_zero(qr * qr + qi * qi), r = 1.0 / (p2 * q2), rp = r * q2, rq = r * p2;
			vec e1r = -(pr * rp), e1i = pi * rp;    /* -1/p, -p/q */
			vec e2r = -((pr * qr + pi * qi) * rq), e2i = -((pi * qr - pr * qi) * rq);
			if (l - 1 > n) {
				truths begun = (start[u] >= (double)l);
				e1r = PICK(begun, e1r, each(0));
				e1i = PICK(begun, e1i, each(0));
				e2r = PICK(begun, e2r, each(0));
				e2i = PICK(begun, e2i, each(0));
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

/* E_l(x), and d_l in place of E_l(y), for m near 1: inv is 1/x, rise 1/y - 1/x. */
INLINE void ratios_near(int top, int n, int absorb, const vec *inv, const vec *rise_r, const vec *rise_i, const vec *start, vec *ex,
                               vec *dr, vec *di)
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
			if (l > n) {
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

#define CHI_MAX 1e140    /* beyond, a_l and b_l are below 1e-280 and chi^2 would overflow */

struct spheres {
	vec x[UNROLL], m_re[UNROLL], m_im[UNROLL];
	vec terms[UNROLL];         /* of each; its coefficients beyond count as 0 */
	int most, absorb, near;    /* the largest of terms; some Im m > 0; all |m - 1| < MIE_NEAR */
};

/* Sums over all orders, as of struct mie_sums. */
struct solved {
	vec ext[UNROLL], sca[UNROLL], asym[UNROLL], back_re[UNROLL], back_im[UNROLL];
};

/* Ratios of psi of x and of y = m x, and the first order at which some sphere needs the former. */
struct ratios {
	vec *x, *y_re, *y_im;
	int outside;
};

INLINE struct ratios ratios_of(const struct spheres *s, vec *room)
{
	size_t rows = ((size_t)s->most + 2) * UNROLL;
	struct ratios e = { room, room + rows, room + 2 * rows, 0 };
	vec inv_x[UNROLL], inv_re[UNROLL], inv_im[UNROLL], start_x[UNROLL], start_y[UNROLL];
	int top_x = 0, top_y = 0;
	double least = INFINITY;
	for (int i = 0; i < WIDTH; i++) {
		double x = LANE(s->x, i), re = LANE(s->m_re, i), im = s->absorb ? LANE(s->m_im, i) : 0;
		int n = (int)LANE(s->terms, i), at_x = ratios_start(n, x, 0), at_y = ratios_start(n, x * re, x * im);
		LANE(start_x, i) = at_x;
		LANE(start_y, i) = at_y;
		top_x = at_x > top_x ? at_x : top_x;
		top_y = at_y > top_y ? at_y : top_y;
		least = x < least ? x : least;
	}
	e.outside = least < s->most ? (int)ceil(least) : s->most + 1;
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
		ratios_near(top_x > top_y ? top_x : top_y, s->most, s->absorb, inv_x, inv_re, inv_im, start_y, e.x, e.y_re, e.y_im);
		return e;
	}
	ratios_real(top_x, e.outside - 1, s->most, inv_x, start_x, e.x);
	if (s->absorb)
		ratios_complex(top_y, s->most, inv_re, inv_im, start_y, e.y_re, e.y_im);
	else
		ratios_real(top_y, 0, s->most, inv_re, start_y, e.y_re);
	return e;
}

/* The coefficients of order l, up from l = 1. Riccati-Bessel functions of two neighbouring orders: old is l - 1; alive: chi^2 does
 * not overflow. */
struct climb {
	vec inv_x[UNROLL], psi_old[UNROLL], psi[UNROLL], chi_old[UNROLL], chi[UNROLL];
	vec inv_re[UNROLL], inv_im[UNROLL], c_re[UNROLL], c_im[UNROLL], fall[UNROLL];    /* 1/m, (1/m^2 - 1)/x, Re 1/m - 1 */
};

INLINE struct climb climb_start(const struct spheres *s)
{
	struct climb k;
	for (int i = 0; i < WIDTH; i++) {
		double x = LANE(s->x, i), sn = sin(x), cs = cos(x);
		LANE(k.psi_old, i) = cs;
		LANE(k.psi, i) = sn;
		LANE(k.chi_old, i) = -sn;
		LANE(k.chi, i) = cs;
	}
	EACH(u) {
		vec mr = s->m_re[u], mi = s->absorb ? s->m_im[u] : each(0);
		k.inv_x[u] = 1.0 / s->x[u];
		if (s->absorb) {
			vec m2 = mr * mr + mi * mi, vr = mr / m2, vi = -(mi / m2), v2r = vr * vr - vi * vi, v2i = 2.0 * (vr * vi);
			k.inv_re[u] = vr;
			k.inv_im[u] = vi;
			k.c_re[u] = (((1.0 - mr) * (1.0 + mr) + mi * mi) * v2r + 2.0 * (mr * mi) * v2i) * k.inv_x[u];    /* (1 - m^2)/m^2 */
			k.c_im[u] = v2i * k.inv_x[u];
			k.fall[u] = (mr * (1.0 - mr) - mi * mi) / m2;
		} else {
			k.inv_re[u] = 1.0 / mr;
			k.inv_im[u] = k.c_im[u] = each(0);
			k.c_re[u] = (1.0 - mr) * (1.0 + mr) * (k.inv_re[u] * k.inv_re[u]) * k.inv_x[u];
			k.fall[u] = (1.0 - mr) * k.inv_re[u];
		}
	}
	return k;
}

/* psi upward while l < x, by ratios beyond (upward it would be lost there; ratios fail where psi passes a zero); chi upward. outside:
 * some sphere has l >= x. */
INLINE void climb_to(struct climb *k, const struct spheres *s, const struct ratios *e, int l, int outside)
{
	EACH(u) {
		vec w = (2.0 * l - 1) * k->inv_x[u], psi = w * k->psi[u] - k->psi_old[u], chi = w * k->chi[u] - k->chi_old[u];
		if (outside)
			psi = PICK((s->x[u] > (double)l), psi, -(e->x[(l - 1) * UNROLL + u] * k->psi[u]));
		k->psi_old[u] = k->psi[u];
		k->psi[u] = psi;
		k->chi_old[u] = k->chi[u];
		k->chi[u] = chi;
	}
}

/* a_l, b_l of vector u: a[0] real part, a[1] imaginary part. */
INLINE void climb_waves(const struct climb *k, const struct spheres *s, const struct ratios *e, int l, int u, int outside, vec *a, vec *b)
{
	vec psi = k->psi[u], chi = k->chi[u], t = (2.0 * l + 1) * k->inv_x[u];
	vec ey = e->y_re[l * UNROLL + u], mr = s->m_re[u], far, fai = each(0), fbr, fbi = each(0), dr = ey;
	if (s->near)
		ey = dr + e->x[l * UNROLL + u];
	/* f = g + (2l+1)/x */
	if (s->absorb) {
		vec ei = e->y_im[l * UNROLL + u], mi = s->m_im[u];
		far = ey * k->inv_re[u] - ei * k->inv_im[u] + (l + 1.0) * k->c_re[u];
		fai = ey * k->inv_im[u] + ei * k->inv_re[u] + (l + 1.0) * k->c_im[u];
		fbr = ey * mr - ei * mi;
		fbi = ey * mi + ei * mr;
	} else {
		far = ey * k->inv_re[u] + (l + 1.0) * k->c_re[u];
		fbr = ey * mr;
	}
	vec A = (far + t) * psi - k->psi_old[u], B = (fbr + t) * psi - k->psi_old[u];
	if (outside) {             /* beyond x with psi_{l-1}/psi_l = E_l(x) + (2l+1)/x taken off by hand */
		truths inside = (s->x[u] > (double)l);
		vec ex = e->x[l * UNROLL + u];
		A = PICK(inside, A, (far - ex) * psi);
		B = PICK(inside, B, (fbr - ex) * psi);
	}
	if (s->near) {             /* but inside only where the error of psi does not count for more */
		vec ex = e->x[l * UNROLL + u], p = dr * k->inv_re[u] + ex * k->fall[u] + (l + 1.0) * k->c_re[u];
		vec q = dr * mr + ex * (mr - 1.0);
		if (s->absorb) {
			vec di = e->y_im[l * UNROLL + u];
			p = p - di * k->inv_im[u];
			q = q - di * s->m_im[u];
		}
		truths beyond = (s->x[u] <= (double)l);
		A = PICK(beyond | ((p < 1.0) & (p > -1.0)), p * psi, A);
		B = PICK(beyond | ((q < 1.0) & (q > -1.0)), q * psi, B);
	}
	vec C = (far + t) * chi - k->chi_old[u], D = (fbr + t) * chi - k->chi_old[u], r;
	if (s->absorb) {
		vec Ai = fai * psi, Bi = fbi * psi, Ci = fai * chi, Di = fbi * chi;
		vec a2 = A * A + Ai * Ai, b2 = B * B + Bi * Bi;
		vec na = a2 + (C * C + Ci * Ci) - 2.0 * fai, nb = b2 + (D * D + Di * Di) - 2.0 * fbi;
		r = 1.0 / (na * nb);
		vec ra = r * nb, rb = r * na;
		a[0] = (a2 - fai) * ra;
		a[1] = (A * C + Ai * Ci) * ra;
		b[0] = (b2 - fbi) * rb;
		b[1] = (B * D + Bi * Di) * rb;
	} else {
		vec na = A * A + C * C, nb = B * B + D * D;
		r = 1.0 / (na * nb);
		vec ra = r * nb, rb = r * na;
		a[0] = A * A * ra;
		a[1] = A * C * ra;
		b[0] = B * B * rb;
		b[1] = B * D * rb;
	}
	if (!outside)
		return;
	truths good = (s->terms[u] >= (double)l) & (chi <= CHI_MAX) & (chi >= -CHI_MAX);
	for (int c = 0; c < 2; c++) {
		a[c] = PICK(good, a[c], each(0));
		b[c] = PICK(good, b[c], each(0));
	}
}

/* Add order l, of which old_a, old_b are the order before. */
INLINE void solved_add(struct solved *q, const struct spheres *s, int l, int u, const vec *a, const vec *b, const vec *old_a, const vec *old_b)
{
	double w = 2.0 * l + 1, sign = l % 2 ? -w : w, n = l - 1.0;
	q->ext[u] += w * (a[0] + b[0]);
	if (s->absorb)
		q->sca[u] += w * (a[0] * a[0] + a[1] * a[1] + b[0] * b[0] + b[1] * b[1]);
	q->asym[u] += n * (n + 2) / (n + 1) * (old_a[0] * a[0] + old_a[1] * a[1] + old_b[0] * b[0] + old_b[1] * b[1]);
	q->asym[u] += w / (l * (l + 1.0)) * (a[0] * b[0] + a[1] * b[1]);
	q->back_re[u] += sign * (a[0] - b[0]);
	q->back_im[u] += sign * (a[1] - b[1]);
}

#endif

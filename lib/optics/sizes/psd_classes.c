/* The classes of a distribution: Gauss rules of its law, panel by panel. */
#include "optics/sizes/psd_law.h"

#include <math.h>
#include <stddef.h>

/* Gauss rule of the measure w at v > 0: the nodes x ascending, the weights c; n is 2 or 3.
 * The norms h of the orthogonal polynomials of dw and t of v dw give the quotients q, e of the qd algorithm as ratios of
 * positive sums, so that the nodes come out with small relative errors even when they are decades apart (Rutishauser 1954). */
static void gauss(int n, int m, const double *v, const double *w, double *x, double *c)
{
	double h[3] = { 0 }, t[3] = { 0 }, q[3], e[3] = { 0 };
	double a[3], b[3] = { 0 }, at[3], bt[3] = { 0 };      /* recurrences: p_(k+1) = (v - a_k) p_k - b_k p_(k-1) */
	for (int k = 0; k < n; k++) {
		for (int pass = 0; pass < 2; pass++) {
			double *norm = pass ? &t[k] : &h[k], *aa = pass ? at : a, *bb = pass ? bt : b;
			for (int i = 0; i < m; i++) {
				double p = 1, before = 0;
				for (int j = 0; j < k; j++) {
					double next = (v[i] - aa[j]) * p - bb[j] * before;
					before = p;
					p = next;
				}
				*norm += w[i] * (pass ? v[i] : 1) * p * p;
			}
			if (!pass && k) {
				e[k] = h[k] / t[k - 1];
				b[k] = q[k - 1] * e[k];
				at[k - 1] = q[k - 1] + e[k];
			}
		}
		q[k] = t[k] / h[k];
		a[k] = e[k] + q[k];
		if (k)
			bt[k] = e[k] * q[k];
	}
	/* x^3 - c2 x^2 + c1 x - c0, or x^2 - c1 x + c0 with its sign turned */
	double c2 = q[0] + e[1] + q[1], c1 = q[0] * q[1], c0 = 0, product = c1;
	if (n == 3) {
		c0 = product = q[0] * q[1] * q[2];
		c1 = q[0] * (q[1] + e[2] + q[2]) + e[1] * (e[2] + q[2]) + q[1] * q[2];
		c2 += e[2] + q[2];
	}
	double sum = c2;
	for (int side = 0; side < 2; side++) {     /* Newton's method from outside is monotone */
		double r = side ? sum : 0;
		for (int i = 0; i < 60; i++) {
			double f = n == 3 ? ((r - c2) * r + c1) * r - c0 : (r - c2) * r + c1;
			double df = n == 3 ? (3 * r - 2 * c2) * r + c1 : 2 * r - c2;
			r -= f / df;
		}
		x[side ? n - 1 : 0] = r;
	}
	if (n == 3)
		x[1] = product / (x[0] * x[2]);
	for (int j = 0; j < n; j++) {
		double total = 0, p = 1, before = 0;
		for (int k = 0; k < n; k++) {
			total += p * p / h[k];
			double next = (x[j] - a[k]) * p - b[k] * before;
			before = p;
			p = next;
		}
		c[j] = 1 / total;
	}
}

/* Where [lo, hi] has the number below under it and above over it: between in and out. Counted from the side that has less. */
static double quantile(const struct psd_law *d, double scale, double lo, double hi, double below, double above, double in,
                       double out)
{
	double y = in + (out - in) / 2;
	for (int i = 0; i < 60 && in < out; i++) {
		double f = below < above ? psd_law_integral(d, 0, scale, lo, y) - below : above - psd_law_integral(d, 0, scale, y, hi);
		if (f > 0)
			out = y;
		else
			in = y;
		double next = y - f / exp(psd_law_log(d, y) - scale);
		if (!(next > in && next < out))
			next = in + (out - in) / 2;
		if (fabs(next - y) <= 1e-15 * fabs(y) || fabs(f) <= 1e-15 * fmin(below, above))
			break;
		y = next;
	}
	return y;
}

/* The classes of one panel, n = 2 or 3; weights still in units of exp(scale). */
static void panel(const struct psd_law *d, double scale, double lo, double hi, int n, struct psd_class *out)
{
	struct psd_points p;
	double span = expm1(hi - lo), x[3], c[3];
	psd_law_points(d, scale, lo, hi, &p);
	for (int i = 0; i < p.n; i++)
		p.y[i] = expm1(p.y[i] - lo) / span;
	gauss(n, p.n, p.y, p.w, x, c);
	for (int j = 0; j < n; j++) {
		out[j].weight = c[j];
		out[j].radius = d->ref * exp(lo) * (1 + x[j] * span);
	}
	for (int j = 1; j < n; j++) {
		double below = j == 1 ? c[0] : c[0] + c[1], above = n - j == 1 ? c[n - 1] : c[1] + c[2];
		double in = lo + log1p(x[j - 1] * span), end = lo + log1p(x[j] * span);
		out[j].lo = out[j - 1].hi = d->ref * exp(quantile(d, scale, lo, hi, below, above, in, end));
	}
}

const char *psd_classes(const struct psd *p, int n, struct psd_class *out)
{
	struct psd_law d;
	double min, max, from, to, total = 0;
	const char *bad = psd_law_limits(p, &d, &min, &max);
	if (bad)
		return bad;
	if (n < 1 || n > PSD_CLASSES_MAX)
		return "needs 1 to 100000 classes";
	if (d.kind == PSD_MONO || n == 1) {
		double r = d.kind == PSD_MONO ? p->a : cbrt(psd_moment(p, 3, min, max));
		out[0] = (struct psd_class){ r, 1, min, max };
		return NULL;
	}
	double bottom = log(min / d.ref), top = log(max / d.ref), scale = psd_law_log(&d, psd_law_peak(&d, 0, bottom, top));
	/* What counts at all, and the part of it that is cut into equal panels; the outer ones reach as far as it counts. */
	bottom = psd_law_support(&d, 0, psd_law_peak(&d, 0, bottom, top), bottom);
	top = psd_law_support(&d, 3, psd_law_peak(&d, 3, bottom, top), top);
	psd_law_within(&d, PSD_BULK, &from, &to);
	from = fmax(from, bottom);
	to = fmin(to, top);
	if (!(from < to)) {
		from = bottom;
		to = top;
	}
	for (int i = 0, size; i < n; i += size) {
		size = n - i == 3 ? 3 : 2;
		double lo = i ? from + (to - from) * i / n : bottom;
		double hi = i + size < n ? from + (to - from) * (i + size) / n : top;
		panel(&d, scale, lo, hi, size, out + i);
		out[i].lo = i ? d.ref * exp(lo) : min;
		out[i + size - 1].hi = i + size < n ? d.ref * exp(hi) : max;
		for (int j = i; j < i + size; j++)
			total += out[j].weight;
	}
	for (int i = 0; i < n; i++) {
		out[i].weight /= total;
		if (!(out[i].lo < out[i].radius && out[i].radius < out[i].hi && out[i].weight > 0))
			return "cannot be divided into so many classes";
		if (i && !(out[i].radius > out[i - 1].radius * (1 + 4e-9)))
			return "has so many classes that their radii cannot be told apart (they differ by less than 4e-9)";
	}
	return NULL;
}

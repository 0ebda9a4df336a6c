#include "optics/sizes/psd.h"

#include <math.h>
#include <stddef.h>

/* Everything is done in y = ln(r/ref), with ref near the bulk, so that a narrow distribution keeps its digits; the density
 * in y is exp(g(y)), known up to a factor. g + k y has one maximum for every k. */

#define NODES 20                 /* of a Gauss-Legendre piece */
#define PIECES 96
#define VARIATION 9              /* of the exponent over a piece: 20 nodes then leave less than 1e-16 */
#define DROP 55                  /* what lies exp(-DROP) below the maximum does not count */
#define LEFT (-40)               /* down here the density is a pure exponential in y */

struct shape {
	enum psd_kind kind;
	double ref;              /* um */
	double s;                /* lognormal ln gsd; gamma 1/b - 2; normal (mean/stddev)^2; uniform, power: slope of g */
	double x[NODES], w[NODES];      /* Gauss-Legendre rule on [-1, 1] */
};

static double g(const struct shape *d, double y)
{
	double e;
	switch (d->kind) {
	case PSD_LOGNORMAL: return -0.5 * (y / d->s) * (y / d->s);
	case PSD_GAMMA:     return d->s * (y - expm1(y));
	case PSD_NORMAL:    e = expm1(y); return y - 0.5 * d->s * e * e;
	default:            return d->s * y;
	}
}

/* Where g + k y is largest within [lo, hi]. */
static double peak(const struct shape *d, int k, double lo, double hi)
{
	double y;
	switch (d->kind) {
	case PSD_LOGNORMAL: y = k * d->s * d->s; break;
	case PSD_GAMMA:     y = log1p(k / d->s); break;
	case PSD_NORMAL:    y = log((1 + sqrt(1 + 4 * (1 + k) / d->s)) / 2); break;
	default:            y = d->s + k > 0 ? hi : lo; break;
	}
	return fmin(fmax(y, lo), hi);
}

/* Where, going from the maximum towards end, the exponent g + k y has dropped by DROP; end where it has not. */
static double support(const struct shape *d, int k, double top, double end)
{
	double level = g(d, top) + k * top - DROP, in = top, out = end;
	if (g(d, end) + k * end >= level)
		return end;
	for (int i = 0; i < 100; i++) {
		double mid = in + (out - in) / 2;
		if (g(d, mid) + k * mid >= level)
			in = mid;
		else
			out = mid;
	}
	return out;
}

/* The density over a range of y as a sum over points: w_i at y_i, in units of exp(scale). */
struct points {
	int n;
	double y[NODES * PIECES], w[NODES * PIECES];
};

static void legendre(double *x, double *w)
{
	for (int i = 0; i < NODES; i++) {
		double t = -cos(3.14159265358979323846 * (i + 0.75) / (NODES + 0.5)), dp = 1;
		for (int it = 0; it < 8; it++) {
			double p0 = 1, p1 = t;
			for (int j = 2; j <= NODES; j++) {
				double p2 = ((2 * j - 1) * t * p1 - (j - 1) * p0) / j;
				p0 = p1;
				p1 = p2;
			}
			dp = NODES * (t * p1 - p0) / (t * t - 1);
			t -= p1 / dp;
		}
		x[i] = t;
		w[i] = 2 / ((1 - t * t) * dp * dp);
	}
}

/* Lay pieces over [lo, hi], between maxima monotone and short enough for the exponent to vary little in each. */
static void lay(const struct shape *d, double scale, double lo, double hi, struct points *out)
{
	double top = peak(d, 0, lo, hi);
	out->n = 0;
	for (double from = lo; from < hi && out->n < NODES * PIECES;) {
		double limit = from < top ? top : hi, to = limit;
		if (fabs(g(d, to) - g(d, from)) + 3 * (to - from) > VARIATION) {
			double in = from;
			for (int i = 0; i < 40; i++) {
				double mid = in + (to - in) / 2;
				if (fabs(g(d, mid) - g(d, from)) + 3 * (mid - from) > VARIATION)
					to = mid;
				else
					in = mid;
			}
			if (to == from)
				to = limit;
		}
		double half = (to - from) / 2;
		for (int i = 0; i < NODES; i++) {
			double y = from + half * (1 + d->x[i]);
			out->y[out->n] = y;
			out->w[out->n++] = half * d->w[i] * exp(g(d, y) - scale);
		}
		from = to;
	}
}

/* Integral of exp(g + k y - scale) over [lo, hi]. */
static double integral(const struct shape *d, int k, double scale, double lo, double hi)
{
	struct points p;
	double sum = 0, top = peak(d, k, lo, hi);
	lay(d, scale, support(d, k, top, lo), support(d, k, top, hi), &p);
	for (int i = 0; i < p.n; i++)
		sum += p.w[i] * exp(k * p.y[i]);
	return sum;
}

/* Where the share PSD_TAIL of moment k lies below (side < 0) or above (side > 0), within [lo, hi]. */
static double tail(const struct shape *d, int k, int side, double lo, double hi)
{
	double top = peak(d, k, lo, hi), scale = g(d, top) + k * top;
	double rest = d->kind == PSD_GAMMA ? exp((d->s + k) * LEFT + d->s - scale) / (d->s + k) : 0;     /* below LEFT */
	double want = PSD_TAIL * (integral(d, k, scale, LEFT, hi) + rest), in = top, out = side < 0 ? lo : hi;
	for (int i = 0; i < 60; i++) {
		double mid = in + (out - in) / 2;
		double beyond = side > 0 ? integral(d, k, scale, mid, hi)
		    : mid > LEFT ? integral(d, k, scale, LEFT, mid) + rest : rest * exp((d->s + k) * (mid - LEFT));
		if (beyond > want)
			in = mid;
		else
			out = mid;
	}
	return in + (out - in) / 2;
}

static const char *shape(const struct psd *p, struct shape *d)
{
	d->kind = p->kind;
	d->ref = p->a;
	d->s = 0;
	legendre(d->x, d->w);
	if (p->kind != PSD_UNIFORM && p->kind != PSD_POWER && !(p->a >= PSD_RADIUS_MIN && p->a <= PSD_RADIUS_MAX))
		return "needs a radius from 1e-9um to 1e9um";
	switch (p->kind) {
	case PSD_MONO:
		return NULL;
	case PSD_LOGNORMAL:
		d->s = log(p->b);
		return p->b > 1 && p->b <= 100 ? NULL : "needs a geometric standard deviation greater than 1, up to 100";
	case PSD_GAMMA:
		d->s = 1 / p->b - 2;
		d->ref = p->a * (1 - 2 * p->b);
		return p->b >= 1e-12 && p->b <= 0.499 ? NULL : "needs an effective variance greater than 0 and less than 0.5 (1e-12 to 0.499)";
	case PSD_NORMAL:
		d->s = p->a / p->b * (p->a / p->b);
		return p->b > 0 && d->s <= 1e12 && d->s >= 1e-4 ? NULL : "needs a standard deviation from 1e-6 to 100 times the mean";
	case PSD_UNIFORM:
		d->s = 1;
		break;
	case PSD_POWER:
		d->s = 1 - p->a;
		if (!(fabs(p->a) <= 100))
			return "needs an exponent from -100 to 100";
		break;
	}
	if (isnan(p->min) || isnan(p->max))
		return "needs a smallest and a largest radius";
	d->ref = sqrt(p->min) * sqrt(p->max);
	return NULL;
}

/* The default truncation, in y; uniform and power have none. */
static void bulk(const struct shape *d, double *lo, double *hi)
{
	static const double z = 3.719016485455709;     /* the normal distribution leaves PSD_TAIL beyond */
	double bottom = log(PSD_RADIUS_MIN / d->ref) - 1, top = log(PSD_RADIUS_MAX / d->ref) + 1;
	switch (d->kind) {
	case PSD_LOGNORMAL:
		*lo = -z * d->s;
		*hi = 3 * d->s * d->s + z * d->s;
		break;
	case PSD_GAMMA:
	case PSD_NORMAL:
		top = fmax(top, peak(d, 3, -INFINITY, INFINITY) + 10);
		*lo = tail(d, 0, -1, fmin(bottom, LEFT), support(d, 3, peak(d, 3, -INFINITY, INFINITY), top));
		*hi = tail(d, 3, 1, LEFT, support(d, 3, peak(d, 3, -INFINITY, INFINITY), top));
		break;
	default:
		*lo = -INFINITY;
		*hi = INFINITY;
		break;
	}
}

static const char *limits(const struct psd *p, struct shape *d, double *min, double *max)
{
	double lo, hi;
	const char *bad = shape(p, d);
	*min = p->min;
	*max = p->max;
	if (bad)
		return bad;
	if (d->kind == PSD_MONO) {
		*min = *max = p->a;
		return NULL;
	}
	if (isnan(p->min) || isnan(p->max)) {
		bulk(d, &lo, &hi);
		if (isnan(p->min))
			*min = d->ref * exp(lo);
		if (isnan(p->max))
			*max = d->ref * exp(hi);
		if (isnan(p->min) && *min < PSD_RADIUS_MIN)
			return "reaches below 1e-9um by default; give its smallest radius";
		if (isnan(p->max) && *max > PSD_RADIUS_MAX)
			return "reaches above 1e9um by default; give its largest radius";
	}
	if (!(*min >= PSD_RADIUS_MIN && *max <= PSD_RADIUS_MAX))
		return "needs a smallest and a largest radius from 1e-9um to 1e9um";
	if (!(*min < *max) && isnan(p->max))
		return "has its smallest radius not below its default largest; give its largest radius";
	if (!(*min < *max) && isnan(p->min))
		return "has its largest radius not above its default smallest; give its smallest radius";
	if (!(*min < *max))
		return "has its smallest radius not below its largest";
	/* Further out the density itself underflows: such limits are a slip. */
	lo = log(*min / d->ref);
	hi = log(*max / d->ref);
	if (g(d, peak(d, 0, lo, hi)) - g(d, peak(d, 0, -INFINITY, INFINITY)) < -700 && d->kind != PSD_UNIFORM && d->kind != PSD_POWER)
		return "has no particles between its smallest and its largest radius";
	return NULL;
}

const char *psd_limits(const struct psd *p, double *min, double *max)
{
	struct shape d;
	return limits(p, &d, min, max);
}

double psd_moment(const struct psd *p, int k, double lo, double hi)
{
	struct shape d;
	double min, max;
	if (limits(p, &d, &min, &max))
		return NAN;
	if (d.kind == PSD_MONO)
		return lo <= p->a && p->a <= hi ? pow(p->a, k) : 0;
	lo = fmax(lo, min);
	hi = fmin(hi, max);
	if (!(lo < hi))
		return 0;
	double bottom = log(min / d.ref), top = log(max / d.ref), scale = g(&d, peak(&d, 0, bottom, top));
	double from = lo == min ? bottom : log(lo / d.ref), to = hi == max ? top : log(hi / d.ref);
	return integral(&d, k, scale, from, to) / integral(&d, 0, scale, bottom, top) * pow(d.ref, k);
}

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
static double quantile(const struct shape *d, double scale, double lo, double hi, double below, double above, double in, double out)
{
	double y = in + (out - in) / 2;
	for (int i = 0; i < 60 && in < out; i++) {
		double f = below < above ? integral(d, 0, scale, lo, y) - below : above - integral(d, 0, scale, y, hi);
		if (f > 0)
			out = y;
		else
			in = y;
		double next = y - f / exp(g(d, y) - scale);
		if (!(next > in && next < out))
			next = in + (out - in) / 2;
		if (fabs(next - y) <= 1e-15 * fabs(y) || fabs(f) <= 1e-15 * fmin(below, above))
			break;
		y = next;
	}
	return y;
}

/* The classes of one panel, n = 2 or 3; weights still in units of exp(scale). */
static void panel(const struct shape *d, double scale, double lo, double hi, int n, struct psd_class *out)
{
	struct points p;
	double span = expm1(hi - lo), x[3], c[3];
	lay(d, scale, lo, hi, &p);
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
	struct shape d;
	double min, max, from, to, total = 0;
	const char *bad = limits(p, &d, &min, &max);
	if (bad)
		return bad;
	if (n < 1 || n > PSD_CLASSES_MAX)
		return "needs 1 to 100000 classes";
	if (d.kind == PSD_MONO || n == 1) {
		double r = d.kind == PSD_MONO ? p->a : cbrt(psd_moment(p, 3, min, max));
		out[0] = (struct psd_class){ r, 1, min, max };
		return NULL;
	}
	double bottom = log(min / d.ref), top = log(max / d.ref), scale = g(&d, peak(&d, 0, bottom, top));
	/* What counts at all, and the part of it that is cut into equal panels; the outer ones reach as far as it counts. */
	bottom = support(&d, 0, peak(&d, 0, bottom, top), bottom);
	top = support(&d, 3, peak(&d, 3, bottom, top), top);
	bulk(&d, &from, &to);
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

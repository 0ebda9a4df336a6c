#include "optics/sizes/psd_law.h"

#include <math.h>
#include <stddef.h>

#define VARIATION 9              /* of the exponent over a piece: 20 nodes then leave less than 1e-16 */
#define DROP 55                  /* what lies exp(-DROP) below the maximum does not count */
#define LEFT (-40)               /* down here the density is a pure exponential in y */

double psd_law_log(const struct psd_law *d, double y)
{
	double e;
	switch (d->kind) {
	case PSD_LOGNORMAL: return -0.5 * (y / d->s) * (y / d->s);
	case PSD_GAMMA:     return d->s * (y - expm1(y));
	case PSD_NORMAL:    e = expm1(y); return y - 0.5 * d->s * e * e;
	default:            return d->s * y;
	}
}

double psd_law_peak(const struct psd_law *d, int k, double lo, double hi)
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

double psd_law_support(const struct psd_law *d, int k, double top, double end)
{
	double level = psd_law_log(d, top) + k * top - DROP, in = top, out = end;
	if (psd_law_log(d, end) + k * end >= level)
		return end;
	for (int i = 0; i < 100; i++) {
		double mid = in + (out - in) / 2;
		if (psd_law_log(d, mid) + k * mid >= level)
			in = mid;
		else
			out = mid;
	}
	return out;
}

static void legendre(double *x, double *w)
{
	for (int i = 0; i < PSD_NODES; i++) {
		double t = -cos(3.14159265358979323846 * (i + 0.75) / (PSD_NODES + 0.5)), dp = 1;
		for (int it = 0; it < 8; it++) {
			double p0 = 1, p1 = t;
			for (int j = 2; j <= PSD_NODES; j++) {
				double p2 = ((2 * j - 1) * t * p1 - (j - 1) * p0) / j;
				p0 = p1;
				p1 = p2;
			}
			dp = PSD_NODES * (t * p1 - p0) / (t * t - 1);
			t -= p1 / dp;
		}
		x[i] = t;
		w[i] = 2 / ((1 - t * t) * dp * dp);
	}
}

/* Lay pieces over [lo, hi], between maxima monotone and short enough for the exponent to vary little in each. */
void psd_law_points(const struct psd_law *d, double scale, double lo, double hi, struct psd_points *out)
{
	double top = psd_law_peak(d, 0, lo, hi);
	out->n = 0;
	for (double from = lo; from < hi && out->n < PSD_NODES * PSD_PIECES;) {
		double limit = from < top ? top : hi, to = limit;
		if (fabs(psd_law_log(d, to) - psd_law_log(d, from)) + 3 * (to - from) > VARIATION) {
			double in = from;
			for (int i = 0; i < 40; i++) {
				double mid = in + (to - in) / 2;
				if (fabs(psd_law_log(d, mid) - psd_law_log(d, from)) + 3 * (mid - from) > VARIATION)
					to = mid;
				else
					in = mid;
			}
			if (to == from)
				to = limit;
		}
		double half = (to - from) / 2;
		for (int i = 0; i < PSD_NODES; i++) {
			double y = from + half * (1 + d->x[i]);
			out->y[out->n] = y;
			out->w[out->n++] = half * d->w[i] * exp(psd_law_log(d, y) - scale);
		}
		from = to;
	}
}

double psd_law_integral(const struct psd_law *d, int k, double scale, double lo, double hi)
{
	struct psd_points p;
	double sum = 0, top = psd_law_peak(d, k, lo, hi);
	psd_law_points(d, scale, psd_law_support(d, k, top, lo), psd_law_support(d, k, top, hi), &p);
	for (int i = 0; i < p.n; i++)
		sum += p.w[i] * exp(k * p.y[i]);
	return sum;
}

/* Where a share of moment k lies below (side < 0) or above (side > 0), within [lo, hi]. */
static double tail(const struct psd_law *d, double share, int k, int side, double lo, double hi)
{
	double top = psd_law_peak(d, k, lo, hi), scale = psd_law_log(d, top) + k * top;
	double rest = d->kind == PSD_GAMMA ? exp((d->s + k) * LEFT + d->s - scale) / (d->s + k) : 0;     /* below LEFT */
	double want = share * (psd_law_integral(d, k, scale, LEFT, hi) + rest), in = top, out = side < 0 ? lo : hi;
	for (int i = 0; i < 60; i++) {
		double mid = in + (out - in) / 2;
		double beyond = side > 0 ? psd_law_integral(d, k, scale, mid, hi)
		    : mid > LEFT ? psd_law_integral(d, k, scale, LEFT, mid) + rest : rest * exp((d->s + k) * (mid - LEFT));
		if (beyond > want)
			in = mid;
		else
			out = mid;
	}
	return in + (out - in) / 2;
}

static const char *law_of(const struct psd *p, struct psd_law *d)
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
	default:
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

void psd_law_within(const struct psd_law *d, double share, double *lo, double *hi)
{
	const double z = share < PSD_BULK ? 5.612001244174789 : 3.719016485455709;     /* the normal distribution leaves share beyond */
	double bottom = log(PSD_RADIUS_MIN / d->ref) - 1, top = log(PSD_RADIUS_MAX / d->ref) + 1;
	switch (d->kind) {
	case PSD_LOGNORMAL:
		*lo = -z * d->s;
		*hi = 3 * d->s * d->s + z * d->s;
		break;
	case PSD_GAMMA:
	case PSD_NORMAL:
		top = fmax(top, psd_law_peak(d, 3, -INFINITY, INFINITY) + 10);
		*lo = tail(d, share, 0, -1, fmin(bottom, LEFT), psd_law_support(d, 3, psd_law_peak(d, 3, -INFINITY, INFINITY), top));
		*hi = tail(d, share, 3, 1, LEFT, psd_law_support(d, 3, psd_law_peak(d, 3, -INFINITY, INFINITY), top));
		break;
	default:
		*lo = -INFINITY;
		*hi = INFINITY;
		break;
	}
}

const char *psd_law_limits(const struct psd *p, struct psd_law *d, double *min, double *max)
{
	double lo, hi;
	const char *bad = law_of(p, d);
	*min = p->min;
	*max = p->max;
	if (bad)
		return bad;
	if (d->kind == PSD_MONO) {
		*min = *max = p->a;
		return NULL;
	}
	if (isnan(p->min) || isnan(p->max)) {
		double low, high;
		psd_law_within(d, PSD_BULK, &low, &high);
		psd_law_within(d, PSD_TAIL, &lo, &hi);
		if (isnan(p->min))
			*min = fmax(d->ref * exp(lo), fmin(PSD_RADIUS_MIN, d->ref * exp(low)));
		if (isnan(p->max))
			*max = fmin(d->ref * exp(hi), fmax(PSD_RADIUS_MAX, d->ref * exp(high)));
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
	double within = psd_law_log(d, psd_law_peak(d, 0, lo, hi)), most = psd_law_log(d, psd_law_peak(d, 0, -INFINITY, INFINITY));
	if (within - most < -700 && d->kind != PSD_UNIFORM && d->kind != PSD_POWER)
		return "has no particles between its smallest and its largest radius";
	return NULL;
}

const char *psd_limits(const struct psd *p, double *min, double *max)
{
	struct psd_law d;
	return psd_law_limits(p, &d, min, max);
}

double psd_moment(const struct psd *p, int k, double lo, double hi)
{
	struct psd_law d;
	double min, max;
	if (psd_law_limits(p, &d, &min, &max))
		return NAN;
	if (d.kind == PSD_MONO)
		return lo <= p->a && p->a <= hi ? pow(p->a, k) : 0;
	lo = fmax(lo, min);
	hi = fmin(hi, max);
	if (!(lo < hi))
		return 0;
	double bottom = log(min / d.ref), top = log(max / d.ref), scale = psd_law_log(&d, psd_law_peak(&d, 0, bottom, top));
	double from = lo == min ? bottom : log(lo / d.ref), to = hi == max ? top : log(hi / d.ref);
	return psd_law_integral(&d, k, scale, from, to) / psd_law_integral(&d, 0, scale, bottom, top) * pow(d.ref, k);
}

#include "optics/sizes/size_quadrature.h"

#include "optics/sizes/psd_law.h"

#include <math.h>
#include <stdlib.h>

static double v_at(double scale, double r)
{
	return hypot(r, scale) - scale * asinh(scale / r);
}

/* v is convex in ln r: Newton's method from above stays there. r is at most v + scale asinh(1) above scale, and what it is for r << scale
 * below. */
static double radius_at(double scale, double v, double above)
{
	double y = log(fmin(above, v > (M_SQRT2 - 0.881373587) * scale ? v + 0.881373588 * scale : 2 * scale * exp(v / scale - 1)));
	for (int i = 0; i < 100; i++) {
		double r = exp(y), step = (v_at(scale, r) - v) / hypot(r, scale);
		y -= step;
		if (fabs(step) < 1e-14)
			break;
	}
	return exp(y);
}

double size_range_length(const struct size_range *r) { return v_at(r->scale, r->hi) - v_at(r->scale, r->lo); }

long size_range_count(const struct size_range *r, int level)
{
	(void)r;
	return level ? (long)SIZE_STEPS << (level - 1) : SIZE_STEPS + 1;
}

void size_range_at(const struct size_range *r, const struct size_density *d, int level, long k, double *radius,
                   double weight[SIZE_WAYS])
{
	double h = 1.0 / (double)((long)SIZE_STEPS << level), t = (level ? 2.0 * (double)k + 1 : (double)k) * h, at = t, slope = 1;
	double turn = (r->cut_lo && r->cut_hi ? 2 : 1) * M_PI;
	if (r->cut_lo) {
		at = t - sin(turn * t) / turn;
		slope = 2 * sin(turn * t / 2) * sin(turn * t / 2);
	} else if (r->cut_hi) {
		at = t + sin(turn * t) / turn;
		slope = 2 * cos(turn * t / 2) * cos(turn * t / 2);
	}
	double from = v_at(r->scale, r->lo), length = v_at(r->scale, r->hi) - from;
	*radius = fmin(fmax(radius_at(r->scale, from + at * length, r->hi), r->lo), r->hi);
	double dy = length * slope * h / hypot(*radius, r->scale), y = log(*radius);
	if (!level && (k == 0 || k == SIZE_STEPS))
		dy /= 2;
	for (int way = 0; way < size_density_ways(d); way++)
		weight[way] = size_density_at(d, r->class, way, y) * dy;
}

/* The share of an envelope r^2 q(r) from one side comes to want: where. */
static double reach(const struct psd_points *p, const double *part, double want, int side)
{
	double all = 0, sum = 0;
	for (int i = 0; i < p->n; i++)
		all += part[i];
	for (int k = 0; k < p->n; k++) {
		int i = side < 0 ? k : p->n - 1 - k;
		sum += part[i];
		if (sum > want * all)
			return p->y[side < 0 ? (i ? i - 1 : 0) : i + 1 < p->n ? i + 1 : i];
	}
	return p->y[0];
}

void size_reach(const struct psd *law, double scale, double contrast, double share, double *lo, double *hi)
{
	struct psd_law d;
	struct psd_points p;
	double part[PSD_NODES * PSD_PIECES], edge = fmin(1, contrast);
	psd_law_limits(law, &d, lo, hi);
	int low = isnan(law->min), high = isnan(law->max);
	if (law->kind == PSD_MONO || (!low && !high))
		return;
	double from = low ? log(PSD_RADIUS_MIN / d.ref) - 60 : log(*lo / d.ref), to = high ? log(PSD_RADIUS_MAX / d.ref) + 60 : log(*hi / d.ref);
	double bottom = psd_law_support(&d, 2, psd_law_peak(&d, 2, from, to), from), top = psd_law_support(&d, 6, psd_law_peak(&d, 6, from, to), to);
	psd_law_points(&d, psd_law_log(&d, psd_law_peak(&d, 2, from, to)), bottom, top, &p);
	for (int up = 0; up < 2; up++) {
		if (!(up ? high : low))
			continue;
		for (int i = 0; i < p.n; i++) {
			double x = exp(p.y[i]) * d.ref / scale, q = up ? fmin(x * x * x * x, fmin(x * x, 1 / (edge * edge))) : fmin(x, 1);
			part[i] = p.w[i] * exp(2 * p.y[i]) * q;
		}
		*(up ? hi : lo) = d.ref * exp(reach(&p, part, share, up ? 1 : -1));
	}
}

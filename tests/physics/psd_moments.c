/* Size classes against an independent quadrature (Simpson's rule in long double) of the distributions as they are defined. */
#include "optics/sizes/psd.h"
#include "support/tap.h"

#include <math.h>
#include <stdlib.h>

#define STEPS 100000

/* r n(r), not normalised, straight from the definitions, as a function of ln r. */
static long double density(const struct psd *p, long double y)
{
	long double r = expl(y), t;
	switch (p->kind) {
	case PSD_LOGNORMAL:
		t = logl(r / p->a) / logl(p->b);
		return expl(-t * t / 2);
	case PSD_GAMMA:
		return expl((1 - 3 * (long double)p->b) / p->b * logl(r / p->a) - r / ((long double)p->a * p->b) + 1 / (long double)p->b) * r;
	case PSD_NORMAL:
		t = (r - p->a) / p->b;
		return expl(-t * t / 2) * r;
	case PSD_POWER:
		return powl(r / p->min, -p->a) * r;
	default:
		return r;
	}
}

static void reference(const struct psd *p, double min, double max, long double *m)
{
	long double lo = logl(min), h = (logl(max) - lo) / STEPS;
	for (int k = 0; k < 7; k++)
		m[k] = 0;
	for (int i = 0; i <= STEPS; i++) {
		long double y = lo + i * h, w = (i == 0 || i == STEPS ? 1 : i & 1 ? 4 : 2) * h / 3 * density(p, y), r = expl(y);
		for (int k = 0; k < 7; k++, w *= r)
			m[k] += w;
	}
	for (int k = 6; k >= 0; k--)
		m[k] /= m[0];
}

static double worse(double a, double b)
{
	return !(a >= b) ? b : a;     /* NaN counts as the worst */
}

static void check(const char *name, struct psd p, int n, const long double *m)
{
	static struct psd_class c[5000];
	double min, max, off = 0, moments = 0, fraction = 0, sum = 0;
	const char *bad = psd_limits(&p, &min, &max);
	if (!bad)
		bad = psd_classes(&p, n, c);
	if (bad) {
		ok(0, "%s, %d classes: %s", name, n, bad);
		return;
	}
	int inside = c[0].lo == min && c[n - 1].hi == max;
	for (int i = 0; i < n; i++) {
		inside &= c[i].lo < c[i].radius && c[i].radius < c[i].hi && c[i].weight > 0 && (!i || c[i].lo == c[i - 1].hi);
		sum += c[i].weight;
		if (n < 50)
			fraction = worse(fabs(psd_moment(&p, 0, c[i].lo, c[i].hi) / c[i].weight - 1), fraction);
	}
	for (int k = 0; k < 4; k++) {
		long double s = 0;
		for (int i = 0; i < n; i++)
			s += c[i].weight * powl(c[i].radius, k);
		if (n > 1 || k == 0 || k == 3)
			off = worse((double)fabsl(s / m[k] - 1), off);
	}
	for (int k = 0; k < 7; k++)
		moments = worse((double)fabsl(psd_moment(&p, k, min, max) / m[k] - 1), moments);
	ok(inside && off < 1e-12 && fabs(sum - 1) < 1e-14 && moments < 1e-12 && fraction < 1e-11,
	          "%s, %d classes: moments 0 to 3 of the classes off by %.0e, 0 to 6 of psd_moment by %.0e, class fractions by %.0e%s",
	          name, n, off, moments, fraction, inside ? "" : "; a radius outside its class");
}

static void tails(const char *name, struct psd p, struct psd wide)
{
	double min, max;
	psd_limits(&p, &min, &max);
	double number = psd_moment(&wide, 0, 0, min), volume = psd_moment(&wide, 3, max, INFINITY) / psd_moment(&wide, 3, 0, INFINITY);
	/* wide begins at PSD_RADIUS_MIN, which leaves a thousandth of the number below normal's min */
	ok(fabs(number / PSD_TAIL - 1) < 2e-3 && fabs(volume / PSD_TAIL - 1) < 1e-3,
	   "%s: %.4e of the number below, %.4e of the volume above", name, number, volume);
}

static void refused(const char *name, struct psd p)
{
	double min, max;
	struct psd_class c[2];
	const char *bad = psd_limits(&p, &min, &max);
	ok(bad && psd_classes(&p, 2, c) == bad && isnan(psd_moment(&p, 0, 0, 1)), "%s: %s", name, bad ? bad : "(accepted)");
}

int main(void)
{
	static const struct { const char *name; struct psd p; } all[] = {
		{ "lognormal 10um 1.01", { PSD_LOGNORMAL, 10, 1.01, NAN, NAN } },
		{ "lognormal 10um 1.3", { PSD_LOGNORMAL, 10, 1.3, NAN, NAN } },
		{ "lognormal 0.1um 2", { PSD_LOGNORMAL, 0.1, 2, NAN, NAN } },
		{ "lognormal 1um 5", { PSD_LOGNORMAL, 1, 5, NAN, NAN } },
		{ "lognormal 10um 1.3 in 5um to 50um", { PSD_LOGNORMAL, 10, 1.3, 5, 50 } },
		{ "lognormal 10um 1.05 in 1nm to 1cm", { PSD_LOGNORMAL, 10, 1.05, 1e-3, 1e4 } },
		{ "lognormal 10um 1.3 in 50um to 60um", { PSD_LOGNORMAL, 10, 1.3, 50, 60 } },
		{ "gamma 10um 0.001", { PSD_GAMMA, 10, 0.001, NAN, NAN } },
		{ "gamma 10um 0.1", { PSD_GAMMA, 10, 0.1, NAN, NAN } },
		{ "gamma 10um 0.25", { PSD_GAMMA, 10, 0.25, NAN, NAN } },
		{ "gamma 10um 0.4", { PSD_GAMMA, 10, 0.4, NAN, NAN } },
		{ "gamma 10um 0.49 in 10nm to 1mm", { PSD_GAMMA, 10, 0.49, 0.01, 1000 } },
		{ "normal 10um 0.1um", { PSD_NORMAL, 10, 0.1, NAN, NAN } },
		{ "normal 10um 3um", { PSD_NORMAL, 10, 3, NAN, NAN } },
		{ "normal 10um 50um", { PSD_NORMAL, 10, 50, NAN, NAN } },
		{ "uniform 1um to 1.001um", { PSD_UNIFORM, 0, 0, 1, 1.001 } },
		{ "uniform 10nm to 1mm", { PSD_UNIFORM, 0, 0, 0.01, 1000 } },
		{ "power 0, 1um to 10um", { PSD_POWER, 0, 0, 1, 10 } },
		{ "power 1, 1um to 10um", { PSD_POWER, 1, 0, 1, 10 } },
		{ "power 4, 10nm to 1mm", { PSD_POWER, 4, 0, 0.01, 1000 } },
		{ "power 8, 10nm to 1mm", { PSD_POWER, 8, 0, 0.01, 1000 } },
		{ "power -3, 10nm to 1mm", { PSD_POWER, -3, 0, 0.01, 1000 } },
	};
	static const int counts[] = { 1, 2, 3, 4, 7, 16, 33, 400 };
	enum { N = sizeof all / sizeof *all, C = sizeof counts / sizeof *counts };
	for (int i = 0; i < N; i++) {
		double min, max;
		long double m[7];
		psd_limits(&all[i].p, &min, &max);
		reference(&all[i].p, min, max, m);
		for (int j = 0; j < C; j++)
			check(all[i].name, all[i].p, counts[j], m);
	}

	tails("lognormal 10um 1.5", (struct psd){ PSD_LOGNORMAL, 10, 1.5, NAN, NAN }, (struct psd){ PSD_LOGNORMAL, 10, 1.5, 1e-3, 1e4 });
	tails("gamma 10um 0.2", (struct psd){ PSD_GAMMA, 10, 0.2, NAN, NAN }, (struct psd){ PSD_GAMMA, 10, 0.2, 1e-9, 1e4 });
	tails("normal 10um 5um", (struct psd){ PSD_NORMAL, 10, 5, NAN, NAN }, (struct psd){ PSD_NORMAL, 10, 5, 1e-9, 1e4 });

	refused("lognormal, gsd 1", (struct psd){ PSD_LOGNORMAL, 10, 1, NAN, NAN });
	refused("lognormal, gsd NaN", (struct psd){ PSD_LOGNORMAL, 10, NAN, NAN, NAN });
	refused("lognormal, median 0", (struct psd){ PSD_LOGNORMAL, 0, 2, NAN, NAN });
	refused("lognormal, too wide", (struct psd){ PSD_LOGNORMAL, 10, 50, NAN, NAN });
	refused("gamma, variance 0.5", (struct psd){ PSD_GAMMA, 10, 0.5, NAN, NAN });
	refused("gamma, variance 0.48", (struct psd){ PSD_GAMMA, 10, 0.48, NAN, NAN });
	refused("normal, stddev 0", (struct psd){ PSD_NORMAL, 10, 0, NAN, NAN });
	refused("uniform without limits", (struct psd){ PSD_UNIFORM, 0, 0, NAN, NAN });
	refused("uniform from 0", (struct psd){ PSD_UNIFORM, 0, 0, 0, 1 });
	refused("power, limits exchanged", (struct psd){ PSD_POWER, 3, 0, 2, 1 });
	refused("lognormal, limits equal", (struct psd){ PSD_LOGNORMAL, 10, 2, 5, 5 });
	refused("lognormal, limits where nothing is", (struct psd){ PSD_LOGNORMAL, 10, 1.01, 100, 200 });

	struct psd_class c[2];
	ok(!psd_classes(&(struct psd){ PSD_MONO, 10, 0, NAN, NAN }, 16, c) && c[0].radius == 10 && c[0].weight == 1
	   && c[0].lo == 10 && c[0].hi == 10, "mono is one class");
	ok(psd_moment(&(struct psd){ PSD_MONO, 10, 0, NAN, NAN }, 3, 0, 20) == 1000, "mono: third moment");
	/* Analytic: uniform on [1, 2], mean 1.5, third moment 15/4; the effective radius of a gamma distribution is what was asked for. */
	ok(fabs(psd_moment(&(struct psd){ PSD_UNIFORM, 0, 0, 1, 2 }, 3, 1, 2) - 3.75) < 1e-14, "uniform: third moment 15/4");
	struct psd gamma = { PSD_GAMMA, 10, 0.1, 1e-3, 1e4 };
	double m2 = psd_moment(&gamma, 2, 0, 1e9), m3 = psd_moment(&gamma, 3, 0, 1e9), m4 = psd_moment(&gamma, 4, 0, 1e9);
	ok(fabs(m3 / m2 - 10) < 1e-12 && fabs(m4 * m2 / (m3 * m3) - 1 - 0.1) < 1e-12,
	   "gamma: effective radius %.13g um, effective variance %.13g", m3 / m2, m4 * m2 / (m3 * m3) - 1);
	return done_testing();
}

#include "optics/rays.h"

#include <math.h>

/* The angle that a root is sought in: i for n >= 1, t for bubbles. The other one, and the derivative of tau, are smooth in it. */
static double turn(double n, int p, double u)
{
	if (n < 1)
		return 2 * asin(n * sin(u)) - 2 * p * u;
	double c = cos(u);
	return 2 * u - 2 * p * atan2(sin(u), sqrt((n - 1) * (n + 1) + c * c));
}

static double turn_slope(double n, int p, double u)
{
	double c = cos(u), s = n * sin(u);
	if (n < 1)
		return 2 * n * c / sqrt(1 - s * s) - 2 * p;
	return 2 - 2 * p * c / sqrt((n - 1) * (n + 1) + c * c);
}

struct caustic rays_caustic(double n, int p)
{
	struct caustic c = { NAN, NAN, 0, p ? 2.0 * p / n * fabs(1 - 1 / (n * n)) : 0 };
	if (n <= 1 || n >= p)
		return c;
	double cos2 = (n - 1) * (n + 1) / ((p - 1.0) * (p + 1.0)), q2 = p * p * cos2;    /* q = p cos i_R */
	double incidence = acos(sqrt(fmin(cos2, 1)));
	if (incidence == 0)    /* n = p but for the last bit */
		return c;
	c.incidence = incidence;
	c.tau = turn(n, p, c.incidence);
	c.bend = 2 * p * sin(c.incidence) * (n - 1) * (n + 1) / (q2 * sqrt(q2));
	return c;
}

/* The root of turn = tau in [lo, hi], where turn is monotone with the given sign: Newton, kept inside a shrinking bracket. */
static double solve(double n, int p, double lo, double hi, int sign, double guess, double tau)
{
	double u = guess > lo && guess < hi ? guess : (lo + hi) / 2;
	for (int k = 0; k < 80; k++) {
		double f = sign * (turn(n, p, u) - tau);
		if (f < 0)
			lo = u;
		else
			hi = u;
		double next = u - sign * f / turn_slope(n, p, u);
		if (!(next >= lo && next <= hi))
			next = (lo + hi) / 2;
		if (fabs(next - u) <= 4e-16 * next)
			return next;
		u = next;
	}
	return u;
}

/* Direction seen from the axis of order p's central ray. */
struct direction {
	double sine;          /* sin theta */
	double from_axis;     /* theta for odd p, pi - theta for even p; rad */
};

/* Everything about a ray but its incidence. side: tau = side from_axis + 2 pi turns; sign: of Theta'. */
static void finish(struct ray *r, int p, const struct direction *d, int side, int turns, int sign, int axial)
{
	int sigma = p % 2 ? side : -side;
	int m = p % 2 ? turns + (p - 1) / 2 : turns - (sigma - p + 1) / 2;
	r->p = p;
	r->axial = axial;
	r->eighths = ((4 * m - 2 * (p - 1) - sigma - sign) % 8 + 8) % 8;
	r->slope = p ? fabs(2 - 2 * p * r->cos_i / r->q) : 2;
	r->ratio = d->sine > 0 ? r->sin_i / d->sine : axial ? 1 / r->slope : INFINITY;
	r->gap = INFINITY;
}

/* External reflection: i = (pi - theta)/2. */
static int reflected(double n, const struct direction *d, struct ray *r)
{
	double i = d->from_axis / 2, q2;
	r->sin_i = sin(i);
	r->cos_i = cos(i);
	q2 = (n - 1) * (n + 1) + r->cos_i * r->cos_i;
	r->q = sqrt(q2 > 0 ? q2 : 0);
	finish(r, 0, d, 1, 0, 1, 1);
	return 1;
}

/* One chord: tan i = n sin(theta/2) / |n cos(theta/2) - 1|. */
static int transmitted(double n, const struct direction *d, struct ray *r)
{
	double half = d->from_axis / 2, away = n * cos(half) - 1;
	if (n >= 1 ? away < 0 : cos(half) < n)
		return 0;
	double i = atan2(n * sin(half), fabs(away));
	r->sin_i = sin(i);
	r->cos_i = cos(i);
	if (n >= 1)
		r->q = sqrt((n - 1) * (n + 1) + r->cos_i * r->cos_i);
	else
		r->q = fmax(n * cos(i + half), 0);
	finish(r, 1, d, n >= 1 ? 1 : -1, 0, n >= 1 ? 1 : -1, 1);
	/* 2 - 2 cos i / q without cancellation: q^2 - cos^2 i is given by n alone */
	r->slope = 2 * fabs((n - 1) * (n + 1)) / (r->q * (r->q + r->cos_i));
	if (d->sine == 0)
		r->ratio = 1 / r->slope;
	return 1;
}

/* Rays of one branch, on which tau runs monotonically from turn(lo) to turn(hi). */
static int on_branch(double n, int p, const struct caustic *c, const struct direction *d, double lo, double hi, int sign, struct ray *out)
{
	double from = turn(n, p, lo), to = turn(n, p, hi), least = fmin(from, to), most = fmax(from, to);
	int k = 0, central = lo == 0;
	for (int side = -1; side <= 1; side += 2)
		for (int turns = (int)ceil((least - side * d->from_axis) / (2 * M_PI) - 1e-9);; turns++) {
			double tau = side * d->from_axis + 2 * M_PI * turns;
			if (tau > most)
				break;
			if (tau < least || (central && tau == 0 && side != sign))
				continue;
			double guess = lo + (hi - lo) * (tau - from) / (to - from);
			if (!isnan(c->tau))
				guess = c->incidence + sign * sqrt(2 * fmax(tau - c->tau, 0) / c->bend);
			double u = solve(n, p, lo, hi, sign, guess, tau), s = sin(u), q = cos(u);
			struct ray *r = &out[k++];
			r->sin_i = n < 1 ? n * s : s;
			r->cos_i = n < 1 ? sqrt(1 - n * n * s * s) : q;
			r->q = n < 1 ? n * q : sqrt((n - 1) * (n + 1) + q * q);
			finish(r, p, d, side, turns, sign, central && turns == 0 && d->from_axis < M_PI / 2);
			if (!isnan(c->tau))
				r->gap = fabs(tau - c->tau);
		}
	return k;
}

int rays_find(double n, int p, const struct caustic *c, double theta, struct ray *out)
{
	double rest = 180 - theta;
	struct direction d = { sin(fmin(theta, rest) * (M_PI / 180)), (p % 2 ? theta : rest) * (M_PI / 180) };
	if (p == 0)
		return reflected(n, &d, out);
	if (p == 1)
		return transmitted(n, &d, out);
	if (isnan(c->tau))
		return on_branch(n, p, c, &d, 0, M_PI / 2, n <= 1 ? -1 : 1, out);
	int k = on_branch(n, p, c, &d, 0, c->incidence, -1, out);
	return k + on_branch(n, p, c, &d, c->incidence, M_PI / 2, 1, out + k);
}

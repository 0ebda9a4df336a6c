#include "optics/goa/rays.h"

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

double rays_spread(const struct ray *r)
{
	return r->p ? sqrt(r->ratio * r->cos_i / r->slope) : 0.5;
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
	r->sigma = sigma;
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

int rays_branches(double n, int p, const struct caustic *c, struct branch out[2])
{
	out[0] = (struct branch){ 0, M_PI / 2, 0, 0, n <= 1 ? -1 : 1, 1 };
	int k = 1;
	if (!isnan(c->tau)) {
		out[0] = (struct branch){ 0, c->incidence, 0, 0, -1, 1 };
		out[1] = (struct branch){ c->incidence, M_PI / 2, 0, 0, 1, 0 };
		k = 2;
	}
	for (int b = 0; b < k; b++) {
		out[b].from = turn(n, p, out[b].lo);
		out[b].to = turn(n, p, out[b].hi);
	}
	return k;
}

static struct direction direction(int p, double theta)
{
	double rest = 180 - theta;
	return (struct direction){ sin(fmin(theta, rest) * (M_PI / 180)), (p % 2 ? theta : rest) * (M_PI / 180) };
}

/* The ray of a branch with tau = side from_axis + 2 pi turns, if there is one. */
static int one_ray(double n, int p, const struct caustic *c, const struct branch *b, const struct direction *d, int side,
		   int turns, struct ray *r)
{
	double tau = side * d->from_axis + 2 * M_PI * turns;
	if (tau < fmin(b->from, b->to) || tau > fmax(b->from, b->to) || (b->central && tau == 0 && side != b->sign))
		return 0;
	double guess = b->lo + (b->hi - b->lo) * (tau - b->from) / (b->to - b->from);
	if (!isnan(c->tau))
		guess = c->incidence + b->sign * sqrt(2 * fmax(tau - c->tau, 0) / c->bend);
	double u = solve(n, p, b->lo, b->hi, b->sign, guess, tau), s = sin(u), q = cos(u);
	r->sin_i = n < 1 ? n * s : s;
	r->cos_i = n < 1 ? sqrt(1 - n * n * s * s) : q;
	r->q = n < 1 ? n * q : sqrt((n - 1) * (n + 1) + q * q);
	finish(r, p, d, side, turns, b->sign, b->central && turns == 0 && d->from_axis < M_PI / 2);
	if (!isnan(c->tau))
		r->gap = fabs(tau - c->tau);
	return 1;
}

int rays_at(double n, int p, const struct caustic *c, const struct branch *b, double theta, int side, int turns, struct ray *r)
{
	struct direction d = direction(p, theta);
	return one_ray(n, p, c, b, &d, side, turns, r);
}

int rays_find(double n, int p, const struct caustic *c, double theta, struct ray *out)
{
	struct direction d = direction(p, theta);
	struct branch branch[2];
	if (p == 0)
		return reflected(n, &d, out);
	if (p == 1)
		return transmitted(n, &d, out);
	int k = 0;
	for (int b = 0, branches = rays_branches(n, p, c, branch); b < branches; b++) {
		double least = fmin(branch[b].from, branch[b].to), most = fmax(branch[b].from, branch[b].to);
		for (int side = -1; side <= 1; side += 2)
			for (int turns = (int)ceil((least - side * d.from_axis) / (2 * M_PI) - 1e-9);
			     side * d.from_axis + 2 * M_PI * turns <= most; turns++)
				k += one_ray(n, p, c, &branch[b], &d, side, turns, &out[k]);
	}
	return k;
}

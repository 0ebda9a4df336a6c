#include "optics/cam/cam_waves.h"

#include "optics/goa/debye_waves.h"
#include "optics/numerics/gauss.h"
#include "optics/numerics/smoothstep.h"

#define ARCS 6         /* panels in angle */
#define EDGES 6        /* and across a turning point, EDGE widths to either side */
#define EDGE 7
#define DEEP 12        /* ripple: the share of a wave rises from so many widths inside the edge */
#define FULL 3         /* to so many */

double cam_share(double x, double lambda)
{
	double s = cbrt(x / 2), first, second;
	return smoothstep(fmax(x - DEEP * s, 0), 1 / ((DEEP - FULL) * s), lambda, &first, &second);
}

/* One order more of the amplitude's Debye expansion: xi'/xi = i f - .., f^2 = c^2 - f''/(2 f) + (3/4)(f'/f)^2 + 1/(4 z^2). */
static void refine(const double lambda[DEBYE_WIDTH], double z, struct debye_phase *p)
{
	for (int i = 0; i < DEBYE_WIDTH; i++) {
		double s2 = (z - lambda[i]) * (z + lambda[i]), a = lambda[i] * lambda[i] / s2;
		p->c[i] *= 1 + (0.25 + a * (1.5 + 1.25 * a)) / (2 * s2);
	}
}

/* The waves at DEBYE_WIDTH lambdas. */
static void waves(double x, double complex m, const struct debye_bounds *bounds, const double lambda[DEBYE_WIDTH],
                  struct debye out[DEBYE_WIDTH])
{
	struct debye_phase outside, inside;
	debye_phases(lambda, x, &outside);
	debye_phases(lambda, x * creal(m), &inside);
	refine(lambda, x, &outside);
	refine(lambda, x * creal(m), &inside);
	for (int i = 0; i < DEBYE_WIDTH; i++)
		debye_term(x, m, bounds, lambda[i], i, &outside, &inside, &out[i]);
}

/* Mean of S S'*, S = R + T/(1 - I), over the phase of I and I' together. */
static double complex mean(double complex r, double complex t, double complex i, double complex r2, double complex t2, double complex i2)
{
	double complex turns = i * conj(i2), left = 1 - turns;
	return r * conj(r2) + (norm2(left) > 1e-24 ? t * conj(t2) / left : 0);
}

static double complex whole(const struct debye *d, int j)
{
	return d->r[j] + d->t[j] / (1 - d->i[j]);
}

/* Radiation pressure by waves: with L = l + 1 between the waves l and l + 1, of (1/x^2) sum L sum_j (1 - Re S_l S*_(l+1)) + (1/x^2) sum
 * |S_1 - S_2|^2 / lambda, which is the sum of mie.h's g but for terms of order x^-3. */
static double pressure(double x, double lambda, const struct debye *below, const struct debye *above)
{
	double sum = 0, apart = 0;
	for (int j = 0; j < 2; j++) {
		sum += 1 - creal(mean(below->r[j], below->t[j], below->i[j], above->r[j], above->t[j], above->i[j]));
		apart += creal(mean(below->r[j], below->t[j], below->i[j], below->r[j], below->t[j], below->i[j]));
	}
	apart -= 2 * creal(mean(below->r[0], below->t[0], below->i[0], below->r[1], below->t[1], below->i[1]));
	return (lambda * sum + (lambda > 1 ? apart / lambda : 0)) / (x * x);
}

static double loss(double x, double lambda, const struct debye *d)
{
	double sum = 0;
	for (int j = 0; j < 2; j++)
		sum += 1 - creal(mean(d->r[j], d->t[j], d->i[j], d->r[j], d->t[j], d->i[j]));
	return lambda * sum / (x * x);
}

/* A stretch of u = lambda/x in panels: even in u, or in the angle v of u = middle - half cos v where roots end at middle +- half. */
struct stretch {
	int panels, arc;
	double from, to, middle, half;
};

static void stretch_mean(double x, double complex m, const struct stretch *s, double *abs, double *pr)
{
	const struct debye_bounds bounds = debye_bounds(x, m);
	double step = (s->to - s->from) / s->panels / 2;
	int absorbs = cimag(m) > 0;
	for (int k = 0; k < s->panels; k++) {
		double lambda[DEBYE_WIDTH], less[DEBYE_WIDTH], more[DEBYE_WIDTH], weight[DEBYE_WIDTH];
		struct debye here[DEBYE_WIDTH], below[DEBYE_WIDTH], above[DEBYE_WIDTH];
		for (int i = 0; i < DEBYE_WIDTH; i++) {
			double v = s->from + step * (2 * k + 1 + gauss_node[i]);
			lambda[i] = x * (s->arc ? s->middle - s->half * cos(v) : v);
			weight[i] = x * step * gauss_weight[i] * (s->arc ? s->half * sin(v) : 1);
			less[i] = fmax(lambda[i] - 0.5, 1e-3);
			more[i] = lambda[i] + 0.5;
		}
		waves(x, m, &bounds, less, below);
		waves(x, m, &bounds, more, above);
		if (absorbs)
			waves(x, m, &bounds, lambda, here);
		for (int i = 0; i < DEBYE_WIDTH; i++) {
			*pr += weight[i] * pressure(x, lambda[i], &below[i], &above[i]);
			if (absorbs)
				*abs += weight[i] * loss(x, lambda[i], &here[i]);
		}
	}
}

/* Up to the turning point `turn' of a cylinder function: an arc, whose roots may also end at `start', then panels across it. */
static double cross(double x, double complex m, double at, double start, double turn, double *abs, double *pr)
{
	double width = EDGE * cbrt(turn * x / 2) / x, middle = (start + turn) / 2, half = (turn - start) / 2, end = turn - width;
	struct stretch arc = { ARCS, 1, acos((middle - at) / half), acos((middle - end) / half), middle, half };
	if (end > at)
		stretch_mean(x, m, &arc, abs, pr);
	at = fmax(at, fmax(end, 0));
	end = turn + width;
	if (end > at)
		stretch_mean(x, m, &(struct stretch){ EDGES, 0, at, end, 0, 0 }, abs, pr);
	return fmax(at, end);
}

void cam_mean(double x, double complex m, double *abs, double *pr)
{
	double n = creal(m), at = 0;
	*abs = *pr = 0;
	if (n < 1)
		at = cross(x, m, 0, -n, n, abs, pr);
	cross(x, m, at, n < 1 ? n : -1, 1, abs, pr);
}

void cam_ripple(double x, double complex m, double *ext, double *abs, double *pr)
{
	const struct debye_bounds bounds = debye_bounds(x, m);
	double s = cbrt(x / 2), y = creal(m) * x, turn = y - DEBYE_TURN * cbrt(y / 2);
	int first = (int)fmax(floor(x - DEEP * s - 0.5), 1), last = (int)fmin(ceil(x + DEBYE_TOP * s), turn - 1), absorbs = cimag(m) > 0;
	*ext = *abs = *pr = 0;
	for (int l0 = first; l0 <= last; l0 += DEBYE_WIDTH - 1) {
		double lambda[DEBYE_WIDTH];
		struct debye d[DEBYE_WIDTH];
		for (int i = 0; i < DEBYE_WIDTH; i++)
			lambda[i] = l0 + i + 0.5;
		waves(x, m, &bounds, lambda, d);
		for (int i = 0; i + 1 < DEBYE_WIDTH && l0 + i <= last; i++) {
			double w = 2 * lambda[i] / (x * x) * cam_share(x, lambda[i]);
			double between = (lambda[i] + 0.5) / (x * x) * cam_share(x, lambda[i] + 0.5);
			for (int j = 0; j < 2; j++) {
				const struct debye *p = &d[i], *q = &d[i + 1];
				double complex all = whole(p, j);
				*ext -= w * creal(p->t[j] * p->i[j] / (1 - p->i[j]));
				if (absorbs)
					*abs += w / 2 * (creal(mean(p->r[j], p->t[j], p->i[j], p->r[j], p->t[j], p->i[j])) - norm2(all));
				*pr += between * creal(mean(p->r[j], p->t[j], p->i[j], q->r[j], q->t[j], q->i[j]) -
				                       all * conj(whole(q, j)));
			}
		}
	}
}

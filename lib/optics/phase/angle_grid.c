#include "optics/phase/angle_grid.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#define PERIOD 8        /* intervals in the shortest period */
#define COARSEST 1.0    /* degrees */
#define FINEST 0.025
#define END 0.1         /* first interval, in units of 1/x */
#define WIDEN 40        /* intervals of the size of 1/WIDEN of the distance from the end */

/* The front half, 0 to 90 deg inclusive: the refined end, then equal intervals over what is left. theta may be NULL. */
static int half(double x, double *theta)
{
	double inside = fmin(COARSEST, fmax(FINEST, 180 / (PERIOD * x))), first = END * (180 / M_PI) / x, t = 0;
	int n = 0;
	for (double h = first; h < inside && t < 90 - inside; h = fmax(first, t / WIDEN)) {
		if (theta)
			theta[n] = t;
		n++;
		t += h;
	}
	int rest = (int)ceil((90 - t) / inside);
	for (int i = 0; i <= rest; i++, n++)
		if (theta)
			theta[n] = i == rest ? 90 : t + (90 - t) * i / rest;
	return n;
}

/* The back half is taken from the front one; the count is odd or the middle pair straddles 90 deg. */
static void mirror(int n, double *theta)
{
	for (int i = n / 2; i < n; i++)
		theta[i] = 180 - theta[n - 1 - i];
}

int angle_grid_count(double x)
{
	return 2 * half(x, NULL) - 1;
}

void angle_grid(double x, double *theta)
{
	mirror(2 * half(x, theta) - 1, theta);
}

void angle_grid_equal(int n, double *theta)
{
	for (int i = 0; i < (n + 1) / 2; i++)
		theta[i] = 180.0 * i / (n - 1);
	mirror(n, theta);
}

#define FINE 32             /* intervals of the fine grid in the shortest period, at the tolerance TYPICAL */
#define TYPICAL 1e-3
#define FINE_STEP 0.25      /* degrees */
#define LONGEST 1.0         /* interval kept, degrees */

long angle_grid_fine(double x, double tolerance, double *theta)
{
	double inside = fmin(FINE_STEP, 180 / (FINE * x)) * fmin(1, sqrt(tolerance / TYPICAL)), t = 0;
	/* Equal shares of the error want intervals like theta^(2/3) in the diffraction rings, till interference takes over. */
	double lobe = 180 / M_PI / (2 * x), peak = 3 * 180 / M_PI / sqrt(x);
	long n = 0;
	if (180 / inside > ANGLE_GRID_MOST)
		return -1;
	for (double h; h = inside * fmin(1, pow((t + lobe) / peak, 2.0 / 3)), h < inside && t < 90; t += h, n++)
		if (theta)
			theta[n] = t;
	long rest = (long)ceil((180 - t) / inside);
	for (long i = 0; i <= rest; i++, n++)
		if (theta)
			theta[n] = i == rest ? 180 : t + (180 - t) * (double)i / (double)rest;
	return n;
}

struct thin {
	long n;
	const double *theta;
	int nwaves;
	double *const *p;
	double *ring;        /* [n]: half the solid angle about an angle */
	double *within;      /* [nwaves][n]: sums, from 0, of the errors within the intervals of the fine grid itself */
};

/* Second derivative of p at an inner angle, per square degree. */
static double curvature(const double *theta, const double *p, long k)
{
	double h0 = theta[k] - theta[k - 1], h1 = theta[k + 1] - theta[k];
	return 2 * ((p[k + 1] - p[k]) / h1 - (p[k] - p[k - 1]) / h0) / (h0 + h1);
}

static void measure(struct thin *t)
{
	const double *theta = t->theta, rad = M_PI / 180;
	for (long k = 0; k < t->n; k++)
		t->ring[k] = M_PI * sin(theta[k] * rad) * (theta[k + 1 < t->n ? k + 1 : k] - theta[k ? k - 1 : 0]) / 2 * rad;
	for (int w = 0; w < t->nwaves; w++) {
		double *within = t->within + (long)w * t->n, left = fabs(curvature(theta, t->p[w], 1));
		within[0] = 0;
		for (long k = 0; k + 1 < t->n; k++) {
			double h = theta[k + 1] - theta[k], right = k + 2 < t->n ? fabs(curvature(theta, t->p[w], k + 1)) : left;
			within[k + 1] = within[k] + (left + right) / 24 * h * h * h * M_PI * sin((theta[k] + h / 2) * rad) * rad;
			left = right;
		}
	}
}

/* Half the integral of |p - chord| over the ring between angles i and j: what shows at the angles between, and the rest. */
static double chord_error(const struct thin *t, int w, long i, long j)
{
	const double *theta = t->theta, *p = t->p[w], *within = t->within + (long)w * t->n;
	double slope = (p[j] - p[i]) / (theta[j] - theta[i]), sum = within[j] - within[i];
	for (long k = i + 1; k < j; k++)
		sum += fabs(p[k] - p[i] - slope * (theta[k] - theta[i])) * t->ring[k];
	return sum;
}

static int serves(const struct thin *t, long i, long j, double share)
{
	if (j >= t->n || t->theta[j] - t->theta[i] > LONGEST)
		return 0;
	for (int w = 0; w < t->nwaves; w++)
		if (chord_error(t, w, i, j) > share)
			return 0;
	return 1;
}

/* Keep angles as far apart as an interval's share of the error lets them be; the largest error of a wave into *error. */
static long stride(const struct thin *t, double share, long *keep, double *error)
{
	long kept = 1, step = 1;
	*error = 0;
	double sum[t->nwaves];
	for (int w = 0; w < t->nwaves; w++)
		sum[w] = 0;
	keep[0] = 0;
	for (long i = 0; i < t->n - 1; ) {
		long good = 1, bad = step + 1;
		if (step == 1 || serves(t, i, i + step, share)) {
			good = step;
			for (bad = good + (good + 3) / 4; serves(t, i, i + bad, share); bad += (bad + 3) / 4)
				good = bad;
		} else {
			bad = step;
		}
		while (bad - good > 1) {
			long middle = (good + bad) / 2;
			if (serves(t, i, i + middle, share))
				good = middle;
			else
				bad = middle;
		}
		for (int w = 0; w < t->nwaves; w++)
			sum[w] += chord_error(t, w, i, i + good);
		keep[kept++] = i += step = good;
	}
	for (int w = 0; w < t->nwaves; w++)
		*error = fmax(*error, sum[w]);
	return kept;
}

long angle_grid_thin(long n, const double *theta, int nwaves, double *const *p, double tolerance, long *keep)
{
	struct thin t = { n, theta, nwaves, p, NULL, NULL };
	double *room = malloc(((size_t)nwaves + 1) * (size_t)n * sizeof *room);
	if (!room)
		return -1;
	t.ring = room;
	t.within = room + n;
	measure(&t);
	/* An interval of length H has the error c H^3 = share; were it so all along, there would be sum r^(1/3) / share^(1/3) of
	 * them, r the errors of the fine grid's intervals. Then by what it comes to. */
	double sum = 0, error, share, best = 0;
	for (int w = 0; w < nwaves; w++) {
		double one = 0;
		for (long k = 0; k + 1 < n; k++)
			one += cbrt(t.within[(long)w * n + k + 1] - t.within[(long)w * n + k]);
		sum = fmax(sum, one);
	}
	share = pow(tolerance / sum, 1.5);
	long kept = 0;
	for (int i = 0; i < 8; i++) {
		kept = stride(&t, share, keep, &error);
		if (error <= tolerance) {
			best = share;
			if (error > 0.97 * tolerance)
				break;
		}
		share *= pow(0.985 * tolerance / error, 1.5);
	}
	kept = stride(&t, best, keep, &error);
	free(room);
	return kept;
}

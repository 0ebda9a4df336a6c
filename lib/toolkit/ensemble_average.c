#include "toolkit/ensemble_average.h"

#include "base/die.h"
#include "format/columns.h"
#include "optics/phase/angle_grid.h"
#include "toolkit/ensemble.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_WORK 3e8      /* of size parameters together; see ensemble_average.h */
#define FIRST_LEVEL 2      /* that is judged; before, sizes can be off by more than they differ from half as many */
#define COARSE 16          /* how much coarser the first angles are than the finest; then a quarter of it, and so on */

struct average {
	const struct phase_options *o;
	struct ensemble ensemble;
	double change;             /* by the last doubling that was judged */
	int warned;
};

/* The means as they are now; returns the largest change, half the integral over the sphere. */
static double settle(struct ensemble *e)
{
	double most = 0;
	for (size_t m = 0; m < e->nmean; m++) {
		struct ensemble_mean *mean = &e->mean[m];
		double all = mean->points_weight + mean->weight;
		if (!(all > 0 && all < INFINITY))
			die(ensemble_path(e), all > 0 ? "the sum of weights is out of range" : "all weights are 0");
		for (int k = 0; k < PHASE_ELEMENTS; k++) {
			double *value = mean->value + k * e->n, sum = 0;
			for (long i = 0; i < e->n; i++) {
				double v = (mean->points[k * e->n + i] + mean->sum[k * e->n + i]) / all;
				double width = (e->theta[i + 1 < e->n ? i + 1 : i] - e->theta[i ? i - 1 : 0]) / 2;
				sum += fabs(v - value[i]) * sin(e->theta[i] * (M_PI / 180)) * width;
				value[i] = v;
			}
			most = fmax(most, sum * M_PI * (M_PI / 180));
		}
	}
	return most;
}

/* The means at theta[n] by levels 0 .. least, and, where they are judged, by as many more as it takes. Returns the last. */
static int integrate(struct average *a, int least, int judged)
{
	struct ensemble *e = &a->ensemble;
	const size_t values = PHASE_ELEMENTS * (size_t)e->n;
	for (size_t m = 0; m < e->nmean; m++) {
		struct ensemble_mean *mean = &e->mean[m];
		mean->points_weight = mean->weight = 0;
		free(mean->value);
		mean->value = xalloc(3 * values, sizeof *mean->value);
		mean->points = mean->value + values;
		mean->sum = mean->points + values;
	}
	ensemble_add_points(e);
	e->work = 0;
	for (int level = 0; e->sub; level++) {
		for (size_t m = 0; m < e->nmean; m++) {
			e->mean[m].weight /= 2;
			for (size_t i = 0; i < values; i++)
				e->mean[m].sum[i] /= 2;
		}
		ensemble_add_level(e, level);
		double change = settle(e);
		if (level < least)
			continue;
		if (!judged)
			return level;
		a->change = change;
		if (change < a->o->tolerance / 2)
			return level;
		if (2 * e->work > MOST_WORK) {
			if (!a->warned++)
				warn(ensemble_path(e), "the mean over sizes has not settled: twice as many changed it by %.2g, not by less than %g",
				     change, a->o->tolerance / 2);
			return level;
		}
	}
	settle(e);
	return 0;
}

static void take_angles(struct ensemble *e, long n)
{
	if (n > INT_MAX)
		die(NULL, "the sizes want too many angles");
	e->n = n;
	e->theta = xgrow(e->theta, (size_t)n, sizeof *e->theta);
}

/* Leave those of the means' angles that serve them all; 0 where the angles were too few for that. */
static int thin(struct ensemble *e, double tolerance)
{
	size_t curves = e->nmean * PHASE_ELEMENTS;
	double **curve = xalloc(curves, sizeof *curve);
	long *keep = xalloc((size_t)e->n, sizeof *keep);
	for (size_t c = 0; c < curves; c++)
		curve[c] = e->mean[c / PHASE_ELEMENTS].value + c % PHASE_ELEMENTS * (size_t)e->n;
	long n = angle_grid_thin(e->n, e->theta, (int)curves, curve, tolerance, keep);
	if (n < 0)
		die(NULL, "out of memory");
	int enough = n < e->n;
	for (long i = 0; i < n; i++) {
		e->theta[i] = e->theta[keep[i]];
		for (size_t c = 0; c < curves; c++)
			curve[c][i] = curve[c][keep[i]];
	}
	for (size_t c = 0; c < curves; c++)    /* without gaps between the elements */
		memmove(e->mean[c / PHASE_ELEMENTS].value + c % PHASE_ELEMENTS * (size_t)n, curve[c], (size_t)n * sizeof **curve);
	e->n = n;
	free(curve);
	free(keep);
	return enough;
}

/* Means at angles of their own, thinned; unless no more is wanted than the level. */
static int own_angles(struct average *a, int level_only)
{
	struct ensemble *e = &a->ensemble;
	const double half = a->o->tolerance / 2;
	double x = 0;
	for (size_t i = 0; i < e->nw; i++) {
		const struct waves *w = &e->w[i];
		x = fmax(x, size_extent(&w->size) * (ensemble_limited(e, w) ? w->carried[e->hi_col] / w->size.radius : 1));
	}
	if (!e->model->any_angles) {
		take_angles(e, angle_grid_count(x));
		angle_grid(x, e->theta);
		return integrate(a, FIRST_LEVEL, 1);
	}
	/* A mean of many sizes is smooth, which is seen when it is there. */
	int level = FIRST_LEVEL;
	for (double coarse = e->sub ? COARSE : 1;; coarse /= 4) {
		take_angles(e, angle_grid_fine(x / coarse, half, NULL));
		angle_grid_fine(x / coarse, half, e->theta);
		level = integrate(a, level, 1);
		if (level_only || thin(e, half) || coarse == 1)
			return level;
	}
}

void ensemble_average_table(const struct phase_options *o, struct spheres *in, const struct phase_model *model, long n,
                            const double *theta, const char *output, const char *command)
{
	const struct tab_col cols[] = { column_wavelength, column_theta, column_p };
	struct average a = { .o = o, .ensemble = { .in = in, .model = model } };
	struct ensemble *e = &a.ensemble;
	int level = 0;
	ensemble_read(e);
	if (!n || e->sub)
		level = own_angles(&a, n > 0);
	if (n) {
		take_angles(e, n);
		memcpy(e->theta, theta, (size_t)n * sizeof *theta);
		integrate(&a, level, 0);
	}
	if (o->verbose && e->sub) {
		long sizes = 0;
		for (int k = 0; k <= level; k++)
			sizes += size_quadrature_count(e->sub, k);
		warn("verbose", "mean over %ld sizes; half as many change it by %.2g", sizes, a.change);
	}
	struct tab_out *out = tab_create(output, spheres_history(in), command, spheres_law(in), 2 + PHASE_ELEMENTS, cols);
	for (size_t m = 0; m < e->nmean; m++) {
		double row[2 + PHASE_ELEMENTS] = { e->mean[m].size.wavelength };
		for (long i = 0; i < e->n; i++) {
			row[1] = e->theta[i];
			for (int k = 0; k < PHASE_ELEMENTS; k++)
				row[2 + k] = e->mean[m].value[k * e->n + i];
			tab_put(out, row);
		}
		free(e->mean[m].value);
	}
	tab_finish(out);
	free(e->theta);
	ensemble_free(e);
}

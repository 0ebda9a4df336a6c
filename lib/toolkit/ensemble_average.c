#include "toolkit/ensemble_average.h"

#include "base/die.h"
#include "optics/phase/angle_grid.h"
#include "optics/mie/mie_host.h"
#include "optics/sizes/size_quadrature.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_WORK 3e8      /* of size parameters together; see ensemble_average.h */
#define FIRST_LEVEL 2      /* that is judged; before, sizes can be off by more than they differ from half as many */
#define LEAST_X 100        /* what a small sphere counts as */
#define COARSE 16          /* how much coarser the first angles are than the finest; then a quarter of it, and so on */
#define CHUNK_X 20000      /* sizes at a time: sum of size parameters, at most, but for one particle's */
#define CHUNK_SIZES 256
#define CHUNK_P 4000000    /* values of p at a time, but for one particle's */
#define BLOCK 4096         /* angles together */

/* Of one wavelength. Sums of weight x c_sca x p, c_sca in um^2/pi, and of weight x c_sca. */
struct mean {
	struct size size;          /* of some particle; others differ by radius, x and x_im */
	double points_weight, weight;
	double *points, *sum;      /* [angles]: sizes as given; the integral over classes */
	double *p;                 /* [angles]: the mean */
};

struct average {
	const struct phase_options *o;
	struct coeffs *in;
	phase_model *model;
	const void *context;
	int weight_col, lo_col, hi_col;    /* among what is carried; limits: -1 without */
	struct waves *w;           /* as read */
	size_t nw;
	struct mean *mean;
	size_t nmean;
	struct size_quadrature *sub;      /* NULL: none */
	long n;
	double *theta;
	double work;               /* size parameters summed by the levels so far */
	double change;             /* of p by the last doubling that was judged */
	int warned;
};

static const char *path(const struct average *a) { return tab_path(coeffs_table(a->in)); }

static int limited(const struct average *a, const struct size *s)
{
	return a->lo_col >= 0 && s->carried[a->lo_col] < s->carried[a->hi_col];
}

static void check(const struct average *a, const struct size *s)
{
	double weight = s->carried[a->weight_col];
	if (!(weight >= 0) || isinf(weight))
		die(path(a), "weight %g of radius %g um is not a fraction", weight, s->radius);
	if (a->lo_col < 0)
		return;
	double lo = s->carried[a->lo_col], hi = s->carried[a->hi_col];
	if (!(lo > 0 && lo <= s->radius && s->radius <= hi && hi < INFINITY) || (lo < hi && (lo == s->radius || hi == s->radius)))
		die(path(a), "radius %g um does not lie between radius_lo %g um and radius_hi %g um", s->radius, lo, hi);
	double least = s->x * (lo / s->radius), most = s->x * (hi / s->radius);
	if (!(least >= SIZES_X_MIN && most <= SIZES_X_MAX && (hi == lo || cabs(s->m) * most <= sizes_y_max(s->m))))
		die(path(a), "the class of radius %g um has size parameters out of range: from %g to %g, and %g over the index %g",
		    s->radius, SIZES_X_MIN, SIZES_X_MAX, sizes_y_max(s->m), cabs(s->m));
	if (!(2 * s->x_im * (hi / s->radius) <= MIE_HOST_BETA_MAX))
		die(path(a), "in the class of radius %g um 4 pi r Im(host) / wavelength goes up to %g, above %d", s->radius,
		    2 * s->x_im * (hi / s->radius), MIE_HOST_BETA_MAX);
}

static size_t mean_of(struct average *a, const struct size *size)
{
	size_t at = 0;
	while (at < a->nmean && fabs(a->mean[at].size.wavelength / size->wavelength - 1) > 1e-9)
		at++;
	if (at == a->nmean) {
		a->mean = xgrow(a->mean, ++a->nmean, sizeof *a->mean);
		a->mean[at] = (struct mean){ .size = *size };
		a->mean[at].size.carried = NULL;
	}
	return at;
}

static void find_columns(struct average *a)
{
	const struct tab_col own[2] = { { "wavelength", TAB_F64, "um" }, { "radius", TAB_F64, "um" } };
	struct tab_col carried[TAB_COLS];
	struct tab *t = coeffs_table(a->in);
	if (!t)
		die("--average", "needs a table with a column weight");
	tab_need(t, "weight", "1");
	if (coeffs_by_x(a->in))
		die("--average", "needs radii and wavelengths");
	a->lo_col = a->hi_col = -1;
	int n = coeffs_carried(a->in, 2, own, carried), limits = !coeffs_read(a->in) && tab_find(t, "radius_lo", "um") >= 0 &&
		tab_find(t, "radius_hi", "um") >= 0;
	for (int i = 0; i < n; i++) {
		if (!strcmp(carried[i].name, "weight"))
			a->weight_col = i;
		if (limits && !strcmp(carried[i].name, "radius_lo"))
			a->lo_col = i;
		if (limits && !strcmp(carried[i].name, "radius_hi"))
			a->hi_col = i;
	}
}

/* All of the table, and its classes. */
static void read_all(struct average *a)
{
	struct psd_class *c = NULL;
	struct waves next;
	size_t room = 0;
	int n = 0;
	double scale = INFINITY;
	while (coeffs_next(a->in, &next)) {
		const struct size *s = &next.size;
		check(a, s);
		mean_of(a, s);
		if (a->nw == room)
			a->w = xgrow(a->w, room = 2 * room + 64, sizeof *a->w);
		a->w[a->nw++] = next;
		if (!limited(a, s))
			continue;
		scale = fmin(scale, s->radius / s->x);
		if (!s->first)
			continue;
		if (!(n & (n - 1)))
			c = xgrow(c, n ? 2 * (size_t)n : 1, sizeof *c);
		c[n++] = (struct psd_class){ s->radius, s->carried[a->weight_col], s->carried[a->lo_col], s->carried[a->hi_col] };
	}
	if (n && !(a->sub = size_quadrature_new(n, c, scale)))
		die(NULL, "out of memory");
	free(c);
}

/* p[n][angles] and q_sca[n] by a model that is asked once. */
static int once(const struct average *a, struct waves *w, size_t n, double *p, double *q_sca)
{
	int failed = 0;
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n > 1)
	for (size_t i = 0; i < n; i++) {
		double complex *s = malloc(2 * (size_t)a->n * sizeof *s);
		struct phase_result r = { .s1 = s, .s2 = s + a->n };
		if (!s || a->model(a->context, &w[i], (int)a->n, a->theta, &r)) {
			failed = 1;
		} else {
			q_sca[i] = r.q_sca;
			adapt_power(r.norm, a->n, r.s1, r.s2, p + i * (size_t)a->n);
		}
		free(s);
		waves_drop(&w[i]);
	}
	return failed;
}

/* The same by one that can be asked again and again. */
static int in_blocks(const struct average *a, struct waves *w, size_t n, double *p, double *q_sca)
{
	const struct phase_profile *profile = a->o->profile;
	struct phase_state **state = xalloc(n, sizeof *state);
	long blocks = (a->n + BLOCK - 1) / BLOCK;
	int failed = 0;
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n > 1)
	for (size_t i = 0; i < n; i++) {
		failed |= !(state[i] = profile->open(a->context, &w[i], (size_t)a->n));
		if (state[i])
			q_sca[i] = state[i]->q_sca;
	}
#pragma omp parallel for schedule(dynamic) collapse(2) reduction(|:failed)
	for (size_t i = 0; i < n; i++)
		for (long b = 0; b < blocks; b++)
			if (!failed)
				failed |= adapt_p(profile, state[i], a->n - b * BLOCK < BLOCK ? a->n - b * BLOCK : BLOCK,
				                  a->theta + b * BLOCK, p + i * (size_t)a->n + b * BLOCK);
	for (size_t i = 0; i < n; i++)
		if (state[i])
			profile->close(state[i]);
	free(state);
	return failed;
}

/* Add weight x c_sca x p of waves w[n] to sums of their wavelengths, in this order at every angle: integrals or points. */
static void add(struct average *a, struct waves *w, const double *weight, size_t n, int points)
{
	double *p = xalloc(n * (size_t)a->n, sizeof *p), *factor = xalloc(n, sizeof *factor), **sum = xalloc(n, sizeof *sum);
	if (a->o->profile ? in_blocks(a, w, n, p, factor) : once(a, w, n, p, factor))
		die(NULL, "out of memory");
	for (size_t i = 0; i < n; i++) {
		struct mean *m = &a->mean[mean_of(a, &w[i].size)];
		factor[i] *= weight[i] * w[i].size.radius * w[i].size.radius;
		*(points ? &m->points_weight : &m->weight) += factor[i];
		sum[i] = points ? m->points : m->sum;
	}
#pragma omp parallel for schedule(static)
	for (long from = 0; from < a->n; from += 256)
		for (size_t i = 0; i < n; i++)
			for (long k = from; k < a->n && k < from + 256; k++)
				sum[i][k] += factor[i] * p[i * (size_t)a->n + (size_t)k];
	free(p);
	free(factor);
	free(sum);
}

/* Whether one more of size x still fits with n that have x_sum. */
static int fits(const struct average *a, size_t n, double x_sum, double x)
{
	return n == 0 || (n < CHUNK_SIZES && x_sum + x <= CHUNK_X && (n + 1) * (size_t)a->n <= CHUNK_P);
}

static void add_points(struct average *a)
{
	double weight[CHUNK_SIZES], x = 0;
	size_t n = 0, from = 0;
	for (size_t i = 0; i <= a->nw; i++) {
		int own = i < a->nw && !limited(a, &a->w[i].size);
		if (n && (!own || !fits(a, n, x, a->w[i].size.x))) {
			add(a, a->w + from, weight, n, 1);
			n = 0;
			x = 0;
		}
		if (!own)
			continue;
		if (!n)
			from = i;
		weight[n++] = a->w[i].size.carried[a->weight_col];
		x += a->w[i].size.x;
	}
}

static void add_level(struct average *a, int level)
{
	struct waves w[CHUNK_SIZES];
	double weight[CHUNK_SIZES], x = 0;
	size_t n = 0;
	long count = size_quadrature_count(a->sub, level);
	for (long k = 0; k < count; k++) {
		double radius, part;
		size_quadrature_at(a->sub, level, k, &radius, &part);
		for (size_t m = 0; m < a->nmean; m++) {
			struct waves one = { .size = a->mean[m].size };
			one.size.x *= radius / one.size.radius;
			one.size.radius = radius;
			one.size.x_im = size_x_im(&one.size);
			a->work += fmax(one.size.x, LEAST_X);
			if (!fits(a, n, x, one.size.x)) {
				add(a, w, weight, n, 0);
				n = 0;
				x = 0;
			}
			weight[n] = part;
			w[n++] = one;
			x += one.size.x;
		}
	}
	add(a, w, weight, n, 0);
}

/* The means as they are now; returns the largest change, half the integral over the sphere. */
static double settle(struct average *a)
{
	double most = 0;
	for (size_t m = 0; m < a->nmean; m++) {
		struct mean *mean = &a->mean[m];
		double sum = 0, all = mean->points_weight + mean->weight;
		if (!(all > 0 && all < INFINITY))
			die(path(a), all > 0 ? "the sum of weights is out of range" : "all weights are 0");
		for (long i = 0; i < a->n; i++) {
			double p = (mean->points[i] + mean->sum[i]) / all;
			double width = (a->theta[i + 1 < a->n ? i + 1 : i] - a->theta[i ? i - 1 : 0]) / 2;
			sum += fabs(p - mean->p[i]) * sin(a->theta[i] * (M_PI / 180)) * width;
			mean->p[i] = p;
		}
		most = fmax(most, sum * M_PI * (M_PI / 180));
	}
	return most;
}

/* The means at a->theta[a->n] by levels 0 .. least, and, where they are judged, by as many more as it takes. Returns the last. */
static int integrate(struct average *a, int least, int judged)
{
	for (size_t m = 0; m < a->nmean; m++) {
		struct mean *mean = &a->mean[m];
		mean->points_weight = mean->weight = 0;
		free(mean->p);
		mean->p = xalloc(3 * (size_t)a->n, sizeof *mean->p);
		mean->points = mean->p + a->n;
		mean->sum = mean->points + a->n;
	}
	add_points(a);
	a->work = 0;
	for (int level = 0; a->sub; level++) {
		for (size_t m = 0; m < a->nmean; m++) {
			a->mean[m].weight /= 2;
			for (long i = 0; i < a->n; i++)
				a->mean[m].sum[i] /= 2;
		}
		add_level(a, level);
		double change = settle(a);
		if (level < least)
			continue;
		if (!judged)
			return level;
		a->change = change;
		if (change < a->o->tolerance / 2)
			return level;
		if (2 * a->work > MOST_WORK) {
			if (!a->warned++)
				warn(path(a), "the mean over sizes has not settled: twice as many changed it by %.2g, not by less than %g",
				     change, a->o->tolerance / 2);
			return level;
		}
	}
	settle(a);
	return 0;
}

static void take_angles(struct average *a, long n)
{
	if (n > INT_MAX)
		die(NULL, "the sizes want too many angles");
	a->n = n;
	a->theta = xgrow(a->theta, (size_t)n, sizeof *a->theta);
}

/* Leave those of the means' angles that serve them all; 0 where the angles were too few for that. */
static int thin(struct average *a)
{
	double **p = xalloc(a->nmean, sizeof *p);
	long *keep = xalloc((size_t)a->n, sizeof *keep);
	for (size_t m = 0; m < a->nmean; m++)
		p[m] = a->mean[m].p;
	long n = angle_grid_thin(a->n, a->theta, (int)a->nmean, p, a->o->tolerance / 2, keep);
	if (n < 0)
		die(NULL, "out of memory");
	int enough = n < a->n;
	for (long i = 0; i < n; i++) {
		a->theta[i] = a->theta[keep[i]];
		for (size_t m = 0; m < a->nmean; m++)
			p[m][i] = p[m][keep[i]];
	}
	a->n = n;
	free(p);
	free(keep);
	return enough;
}

/* Means at angles of their own, thinned; unless no more is wanted than the level. */
static int own_angles(struct average *a, int level_only)
{
	double x = 0;
	for (size_t i = 0; i < a->nw; i++) {
		const struct size *s = &a->w[i].size;
		x = fmax(x, size_extent(s) * (limited(a, s) ? s->carried[a->hi_col] / s->radius : 1));
	}
	if (!a->o->profile) {
		take_angles(a, angle_grid_count(x));
		angle_grid(x, a->theta);
		return integrate(a, FIRST_LEVEL, 1);
	}
	/* A mean of many sizes is smooth, which is seen when it is there. */
	int level = FIRST_LEVEL;
	for (double coarse = a->sub ? COARSE : 1;; coarse /= 4) {
		take_angles(a, angle_grid_fine(x / coarse, a->o->tolerance / 2, NULL));
		angle_grid_fine(x / coarse, a->o->tolerance / 2, a->theta);
		level = integrate(a, level, 1);
		if (level_only || thin(a) || coarse == 1)
			return level;
	}
}

void average_table(const struct phase_options *o, struct coeffs *in, phase_model *model, const void *context,
                   long n, const double *theta, const char *output, const char *command)
{
	const struct tab_col cols[3] = { { "wavelength", TAB_F64, "um" }, phase_theta_col, phase_p_col };
	struct average a = { .o = o, .in = in, .model = model, .context = context };
	int level = 0;
	find_columns(&a);
	read_all(&a);
	if (!n || a.sub)
		level = own_angles(&a, n > 0);
	if (n) {
		take_angles(&a, n);
		memcpy(a.theta, theta, (size_t)n * sizeof *theta);
		integrate(&a, level, 0);
	}
	if (o->verbose && a.sub) {
		long sizes = 0;
		for (int k = 0; k <= level; k++)
			sizes += size_quadrature_count(a.sub, k);
		warn("verbose", "mean over %ld sizes; half as many change it by %.2g", sizes, a.change);
	}
	struct tab_out *out = tab_create(output, coeffs_history(in), command, 3, cols);
	for (size_t m = 0; m < a.nmean; m++) {
		for (long i = 0; i < a.n; i++)
			tab_put(out, (double[3]){ a.mean[m].size.wavelength, a.theta[i], a.mean[m].p[i] });
		free(a.mean[m].p);
	}
	tab_finish(out);
	for (size_t i = 0; i < a.nw; i++)
		waves_free(&a.w[i]);
	free(a.w);
	free(a.mean);
	free(a.theta);
	size_quadrature_free(a.sub);
}

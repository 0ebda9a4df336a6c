#include "pipe/phase.h"

#include "base/ascending.h"
#include "base/die.h"
#include "optics/angles.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BATCH_WAVES 64            /* read together, at least; whole sizes */
#define BATCH_TERMS 1000000       /* fewer where the coefficients read are many */
#define CHUNK_ANGLES 500000       /* computed together, at most, but for one particle's */
#define CHUNK_X 20000             /* adapted together: sum of size parameters, at most, but for one particle's */
#define BLOCK 4096                /* angles of a row of waves, handed on together */

struct batch {
	struct waves *w;
	double *x_grid;           /* the x whose grid serves where it depends on x: the largest of the size, over its wavelengths */
	size_t n, room;
};

/* Rows of one phase function in the making. */
struct mean {
	double wavelength, weight;
	double *p;                /* [n] */
};

struct job {
	const struct phase_options *o;
	struct coeffs *in;
	phase_model *model;
	const void *context;
	struct tab_out *out;
	int nkey, ncarried;
	int n;                    /* angles for all, 0: a grid for each size */
	double *theta;
	int weight_col;           /* among the carried columns; average only */
	struct mean *mean;
	size_t nmean;
};

static void check_weight(const struct job *j, const struct size *size)
{
	double weight = size->carried[j->weight_col];
	if (!(weight >= 0) || isinf(weight))
		die(tab_path(coeffs_table(j->in)), "weight %g of radius %g um is not a fraction", weight, size->radius);
}

/* Read whole sizes until a batch is full. next is what was read ahead, unless *more is 0. */
static void gather(struct job *j, struct batch *b, struct waves *next, int *more, int everything)
{
	size_t terms = 0, group = 0;
	b->n = 0;
	while (*more && (everything || !next->size.first || (b->n < BATCH_WAVES && terms < BATCH_TERMS))) {
		if (b->n == b->room) {
			b->room = 2 * b->room + BATCH_WAVES;
			b->w = xgrow(b->w, b->room, sizeof *b->w);
			b->x_grid = xgrow(b->x_grid, b->room, sizeof *b->x_grid);
		}
		if (next->size.first)
			group = b->n;
		if (j->o->average)
			check_weight(j, &next->size);
		b->w[b->n] = *next;
		double x = size_extent(&next->size);
		b->x_grid[b->n++] = x;
		if (b->n - 1 > group && x > b->x_grid[group])
			b->x_grid[group] = x;
		terms += (size_t)next->n;
		*more = coeffs_next(j->in, next);
	}
	for (size_t i = 1; i < b->n; i++)
		if (!b->w[i].size.first)
			b->x_grid[i] = b->x_grid[i - 1];
}

static void put_rows(struct job *j, const struct waves *w, int n, const double *theta, const struct phase_result *r)
{
	double row[TAB_COLS];
	int k = coeffs_key(j->in, &w->size, row);
	memcpy(row + k + 6, w->size.carried, (size_t)j->ncarried * sizeof *row);
	for (int i = 0; i < n; i++) {
		double re1 = creal(r->s1[i]), im1 = cimag(r->s1[i]), re2 = creal(r->s2[i]), im2 = cimag(r->s2[i]);
		row[k] = theta[i];
		row[k + 1] = re1;
		row[k + 2] = im1;
		row[k + 3] = re2;
		row[k + 4] = im2;
		row[k + 5] = (re1 * re1 + im1 * im1 + re2 * re2 + im2 * im2) / (2 * r->norm);
		tab_put(j->out, row);
	}
}

/* The mean of a wavelength, begun where there is none. */
static size_t mean_of(struct job *j, double wavelength)
{
	size_t at = 0;
	while (at < j->nmean && fabs(j->mean[at].wavelength / wavelength - 1) > 1e-9)
		at++;
	if (at == j->nmean) {
		j->mean = xgrow(j->mean, ++j->nmean, sizeof *j->mean);
		j->mean[at] = (struct mean){ wavelength, 0, xalloc((size_t)j->n, sizeof(double)) };
	}
	return at;
}

static double mean_weight(const struct job *j, const struct size *size, double q_sca)
{
	return size->carried[j->weight_col] * q_sca * size->radius * size->radius;
}

static void add_mean(struct job *j, const struct waves *w, int n, const struct phase_result *r)
{
	size_t at = mean_of(j, w->size.wavelength);
	struct mean *mean = &j->mean[at];
	double weight = mean_weight(j, &w->size, r->q_sca);
	for (int i = 0; i < n; i++) {
		double re1 = creal(r->s1[i]), im1 = cimag(r->s1[i]), re2 = creal(r->s2[i]), im2 = cimag(r->s2[i]);
		mean->p[i] += weight * ((re1 * re1 + im1 * im1 + re2 * re2 + im2 * im2) / (2 * r->norm));
	}
	mean->weight += weight;
}

static int count(const struct job *j, double x)
{
	return j->n ? j->n : angles_count(x);
}

/* Compute waves at[0 .. n), in parallel where there are several, and hand them on in order. */
static void chunk(struct job *j, struct waves *w, const double *x_grid, size_t n, size_t angles)
{
	double *theta = xalloc(angles, sizeof *theta);
	double complex *s = xalloc(2 * angles, sizeof *s);
	struct phase_result *r = xalloc(n, sizeof *r);
	size_t *at = xalloc(n + 1, sizeof *at);
	int failed = 0;
	for (size_t i = 0; i < n; i++)
		at[i + 1] = at[i] + (size_t)count(j, x_grid[i]);
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n > 1)
	for (size_t i = 0; i < n; i++) {
		int na = (int)(at[i + 1] - at[i]);
		double *t = theta + at[i];
		if (j->n)
			memcpy(t, j->theta, (size_t)na * sizeof *t);
		else
			angles_grid(x_grid[i], t);
		r[i].s1 = s + at[i];
		r[i].s2 = s + angles + at[i];
		failed |= j->model(j->context, &w[i], na, t, &r[i]) != 0;
		waves_drop(&w[i]);    /* the coefficients of a whole chunk can be too many */
	}
	if (failed)
		die(NULL, "out of memory");
	for (size_t i = 0; i < n; i++) {
		if (j->o->average)
			add_mean(j, &w[i], (int)(at[i + 1] - at[i]), &r[i]);
		else
			put_rows(j, &w[i], (int)(at[i + 1] - at[i]), theta + at[i], &r[i]);
		waves_free(&w[i]);
	}
	free(theta);
	free(s);
	free(r);
	free(at);
}

static void compute(struct job *j, const struct batch *b)
{
	for (size_t from = 0, to; from < b->n; from = to) {
		size_t angles = (size_t)count(j, b->x_grid[from]);
		for (to = from + 1; to < b->n && angles + (size_t)count(j, b->x_grid[to]) <= CHUNK_ANGLES; to++)
			angles += (size_t)count(j, b->x_grid[to]);
		chunk(j, b->w + from, b->x_grid + from, to - from, angles);
	}
}

/* The rows of a size whose angles were found: amplitudes again, in blocks. */
static void put_adapted(struct job *j, const struct adapted *a)
{
	const struct phase_profile *profile = j->o->profile;
	double complex *s = xalloc(2 * BLOCK, sizeof *s);
	for (size_t i = 0; i < a->nwaves; i++)
		for (long from = 0; from < a->n; from += BLOCK) {
			int count = a->n - from < BLOCK ? (int)(a->n - from) : BLOCK;
			if (profile->at(a->state[i], count, a->theta + from, s, s + BLOCK))
				die(NULL, "out of memory");
			struct phase_result r = { s, s + BLOCK, a->state[i]->norm, a->state[i]->q_sca };
			put_rows(j, &a->w[i], count, a->theta + from, &r);
		}
	free(s);
}

/* A batch of whole sizes, each on angles of its own; in parallel where there are several. */
static void compute_adapted(struct job *j, const struct batch *b)
{
	struct adapted *a = xalloc(b->n, sizeof *a);
	for (size_t from = 0, to; from < b->n; from = to) {
		size_t n = 0;
		double x = 0;
		int failed = 0;
		for (to = from; to < b->n; to++) {
			if (b->w[to].size.first || to == from) {
				if (n && x > CHUNK_X)
					break;
				a[n++] = (struct adapted){ .w = &b->w[to] };
			}
			a[n - 1].nwaves++;
			x += b->w[to].size.x;
		}
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n > 1)
		for (size_t i = 0; i < n; i++)
			failed |= adapt(j->o->profile, j->context, j->o->tolerance, &a[i]) != 0;
		if (failed)
			die(NULL, "out of memory");
		for (size_t i = 0; i < n; i++) {
			put_adapted(j, &a[i]);
			adapt_free(j->o->profile, &a[i]);
		}
	}
	for (size_t i = 0; i < b->n; i++)
		waves_free(&b->w[i]);
	free(a);
}

/* Add waves[0 .. n) to their means on j->theta: blocks of angles in parallel, waves in order. */
static void add_adapted(struct job *j, struct waves *w, size_t n)
{
	const struct phase_profile *profile = j->o->profile;
	struct phase_state **state = xalloc(n, sizeof *state);
	size_t *mean = xalloc(n, sizeof *mean);
	double *weight = xalloc(n, sizeof *weight);
	int failed = 0;
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n > 1)
	for (size_t i = 0; i < n; i++)
		failed |= !(state[i] = profile->open(j->context, &w[i], (size_t)j->n));
	if (failed)
		die(NULL, "out of memory");
	for (size_t i = 0; i < n; i++) {
		mean[i] = mean_of(j, w[i].size.wavelength);
		j->mean[mean[i]].weight += weight[i] = mean_weight(j, &w[i].size, state[i]->q_sca);
	}
#pragma omp parallel for schedule(dynamic) reduction(|:failed)
	for (int from = 0; from < j->n; from += BLOCK) {
		int count = j->n - from < BLOCK ? j->n - from : BLOCK;
		double p[BLOCK];
		for (size_t i = 0; i < n; i++) {
			failed |= adapt_p(profile, state[i], count, j->theta + from, p);
			for (int k = 0; !failed && k < count; k++)
				j->mean[mean[i]].p[from + k] += weight[i] * p[k];
		}
	}
	if (failed)
		die(NULL, "out of memory");
	for (size_t i = 0; i < n; i++) {
		profile->close(state[i]);
		waves_free(&w[i]);
	}
	free(state);
	free(mean);
	free(weight);
}

static void average_adapted(struct job *j, const struct batch *b, double x)
{
	long n = angles_fine(x, j->o->tolerance, NULL);
	if (n > INT_MAX)
		die(NULL, "size parameter %g wants too many angles", x);
	j->n = (int)n;
	j->theta = xgrow(j->theta, (size_t)n, sizeof *j->theta);
	angles_fine(x, j->o->tolerance, j->theta);
	for (size_t from = 0, to; from < b->n; from = to) {
		double sum = 0;
		for (to = from; to < b->n && (to == from || sum + b->w[to].size.x <= CHUNK_X); to++)
			sum += b->w[to].size.x;
		add_adapted(j, b->w + from, to - from);
	}
}

/* Leave those of the means' angles that serve them all. */
static void thin_means(struct job *j)
{
	double **p = xalloc(j->nmean, sizeof *p);
	long *keep = xalloc((size_t)j->n, sizeof *keep);
	for (size_t m = 0; m < j->nmean; m++) {
		p[m] = j->mean[m].p;
		for (int i = 0; i < j->n; i++)
			p[m][i] /= j->mean[m].weight;
		j->mean[m].weight = 1;
	}
	long n = angles_thin(j->n, j->theta, (int)j->nmean, p, j->o->tolerance, keep);
	if (n < 0)
		die(NULL, "out of memory");
	for (long i = 0; i < n; i++) {
		j->theta[i] = j->theta[keep[i]];
		for (size_t m = 0; m < j->nmean; m++)
			p[m][i] = p[m][keep[i]];
	}
	j->n = (int)n;
	free(p);
	free(keep);
}

static void choose_angles(struct job *j)
{
	if (j->o->theta.n && j->o->angles)
		die("--angles", "excludes --theta");
	size_t n = j->o->theta.n ? j->o->theta.n : (size_t)j->o->angles;
	j->theta = xalloc(n, sizeof *j->theta);
	if (j->o->angles)
		angles_equal((int)n, j->theta);
	else if (n) {
		memcpy(j->theta, j->o->theta.v, n * sizeof *j->theta);
		qsort(j->theta, n, sizeof *j->theta, ascending);
	}
	j->n = (int)n;
	for (size_t i = 1; i < n; i++)
		if (j->theta[i] == j->theta[i - 1])
			die("--theta", "%g stands twice", j->theta[i]);
}

static const struct tab_col theta_col = { "theta", TAB_F64, "deg" }, p_col = { "p", TAB_F64, "sr^-1" };

static void each(struct job *j, const char *output, const char *command)
{
	static const struct tab_col amplitudes[4] = {
		{ "s1_re", TAB_F64, "1" }, { "s1_im", TAB_F64, "1" }, { "s2_re", TAB_F64, "1" }, { "s2_im", TAB_F64, "1" },
	};
	struct tab_col cols[TAB_COLS];
	struct batch b = { 0 };
	struct waves next;
	int k = coeffs_columns(j->in, cols);
	cols[k] = theta_col;
	memcpy(cols + k + 1, amplitudes, sizeof amplitudes);
	cols[k + 5] = p_col;
	j->ncarried = coeffs_carried(j->in, k + 6, cols, cols + k + 6);
	int more = coeffs_next(j->in, &next);
	gather(j, &b, &next, &more, 0);
	j->out = tab_create(output, coeffs_history(j->in), command, k + 6 + j->ncarried, cols);
	for (; b.n; gather(j, &b, &next, &more, 0))
		if (j->n || !j->o->profile)
			compute(j, &b);
		else
			compute_adapted(j, &b);
	tab_finish(j->out);
	free(b.w);
	free(b.x_grid);
}

static void average(struct job *j, const char *output, const char *command)
{
	const struct tab_col cols[3] = { { "wavelength", TAB_F64, "um" }, theta_col, p_col };
	struct tab_col carried[TAB_COLS];
	struct batch b = { 0 };
	struct waves next;
	if (!coeffs_table(j->in))
		die("--average", "needs a table with a column weight");
	tab_need(coeffs_table(j->in), "weight", "1");
	if (coeffs_by_x(j->in))
		die("--average", "needs radii and wavelengths");
	j->ncarried = coeffs_carried(j->in, 2, (struct tab_col[2]){ cols[0], { "radius", TAB_F64, "um" } }, carried);
	while (strcmp(carried[j->weight_col].name, "weight"))
		j->weight_col++;
	int more = coeffs_next(j->in, &next);
	gather(j, &b, &next, &more, 1);
	double x = 0;
	for (size_t i = 0; i < b.n; i++)
		x = fmax(x, b.x_grid[i]);
	int adapted = !j->n && j->o->profile;
	if (adapted) {
		average_adapted(j, &b, x);
	} else if (!j->n) {
		j->n = angles_count(x);
		j->theta = xgrow(j->theta, (size_t)j->n, sizeof *j->theta);
		angles_grid(x, j->theta);
	}
	if (!adapted)
		compute(j, &b);
	for (size_t m = 0; m < j->nmean; m++)
		if (!(j->mean[m].weight > 0))
			die(tab_path(coeffs_table(j->in)), "all weights are 0");
	if (adapted)
		thin_means(j);
	j->out = tab_create(output, coeffs_history(j->in), command, 3, cols);
	for (size_t m = 0; m < j->nmean; m++) {
		for (int i = 0; i < j->n; i++)
			tab_put(j->out, (double[3]){ j->mean[m].wavelength, j->theta[i], j->mean[m].p[i] / j->mean[m].weight });
		free(j->mean[m].p);
	}
	tab_finish(j->out);
	free(j->mean);
	free(b.w);
	free(b.x_grid);
}

void phase_table(const struct phase_options *o, struct coeffs *in, phase_model *model, const void *context,
                 const char *output, const char *command)
{
	struct job j = { .o = o, .in = in, .model = model, .context = context };
	choose_angles(&j);
	if (o->average)
		average(&j, output, command);
	else
		each(&j, output, command);
	free(j.theta);
}

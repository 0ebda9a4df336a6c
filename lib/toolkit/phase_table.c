#include "toolkit/phase_table.h"

#include "toolkit/ensemble_average.h"

#include "base/ascending.h"
#include "base/die.h"
#include "optics/phase/angle_grid.h"

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

struct job {
	const struct phase_options *o;
	struct coeffs *in;
	phase_model *model;
	const void *context;
	struct tab_out *out;
	int n;                    /* angles for all, 0: a grid for each size */
	double *theta;
};

/* Read whole sizes until a batch is full. next is what was read ahead, unless *more is 0. */
static void gather(struct job *j, struct batch *b, struct waves *next, int *more)
{
	size_t terms = 0, group = 0;
	b->n = 0;
	while (*more && (!next->size.first || (b->n < BATCH_WAVES && terms < BATCH_TERMS))) {
		if (b->n == b->room) {
			b->room = 2 * b->room + BATCH_WAVES;
			b->w = xgrow(b->w, b->room, sizeof *b->w);
			b->x_grid = xgrow(b->x_grid, b->room, sizeof *b->x_grid);
		}
		if (next->size.first)
			group = b->n;
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
	coeffs_carry(j->in, w, row + k + 6);
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

static void tell(const struct job *j, const struct size *size, const struct phase_result *r)
{
	char at[SIZE_NAME];
	if (j->o->verbose && r->method)
		warn("verbose", "%s: method %s, estimated error %.2g", size_name(size, at), r->method, r->error);
}

static int count(const struct job *j, double x)
{
	return j->n ? j->n : angle_grid_count(x);
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
			angle_grid(x_grid[i], t);
		r[i].s1 = s + at[i];
		r[i].s2 = s + angles + at[i];
		failed |= j->model(j->context, &w[i], na, t, &r[i]) != 0;
		waves_drop(&w[i]);    /* the coefficients of a whole chunk can be too many */
	}
	if (failed)
		die(NULL, "out of memory");
	for (size_t i = 0; i < n; i++) {
		put_rows(j, &w[i], (int)(at[i + 1] - at[i]), theta + at[i], &r[i]);
		tell(j, &w[i].size, &r[i]);
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
			struct phase_result r = { .s1 = s, .s2 = s + BLOCK, .norm = a->state[i]->norm, .q_sca = a->state[i]->q_sca };
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

static void choose_angles(struct job *j)
{
	if (j->o->theta.n && j->o->angles)
		die("--angles", "excludes --theta");
	size_t n = j->o->theta.n ? j->o->theta.n : (size_t)j->o->angles;
	j->theta = xalloc(n, sizeof *j->theta);
	if (j->o->angles)
		angle_grid_equal((int)n, j->theta);
	else if (n) {
		memcpy(j->theta, j->o->theta.v, n * sizeof *j->theta);
		qsort(j->theta, n, sizeof *j->theta, ascending);
	}
	j->n = (int)n;
	for (size_t i = 1; i < n; i++)
		if (j->theta[i] == j->theta[i - 1])
			die("--theta", "%g stands twice", j->theta[i]);
}

const struct tab_col phase_theta_col = { "theta", TAB_F64, "deg" }, phase_p_col = { "p", TAB_F64, "sr^-1" };

static void each(struct job *j, const char *output, const char *command)
{
	static const struct tab_col amplitudes[4] = {
		{ "s1_re", TAB_F64, "1" }, { "s1_im", TAB_F64, "1" }, { "s2_re", TAB_F64, "1" }, { "s2_im", TAB_F64, "1" },
	};
	struct tab_col cols[TAB_COLS];
	struct batch b = { 0 };
	struct waves next;
	int k = coeffs_columns(j->in, cols);
	cols[k] = phase_theta_col;
	memcpy(cols + k + 1, amplitudes, sizeof amplitudes);
	cols[k + 5] = phase_p_col;
	int ncarried = coeffs_carried(j->in, k + 6, cols, cols + k + 6);
	int more = coeffs_next(j->in, &next);
	gather(j, &b, &next, &more);
	j->out = tab_create(output, coeffs_history(j->in), command, k + 6 + ncarried, cols);
	for (; b.n; gather(j, &b, &next, &more))
		if (j->n || !j->o->profile)
			compute(j, &b);
		else
			compute_adapted(j, &b);
	tab_finish(j->out);
	free(b.w);
	free(b.x_grid);
}

void phase_table(const struct phase_options *o, struct coeffs *in, phase_model *model, const void *context,
                 const char *output, const char *command)
{
	struct job j = { .o = o, .in = in, .model = model, .context = context };
	choose_angles(&j);
	if (o->average)
		average_table(o, in, model, context, j.n, j.theta, output, command);
	else
		each(&j, output, command);
	free(j.theta);
}

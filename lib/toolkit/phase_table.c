#include "toolkit/phase_table.h"

#include "toolkit/angle_refinement.h"
#include "toolkit/ensemble_average.h"

#include "base/ascending.h"
#include "base/die.h"
#include "format/columns.h"
#include "optics/phase/angle_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BATCH_WAVES 64            /* read together, at least; whole sizes */
#define BATCH_TERMS 1000000       /* fewer where the coefficients read are many */
#define CHUNK_ANGLES 500000       /* computed together, at most, but for one particle's */
#define CHUNK_X 20000             /* refined together: sum of size parameters, at most, but for one particle's */
#define BLOCK 4096                /* angles of a row of waves, handed on together */
#define TOGETHER 64               /* rows of which the elements are found together */
#define PEAK 0.69                 /* x times the distance of equal angles, rad: there the forward peak puts p's integral off by 1 % */
#define OWN (5 + PHASE_ELEMENTS)  /* columns: theta, amplitudes, elements */

struct batch {
	struct waves *w;
	double *x_grid;           /* the x whose grid serves where it depends on x: the largest of the size, over its wavelengths */
	size_t n, room;
};

struct job {
	const struct phase_options *o;
	struct spheres *in;
	const struct phase_model *model;
	struct class_table *table;    /* NULL: rows come from in */
	size_t row;               /* of it, that comes next */
	struct tab_out *out;
	int n;                    /* angles for all, 0: a grid for each size */
	double *theta;
};

static int next_waves(struct job *j, struct waves *out)
{
	if (!j->table)
		return spheres_next(j->in, out);
	if (j->row == j->table->n)
		return 0;
	struct class_row *row = &j->table->row[j->row++];
	*out = row->w;
	row->w = (struct waves){ 0 };      /* who takes it frees it */
	return 1;
}

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
		*more = next_waves(j, next);
	}
	for (size_t i = 1; i < b->n; i++)
		if (!b->w[i].size.first)
			b->x_grid[i] = b->x_grid[i - 1];
}

static void put_rows(struct job *j, const struct waves *w, int n, const double *theta, double norm, const double complex *s1,
                     const double complex *s2)
{
	double row[TAB_COLS];
	int k = spheres_key(j->in, &w->size, row);
	spheres_carry(j->in, w, row + k + OWN);
	for (int from = 0; from < n; from += TOGETHER) {
		double value[PHASE_ELEMENTS * TOGETHER];
		int count = n - from < TOGETHER ? n - from : TOGETHER;
		phase_model_elements(norm, count, s1 + from, s2 + from, TOGETHER, value);
		for (int i = 0; i < count; i++) {
			row[k] = theta[from + i];
			row[k + 1] = creal(s1[from + i]);
			row[k + 2] = cimag(s1[from + i]);
			row[k + 3] = creal(s2[from + i]);
			row[k + 4] = cimag(s2[from + i]);
			for (int e = 0; e < PHASE_ELEMENTS; e++)
				row[k + 5 + e] = value[e * TOGETHER + i];
			tab_put(j->out, row);
		}
	}
}

static void tell(const struct job *j, const struct size *size, const struct phase_sphere *r)
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
	double complex *s1 = xalloc(2 * angles, sizeof *s1), *s2 = s1 + angles;
	struct phase_sphere *known = xalloc(n, sizeof *known);
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
		failed |= phase_model_once(j->model, &w[i], na, t, s1 + at[i], s2 + at[i], &known[i]) != 0;
	}
	if (failed)
		die(NULL, "out of memory");
	for (size_t i = 0; i < n; i++) {
		put_rows(j, &w[i], (int)(at[i + 1] - at[i]), theta + at[i], known[i].norm, s1 + at[i], s2 + at[i]);
		tell(j, &w[i].size, &known[i]);
		waves_free(&w[i]);
	}
	free(theta);
	free(s1);
	free(known);
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
static void put_refined(struct job *j, const struct angle_refinement *a)
{
	double complex *s1 = xalloc(2 * BLOCK, sizeof *s1), *s2 = s1 + BLOCK;
	for (size_t i = 0; i < a->nwaves; i++)
		for (long from = 0; from < a->n; from += BLOCK) {
			int count = a->n - from < BLOCK ? (int)(a->n - from) : BLOCK;
			if (j->model->at(a->sphere[i], count, a->theta + from, s1, s2))
				die(NULL, "out of memory");
			put_rows(j, &a->w[i], count, a->theta + from, a->sphere[i]->norm, s1, s2);
		}
	free(s1);
}

/* A batch of whole sizes, each on angles of its own; in parallel where there are several. */
static void compute_refined(struct job *j, const struct batch *b)
{
	struct angle_refinement *a = xalloc(b->n, sizeof *a);
	for (size_t from = 0, to; from < b->n; from = to) {
		size_t n = 0;
		double x = 0;
		int failed = 0;
		for (to = from; to < b->n; to++) {
			if (b->w[to].size.first || to == from) {
				if (n && x > CHUNK_X)
					break;
				a[n++] = (struct angle_refinement){ .w = &b->w[to] };
			}
			a[n - 1].nwaves++;
			x += b->w[to].size.x;
		}
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n > 1)
		for (size_t i = 0; i < n; i++)
			failed |= (int[]){ 1, 0, 2 }[1 + angle_refinement_find(j->model, j->o->tolerance, &a[i])];
		if (failed & 2)
			die("--tolerance", "%g takes too many angles at such size parameters; choose them by --angles or --theta, or allow more",
			    j->o->tolerance);
		if (failed)
			die(NULL, "out of memory");
		for (size_t i = 0; i < n; i++) {
			put_refined(j, &a[i]);
			angle_refinement_free(j->model, &a[i]);
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

/* The key's columns, *k, those of OWN, and what is carried; returns how many that is. */
static int columns(struct spheres *in, struct tab_col *cols, int *k)
{
	const struct tab_col own[OWN] = { column_theta, column_s1_re, column_s1_im, column_s2_re, column_s2_im, column_p };
	*k = spheres_key_columns(in, cols);
	memcpy(cols + *k, own, sizeof own);
	return spheres_carried(in, *k + OWN, cols, cols + *k + OWN);
}

static void each(struct job *j, const char *output, const char *command)
{
	struct tab_col cols[TAB_COLS];
	struct batch b = { 0 };
	struct waves next;
	int k, ncarried = columns(j->in, cols, &k);
	int more = next_waves(j, &next);
	gather(j, &b, &next, &more);
	j->out = tab_create(output, spheres_history(j->in), command, spheres_law(j->in), k + OWN + ncarried,
	                    cols);
	for (; b.n; gather(j, &b, &next, &more))
		if (j->n || !j->model->any_angles)
			compute(j, &b);
		else
			compute_refined(j, &b);
	tab_finish(j->out);
	free(b.w);
	free(b.x_grid);
}

/* What equal angles make of the integral of p over the sphere, as linear between them: 1 + this. A large sphere diffracts half of
 * what it scatters, into p ~ (2 J1(z)/z)^2 with z = x theta; at z = 0, h, 2h .. its trapezoids hold h^2/6 + sum 4 J1(i h)^2 / i in
 * place of 2. About h^2/48 while h is small. */
static double peak_excess(double h)
{
	double sum = h * h / 6;
	int i = 1;
	for (; i <= 1000 || (i <= 1000000 && i * h < 1000); i++)
		sum += 4 * j1(i * h) * j1(i * h) / i;
	return (sum + 4 / (M_PI * h * i) - 2) / 4;    /* beyond, J1(z)^2 is 1/(pi z) in the mean */
}

/* Equal angles that are too few for the forward peak are told once. */
static void check_peak(const struct phase_options *o, const struct spheres *in)
{
	double x = spheres_extent(in, o->average), h = x * M_PI / (double)(o->angles - 1);
	if (h <= PEAK)
		return;
	warn("--angles", "%lld are too few for the forward peak of x = %.4g%s: taken as linear between them, p integrates to about %.3g, not 1; "
	     "take %.0f or more, or leave --angles out", o->angles, x, o->average ? ", in the mean" : "", 1 + peak_excess(h), ceil(M_PI * x / PEAK) + 1);
}

void phase_table(const struct phase_options *o, struct spheres *in, const struct phase_model *model, const char *output,
                 const char *command)
{
	struct tab_col cols[TAB_COLS];
	struct job j = { .o = o, .in = in, .model = model };
	choose_angles(&j);
	if (o->average)
		class_table_need(in);
	if (o->average || (class_table_in(in) && !o->at_radius)) {
		int k, ncarried = columns(in, cols, &k);
		j.table = class_table_read(in, ncarried, cols + k + OWN, o->at_radius);
	}
	if (o->average)
		ensemble_average_table(o, j.table, model, j.n, j.theta, output, command);
	else if (j.table && j.table->classes)
		ensemble_class_table(o, j.table, model, j.n, j.theta, output, command);
	else
		each(&j, output, command);
	if (j.table)
		class_table_free(j.table);
	if (o->angles)
		check_peak(o, in);
	if (!o->at_radius)
		spheres_warn_classes(in);
	free(j.theta);
}

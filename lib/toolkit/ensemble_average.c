#include "toolkit/ensemble_average.h"

#include "base/die.h"
#include "format/columns.h"
#include "optics/phase/angle_grid.h"
#include "toolkit/phase_means.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A phase function a wavelength, on angles that they share. */
struct curves {
	size_t n;
	const struct phase_means **means;
	size_t *group;
	long angles;
	double *theta, **value;    /* value[n][PHASE_ELEMENTS][angles] */
};

static void evaluate(struct curves *c)
{
	for (size_t i = 0; i < c->n; i++) {
		c->value[i] = xalloc(PHASE_ELEMENTS * (size_t)c->angles, sizeof **c->value);
		phase_means_at(c->means[i], c->group[i], c->angles, c->theta, c->value[i]);
	}
}

/* As few angles as serve all. */
static void thin(struct curves *c, double tolerance)
{
	const size_t curves = c->n * PHASE_ELEMENTS;
	double **curve = xalloc(curves, sizeof *curve);
	long *keep = xalloc((size_t)c->angles, sizeof *keep);
	for (size_t k = 0; k < curves; k++)
		curve[k] = c->value[k / PHASE_ELEMENTS] + k % PHASE_ELEMENTS * (size_t)c->angles;
	long n = angle_grid_thin(c->angles, c->theta, (int)curves, curve, tolerance, keep);
	if (n < 0)
		die(NULL, "out of memory");
	for (long i = 0; i < n; i++) {
		c->theta[i] = c->theta[keep[i]];
		for (size_t k = 0; k < curves; k++)
			curve[k][i] = curve[k][keep[i]];
	}
	for (size_t k = 0; k < curves; k++)    /* without gaps between the elements */
		memmove(c->value[k / PHASE_ELEMENTS] + k % PHASE_ELEMENTS * (size_t)n, curve[k], (size_t)n * sizeof **curve);
	c->angles = n;
	free(curve);
	free(keep);
}

/* Angles of their own for size parameters up to x, of so many curves. */
static long own_angles(const struct phase_options *o, double x, size_t curves)
{
	long n = angle_grid_fine(x, o->tolerance / 2, NULL);
	if (n < 0 || (double)n * PHASE_ELEMENTS * (double)curves > ANGLE_GRID_MOST)
		die(NULL, "the sizes want too many angles; choose them by --angles or --theta, or allow more by --tolerance");
	return n;
}

/* Values at given angles, or at angles of their own. */
static void settle(struct curves *c, const struct phase_options *o, long n, const double *theta)
{
	double x = 0;
	for (size_t i = 0; i < c->n; i++)
		x = fmax(x, c->means[i]->x);
	c->value = xalloc(c->n, sizeof *c->value);
	c->angles = n ? n : own_angles(o, x, c->n);
	c->theta = xalloc((size_t)c->angles, sizeof *c->theta);
	if (n)
		memcpy(c->theta, theta, (size_t)n * sizeof *theta);
	else
		angle_grid_fine(x, o->tolerance / 2, c->theta);
	evaluate(c);
	if (!n)
		thin(c, o->tolerance / 2);
}

static void forget(struct curves *c)
{
	for (size_t i = 0; i < c->n; i++)
		free(c->value[i]);
	free(c->value);
	free(c->theta);
}

/* What is left of the tolerance by the worst wavelength. */
static void tell(const struct phase_options *o, const struct class_table *t, size_t n, struct phase_means *const *m)
{
	double error = 0, open = 0;
	long sizes = 0;
	for (size_t i = 0; i < n; i++) {
		error = fmax(error, m[i]->error);
		open = fmax(open, m[i]->open);
		sizes += m[i]->sizes;
	}
	if (open > o->tolerance / 2)
		warn(class_table_path(t), "means over sizes are uncertain by %.2g, more than %.2g: the classes do not say how many particles of which size are in them",
		     open, o->tolerance / 2);
	else if (error > o->tolerance / 2)
		warn(class_table_path(t), "means over sizes have an estimated error of %.2g, more than %.2g, after %ld sizes", error, o->tolerance / 2, sizes);
	if (o->verbose && sizes)
		warn("verbose", "means over %ld sizes in all; estimated error at most %.2g", sizes, error + open);
}

/* The largest size parameter of the table's rows and classes. */
static double largest(const struct class_table *t)
{
	double x = 0;
	for (size_t i = 0; i < t->n; i++) {
		const struct class_row *row = &t->row[i];
		double most = row->class < 0 ? 1 : t->class[row->class].hi / row->w.size.radius;
		x = fmax(x, size_extent(&row->w.size) * most);
	}
	return x;
}

/* Angles for a model that is asked for given ones: those of the largest x. */
static void given_angles(struct phase_means_request *r, double **own)
{
	double x = largest(r->table);
	r->n = angle_grid_count(x);
	r->theta = *own = xalloc((size_t)r->n, sizeof **own);
	angle_grid(x, *own);
}

static struct phase_means **means_of(const struct phase_options *o, const struct phase_means_request *r)
{
	const struct class_table *t = r->table;
	struct phase_means **m = xalloc(t->waves, sizeof *m);
	for (size_t w = 0; w < t->waves; w++)
		m[w] = phase_means_new(r, w);
	tell(o, t, t->waves, m);
	return m;
}

static void free_means(size_t n, struct phase_means **m)
{
	for (size_t i = 0; i < n; i++)
		phase_means_free(m[i]);
	free(m);
}

static void put(struct tab_out *out, const struct curves *c, size_t i, int key, double *row)
{
	for (long k = 0; k < c->angles; k++) {
		row[key] = c->theta[k];
		for (int e = 0; e < PHASE_ELEMENTS; e++)
			row[key + 1 + e] = c->value[i][e * c->angles + k];
		tab_put(out, row);
	}
}

void ensemble_average_table(const struct phase_options *o, const struct class_table *t, const struct phase_model *model, long n,
                            const double *theta, const char *output, const char *command)
{
	const struct tab_col cols[] = { column_wavelength, column_theta, column_p };
	struct phase_means_request r = { t, model, 1, o->tolerance / 2, n, theta };
	double *own = NULL;
	if (!model->any_angles && !n)
		given_angles(&r, &own);
	else if (!n)
		own_angles(o, largest(t), t->waves);      /* refused before the work */
	struct phase_means **m = means_of(o, &r);
	struct curves c = { .n = t->waves, .means = (const struct phase_means **)m, .group = xalloc(t->waves, sizeof *c.group) };
	settle(&c, o, model->any_angles ? n : r.n, r.theta);
	struct tab_out *out = tab_create(output, spheres_history(t->in), command, spheres_law(t->in), 2 + PHASE_ELEMENTS, cols);
	for (size_t w = 0; w < t->waves; w++) {
		double row[2 + PHASE_ELEMENTS] = { t->wave[w].wavelength };
		put(out, &c, w, 1, row);
	}
	tab_finish(out);
	forget(&c);
	free(c.group);
	free(own);
	free_means(t->waves, m);
}

void ensemble_class_table(const struct phase_options *o, const struct class_table *t, const struct phase_model *model, long n,
                          const double *theta, const char *output, const char *command)
{
	struct phase_means_request r = { t, model, 0, o->tolerance / 2, n, theta };
	struct tab_col cols[TAB_COLS];
	double *own = NULL, row[TAB_COLS];
	int key = spheres_key_columns(t->in, cols), mine = key + 1 + PHASE_ELEMENTS;
	cols[key] = column_theta;
	cols[key + 1] = column_p;
	memcpy(cols + mine, t->carried, (size_t)t->ncarried * sizeof *cols);
	if (!model->any_angles && !n)
		given_angles(&r, &own);
	struct phase_means **m = means_of(o, &r), **alone = xalloc(t->waves, sizeof *alone);
	struct curves c = { .means = xalloc(t->waves, sizeof *c.means), .group = xalloc(t->waves, sizeof *c.group) };
	struct tab_out *out = tab_create(output, spheres_history(t->in), command, spheres_law(t->in), mine + t->ncarried, cols);
	for (size_t from = 0, to; from < t->n; from = to) {
		size_t single = 0;
		c.n = 0;
		for (to = from; to < t->n && (to == from || !t->row[to].w.size.first); to++) {
			const struct class_row *at = &t->row[to];
			if (at->class < 0)
				alone[single++] = phase_means_of_row(&r, to);
			c.means[c.n] = at->class < 0 ? alone[single - 1] : m[at->wave];
			c.group[c.n++] = at->class < 0 ? 0 : (size_t)at->class;
		}
		settle(&c, o, model->any_angles ? n : r.n, r.theta);
		for (size_t i = from; i < to; i++) {
			spheres_key(t->in, &t->row[i].w.size, row);
			spheres_carry(t->in, &t->row[i].w, row + mine);
			put(out, &c, i - from, key, row);
		}
		forget(&c);
		for (size_t i = 0; i < single; i++)
			phase_means_free(alone[i]);
	}
	tab_finish(out);
	free(c.means);
	free(c.group);
	free(alone);
	free(own);
	free_means(t->waves, m);
}

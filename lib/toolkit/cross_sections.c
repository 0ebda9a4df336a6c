#include "toolkit/cross_sections.h"

#include "base/die.h"
#include "toolkit/ranges.h"
#include "toolkit/size_integral.h"

#include <math.h>
#include <stdlib.h>

#define MOST_WORK 3e9      /* of size parameters together */

void cross_sections_of(struct method_selection *selection, int n, struct waves *w, struct cross_section *out)
{
	struct sphere *sphere = xgrow(NULL, (size_t)n, sizeof *sphere);
	double *error = xgrow(NULL, (size_t)n, sizeof *error);
	struct efficiencies *q = xgrow(NULL, (size_t)n, sizeof *q);
	enum method *used = xgrow(NULL, (size_t)n, sizeof *used);
	int *of = xgrow(NULL, (size_t)n, sizeof *of), many = 0, failed = 0;
	for (int i = 0; i < n; i++) {
		if (w[i].a || w[i].size.x_im > 0)
			continue;
		sphere[many] = (struct sphere){ .x = w[i].size.x, .m = w[i].size.m };
		of[many++] = i;
	}
	if (many && method_selection_many(selection, many, sphere, q, error, used))
		die(NULL, "out of memory");
	for (int k = 0; k < many; k++)
		out[of[k]] = (struct cross_section){ q[k], error[k], used[k] };
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n - many > 1)
	for (int i = 0; i < (many < n ? n : 0); i++) {
		if (!w[i].a && w[i].size.x_im == 0)
			continue;
		if (waves_solve(&w[i]))
			failed = 1;
		else
			out[i].q = waves_efficiencies(&w[i], &out[i].error);
		out[i].method = METHOD_MIE;
		waves_drop(&w[i]);
	}
	if (failed)
		die(NULL, "out of memory");
	free(sphere);
	free(error);
	free(q);
	free(used);
	free(of);
}

/* What is summed over sizes, times weight: um^2 but for the volume. */
enum { SCA, EXT, ABS, G_SCA, BACK, AREA, VOLUME, ERROR, VALUES };    /* ERROR: the methods' own, of ext */

struct sections {
	const struct class_table *t;
	size_t wave;
	struct method_selection *selection;
	enum method method;
	double largest;
};

static void values_of(const struct size *size, const struct cross_section *c, double v[VALUES])
{
	double r = size->radius, area = M_PI * r * r;
	v[SCA] = c->q.sca * area;
	v[EXT] = c->q.ext * area;
	v[ABS] = c->q.abs * area;
	v[G_SCA] = c->q.g * v[SCA];
	v[BACK] = c->q.back * r * r / 4;
	v[AREA] = area;
	v[VOLUME] = 4 * area * r / 3;
	v[ERROR] = c->error * v[EXT];
}

static size_t count_values(void *context, double x)
{
	(void)context, (void)x;
	return VALUES;
}

static void add(void *context, const struct size_part *part, int ways, size_t n, const double *radius,
                const double *const weight[SIZE_WAYS], double *const sum[SIZE_WAYS])
{
	struct sections *s = context;
	struct waves *w = xalloc(n, sizeof *w);
	struct cross_section *c = xalloc(n, sizeof *c);
	(void)part;
	for (size_t i = 0; i < n; i++)
		w[i].size = class_table_size(s->t, s->wave, radius[i]);
	cross_sections_of(s->selection, (int)n, w, c);
	for (size_t i = 0; i < n; i++) {
		double v[VALUES];
		values_of(&w[i].size, &c[i], v);
		for (int way = 0; way < ways; way++)
			for (int k = 0; k < VALUES; k++)
				sum[way][k] += weight[way][i] * v[k];
		if (radius[i] > s->largest) {
			s->largest = radius[i];
			s->method = c[i].method;
		}
	}
	free(w);
	free(c);
}

static double error_of(void *context, const struct size_part *part, const double *change, const double *total)
{
	(void)context, (void)part;
	double g = (change[G_SCA] - change[SCA] * (total[G_SCA] / total[SCA])) / total[SCA];
	return fmax(fmax(fabs(change[EXT] / total[EXT]), fabs(change[SCA] / total[SCA])), fmax(fabs(g), fabs(change[ABS] / total[EXT])));
}

/* What the classes of each group leave open: by how much the ways to rebuild the density differ. */
static void find_open(const struct size_integral *s, struct mean_section *out)
{
	double (*change)[VALUES] = xalloc(s->groups, sizeof *change);
	for (size_t i = 0; i < s->n && size_density_ways(s->density) > 1; i++)
		for (int k = 0; k < VALUES; k++)
			change[s->part[i].group][k] += s->part[i].sum[1][k] - s->part[i].sum[0][k];
	for (size_t g = 0; g < s->groups; g++)
		out[g].open = SIZE_OPEN * error_of(NULL, NULL, change[g], s->total[g]);
	free(change);
}

static struct mean_section mean_of(const double v[VALUES], double weight)
{
	return (struct mean_section){ v[EXT] / weight, v[SCA] / weight, v[ABS] / weight, v[G_SCA] / v[SCA], v[BACK] / weight, v[AREA] / weight,
		v[VOLUME] / weight, fabs(v[ERROR] / v[EXT]), 0, METHOD_MIE, 0 };
}

static double integrate(const struct class_table *t, size_t wave, struct method_selection *selection, double tolerance, int together,
                        struct mean_section *out)
{
	struct sections sections = { t, wave, selection, METHOD_MIE, 0 };
	const struct size *size = &t->wave[wave];
	enum method asked = method_selection_asked(selection);
	int resonates = asked == METHOD_AUTO || asked == METHOD_MIE;
	struct size_integral s = { .density = t->density,
		.integrand = { &sections, size->x / size->radius, size->m, resonates, VALUES, count_values, add, error_of } };
	double left = ranges_add(&s, t, together, tolerance), worst = size_integral_run(&s, tolerance, MOST_WORK);
	for (size_t g = 0; g < s.groups; g++) {
		out[g] = mean_of(s.total[g], together ? 1 : t->class[g].weight);
		out[g].method = sections.method;
		out[g].sizes = s.sizes;
	}
	find_open(&s, out);
	for (size_t g = 0; g < s.groups; g++)
		out[g].error += s.error[g] + out[g].open + left;
	size_integral_free(&s);
	return worst;
}

double cross_sections_classes(const struct class_table *t, size_t wave, struct method_selection *selection, double tolerance,
                              struct mean_section *out)
{
	return integrate(t, wave, selection, tolerance, 0, out);
}

double cross_sections_average(const struct class_table *t, size_t wave, struct method_selection *selection, double tolerance,
                              struct mean_section *out)
{
	double v[VALUES] = { 0 }, weight = 0, worst = 0, error = 0;
	struct mean_section classes = { 0 };
	if (t->classes) {
		worst = integrate(t, wave, selection, tolerance, 1, &classes);
		const double sums[VALUES] = { classes.sca, classes.ext, classes.abs, classes.g * classes.sca, classes.back, classes.area, classes.volume, 0 };
		for (int k = 0; k < VALUES; k++)
			v[k] = sums[k];
		error = classes.error;
		for (int i = 0; i < t->classes; i++)
			weight += t->class[i].weight;
	}
	for (size_t i = 0; i < t->n; i++) {
		const struct class_row *row = &t->row[i];
		struct cross_section c;
		double one[VALUES];
		if (row->class >= 0 || row->wave != wave)
			continue;
		cross_sections_of(selection, 1, &t->row[i].w, &c);
		values_of(&row->w.size, &c, one);
		for (int k = 0; k < VALUES; k++)
			v[k] += row->weight * one[k];
		weight += row->weight;
	}
	if (!(weight > 0 && weight < INFINITY))
		die(class_table_path(t), weight > 0 ? "the sum of weights is out of range" : "all weights are 0");
	*out = mean_of(v, weight);
	out->error += error;
	out->open = classes.open;
	out->sizes = classes.sizes;
	return worst;
}

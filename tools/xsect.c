/* xsect - cross sections and asymmetry parameter of spheres. */
#include "base/die.h"
#include "format/columns.h"
#include "toolkit/cross_sections.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TOLERANCE 1e-6      /* of methods */
#define TOLERANCE_MEAN 5e-5 /* of means over sizes */
#define TOLERANCE_ROUGH 1e-3    /* of an approximation, which is off by more */
#define DARK 1         /* beta above which light is lost within a radius: extinction seen from afar grows as e^beta (mie_host.h) */
#define FAILS 1    /* estimated error from which on a method does not hold */

struct request {
	int average, at_radius;
	double tolerance;          /* of means */
	const char *output, *command;
};

/* The estimate that is worst of what a method did in this run. */
struct worst {
	long long n;
	struct size size;
	double error;
};

/* A host that absorbs too much for an extinction seen from afar. */
struct dark {
	struct size size;
	double ext;
};

static int columns(int by_x, struct tab_col *cols)
{
	const struct tab_col by_size[] = { column_c_ext, column_c_sca, column_c_abs, column_g, column_c_back, column_method, column_error };
	const struct tab_col by_parameter[] = { column_q_ext, column_q_sca, column_q_abs, column_g, column_q_back, column_method,
		column_error };
	memcpy(cols, by_x ? by_parameter : by_size, sizeof by_size);
	return 7;
}

static int values(int by_x, const struct size *size, const struct cross_section *a, double *row)
{
	double area = by_x ? 1 : M_PI * size->radius * size->radius;
	int n = 0;
	row[n++] = a->q.ext * area;
	row[n++] = a->q.sca * area;
	row[n++] = a->q.abs * area;
	row[n++] = a->q.g;
	row[n++] = by_x ? a->q.back : a->q.back * area / (4 * M_PI);
	row[n++] = a->method;
	row[n++] = a->error;
	return n;
}

static int mean_values(const struct mean_section *m, double *row)
{
	const double v[] = { m->ext, m->sca, m->abs, m->g, m->back, m->method, m->error };
	memcpy(row, v, sizeof v);
	return 7;
}

/* What is told of a run. */
struct told {
	struct worst worst[METHODS];
	struct dark dark;
	long sizes;                /* that means took */
	double error, open;        /* of means: the largest */
};

static void tell_row(struct told *t, const struct size *size, enum method method, double error, double ext, double c_ext)
{
	struct worst *most = &t->worst[method];
	if (!most->n++ || !(error <= most->error)) {
		most->size = *size;
		most->error = error;
	}
	if (size->x_im > t->dark.size.x_im && (2 * size->x_im > DARK || !(ext > 0)))
		t->dark = (struct dark){ *size, c_ext };
}

static void tell_mean(struct told *t, const struct mean_section *m, double error)
{
	t->sizes += m->sizes;
	t->error = fmax(t->error, error);
	t->open = fmax(t->open, m->open);
}

/* Rows as they are read, each its own size. */
static void each_size(struct spheres *in, struct method_selection *selection, const struct request *request, int ncols,
                      const struct tab_col *cols, struct told *told)
{
	static struct waves w[SPHERES_BATCH];
	static struct cross_section a[SPHERES_BATCH];
	double row[TAB_COLS];
	int by_x = spheres_by_x(in), n = spheres_batch(in, w);    /* before the table begins: what is wrong with the first row leaves none */
	struct tab_out *out = tab_create(request->output, spheres_history(in), request->command, spheres_law(in), ncols, cols);
	for (; n; n = spheres_batch(in, w)) {
		cross_sections_of(selection, n, w, a);
		for (int i = 0; i < n; i++) {
			int key = spheres_key(in, &w[i].size, row), j = key;
			j += values(by_x, &w[i].size, &a[i], row + j);
			spheres_carry(in, &w[i], row + j);
			tab_put(out, row);
			tell_row(told, &w[i].size, a[i].method, a[i].error, a[i].q.ext, row[key]);
			waves_free(&w[i]);
		}
	}
	tab_finish(out);
}

/* Classes: the mean of each. */
static void each_class(const struct class_table *t, struct method_selection *selection, double tolerance, struct tab_out *out,
                       struct told *told)
{
	double row[TAB_COLS];
	struct mean_section *mean = xalloc((size_t)t->classes * t->waves, sizeof *mean);
	for (size_t w = 0; w < t->waves && t->classes; w++) {
		double error = cross_sections_classes(t, w, selection, tolerance, mean + w * (size_t)t->classes);
		tell_mean(told, &mean[w * (size_t)t->classes], error);
		for (int i = 1; i < t->classes; i++)
			told->open = fmax(told->open, mean[w * (size_t)t->classes + (size_t)i].open);
	}
	for (size_t i = 0; i < t->n; i++) {
		struct class_row *r = &t->row[i];
		int key = spheres_key(t->in, &r->w.size, row), j = key;
		struct cross_section one;
		if (r->class >= 0) {
			const struct mean_section *m = &mean[r->wave * (size_t)t->classes + (size_t)r->class];
			j += mean_values(m, row + j);
			tell_row(told, &r->w.size, m->method, m->error, m->ext, m->ext);
		} else {
			cross_sections_of(selection, 1, &r->w, &one);
			j += values(0, &r->w.size, &one, row + j);
			tell_row(told, &r->w.size, one.method, one.error, one.q.ext, row[key]);
		}
		spheres_carry(t->in, &r->w, row + j);
		tab_put(out, row);
	}
	free(mean);
}

static void average(const struct class_table *t, struct method_selection *selection, double tolerance, const char *output,
                    const char *command, struct told *told)
{
	const struct tab_col cols[] = { column_wavelength, column_c_ext, column_c_sca, column_c_abs, column_g, column_c_back,
		column_radius_eff, column_volume, column_error };
	struct tab_out *out = tab_create(output, spheres_history(t->in), command, spheres_law(t->in), sizeof cols / sizeof *cols, cols);
	for (size_t w = 0; w < t->waves; w++) {
		struct mean_section m;
		tell_mean(told, &m, cross_sections_average(t, w, selection, tolerance, &m));
		tab_put(out, (double[]){ t->wave[w].wavelength, m.ext, m.sca, m.abs, m.g, m.back, m.volume / m.area * 0.75, m.volume, m.error });
	}
	tab_finish(out);
}

static void run(struct spheres *in, struct method_selection *selection, const struct request *request, struct told *told)
{
	struct tab_col cols[TAB_COLS];
	int k = spheres_key_columns(in, cols);
	k += columns(spheres_by_x(in), cols + k);
	int ncarried = spheres_carried(in, k, cols, cols + k);
	if (!request->average && (request->at_radius || !class_table_in(in))) {
		each_size(in, selection, request, k + ncarried, cols, told);
		return;
	}
	if (request->average)
		class_table_need(in);
	struct class_table *t = class_table_read(in, ncarried, cols + k, request->at_radius);
	if (request->average) {
		average(t, selection, request->tolerance, request->output, request->command, told);
	} else {
		struct tab_out *out = tab_create(request->output, spheres_history(in), request->command, spheres_law(in), k + ncarried, cols);
		each_class(t, selection, request->tolerance, out, told);
		tab_finish(out);
	}
	class_table_free(t);
}

/* The worst row of each method: a warning where it does not hold, or what --verbose says. */
static void tell_method(enum method method, const struct worst *w, int verbose)
{
	char at[SIZE_NAME];
	size_name(&w->size, at);
	if (method != METHOD_MIE && !(w->error < FAILS))
		warn(method_table[method].name, "%s: this method does not hold there (estimated error %.2g, worst of this run)", at, w->error);
	if (verbose)
		warn("verbose", "method %s for %lld sizes; estimated error at most %.2g, at %s", method_table[method].name, w->n, w->error, at);
}

/* Where means are worse than was asked for: one line. */
static void tell_means(const char *path, const struct told *t, double tolerance, int verbose)
{
	if (t->open > tolerance)
		warn(path, "means over sizes are uncertain by %.2g, more than %.2g: the classes do not say how many particles of which size are in them",
		     t->open, tolerance);
	else if (t->error > tolerance)
		warn(path, "means over sizes have an estimated error of %.2g, more than %.2g, after %ld sizes", t->error, tolerance, t->sizes);
	if (verbose && t->sizes)
		warn("verbose", "means over %ld sizes in all; estimated error at most %.2g", t->sizes, t->error + t->open);
}

int main(int argc, char **argv)
{
	static struct sizes_options sizes = SIZES_INIT;    /* static: the lists in it live as long as the process */
	static struct told told;
	struct request request = { 0 };
	int method = METHOD_AUTO, verbose = 0;
	double tolerance = -1;
	const struct opt opts[] = {
		SIZES_OPTIONS(sizes),
		{ "--method", OPT_CHOICE, &method, 0, 0, "auto|mie|rayleigh|goa|cam|evans-fournier",
		  "the cheapest within --tolerance, Lorenz-Mie theory, or an approximation", 0 },
		{ "--tolerance", OPT_REAL, &tolerance, 1e-14, 1, "T", "largest error allowed to auto's methods, and to means over sizes", 0 },
		{ "--average", OPT_FLAG, &request.average, 0, 0, NULL, "one row a wavelength: the mean over the sizes, by weight", 0 },
		{ "--at-radius", OPT_FLAG, &request.at_radius, 0, 0, NULL, "a class with limits is its radius alone", 0 },
		{ "--verbose", OPT_FLAG, &verbose, 0, 0, NULL, "say which methods were used and their estimated errors", 1 },
		OPT_OUTPUT(&request.output),
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [SIZES | COEFFICIENTS]",
		"Cross sections and asymmetry parameter of spheres.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one table at most");
	sizes.clear_host = method != METHOD_AUTO && method != METHOD_MIE;
	struct spheres *in = spheres_open(&sizes, args.n ? args.operand[0] : NULL);
	if (spheres_coeffs(in) && method != METHOD_AUTO && method != METHOD_MIE)
		die("--method", "%s has no use for the coefficients in %s", method_table[method].name, spheres_coeffs(in));
	int means = request.average || (!request.at_radius && class_table_in(in));
	if (tolerance >= 0 && method != METHOD_AUTO && !means)
		die("--tolerance", "is for --method auto, and means over sizes");
	/* of a mean's error, half is the methods' and half the sizes' */
	struct method_selection *selection = method_selection_new(method, tolerance < 0 ? TOLERANCE : means ? tolerance / 2 : tolerance);
	int rough = method != METHOD_AUTO && method != METHOD_MIE;
	request.tolerance = tolerance >= 0 ? tolerance / 2 : rough ? TOLERANCE_ROUGH : TOLERANCE_MEAN;
	request.command = args.history;
	if (!selection)
		die(NULL, "out of memory");
	run(in, selection, &request, &told);
	for (int k = 0; k < METHODS; k++)
		if (told.worst[k].n)
			tell_method(k, &told.worst[k], verbose);
	if (!request.at_radius)
		spheres_warn_classes(in);
	if (means)
		tell_means(tab_path(spheres_table(in)), &told, request.tolerance, verbose);
	if (told.dark.size.x_im > 0) {
		char at[SIZE_NAME];
		warn("host", "%s: far-field extinction means little there: %.4g at beta = %.3g (worst of this run)",
		     size_name(&told.dark.size, at), told.dark.ext, 2 * told.dark.size.x_im);
	}
	method_selection_free(selection);
	spheres_close(in);
	return 0;
}

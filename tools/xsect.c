/* xsect - cross sections and asymmetry parameter of spheres. */
#include "base/die.h"
#include "format/columns.h"
#include "optics/select/method_selection.h"
#include "toolkit/spheres.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define TOLERANCE 1e-6
#define DARK 1         /* beta above which light is lost within a radius: extinction seen from afar grows as e^beta (mie_host.h) */
#define FAILS 1    /* estimated error from which on a method does not hold */

struct answer {
	struct efficiencies q;
	double error;
	enum method method;
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

/* n sizes. Those whose coefficients were read, and those in a host that absorbs, are for Lorenz-Mie theory, one by one. */
static void answers(struct method_selection *selection, int n, struct waves *w, struct answer *a)
{
	static struct sphere sphere[SPHERES_BATCH];
	static double error[SPHERES_BATCH];
	static struct efficiencies q[SPHERES_BATCH];
	static enum method used[SPHERES_BATCH];
	static int of[SPHERES_BATCH];
	int many = 0, failed = 0;
	for (int i = 0; i < n; i++) {
		if (w[i].a || w[i].size.x_im > 0)
			continue;
		sphere[many] = (struct sphere){ .x = w[i].size.x, .m = w[i].size.m };
		of[many++] = i;
	}
	if (many && method_selection_many(selection, many, sphere, q, error, used))
		die(NULL, "out of memory");
	for (int k = 0; k < many; k++)
		a[of[k]] = (struct answer){ q[k], error[k], used[k] };
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n - many > 1)
	for (int i = 0; i < (many < n ? n : 0); i++) {
		if (!w[i].a && w[i].size.x_im == 0)
			continue;
		if (waves_solve(&w[i]))
			failed = 1;
		else
			a[i].q = waves_efficiencies(&w[i], &a[i].error);
		a[i].method = METHOD_MIE;
		waves_drop(&w[i]);
	}
	if (failed)
		die(NULL, "out of memory");
}

static int columns(int by_x, struct tab_col *cols)
{
	const struct tab_col by_size[] = { column_c_ext, column_c_sca, column_c_abs, column_g, column_method, column_error };
	const struct tab_col by_parameter[] = { column_q_ext, column_q_sca, column_q_abs, column_g, column_q_back, column_method,
		column_error };
	memcpy(cols, by_x ? by_parameter : by_size, by_x ? sizeof by_parameter : sizeof by_size);
	return by_x ? 7 : 6;
}

static int values(int by_x, const struct size *size, const struct answer *a, double *row)
{
	double area = by_x ? 1 : M_PI * size->radius * size->radius;
	int n = 0;
	row[n++] = a->q.ext * area;
	row[n++] = a->q.sca * area;
	row[n++] = a->q.abs * area;
	row[n++] = a->q.g;
	if (by_x)
		row[n++] = a->q.back;
	row[n++] = a->method;
	row[n++] = a->error;
	return n;
}

static void run(struct spheres *in, struct method_selection *selection, const char *output, const char *command, struct worst worst[],
                struct dark *dark)
{
	static struct waves w[SPHERES_BATCH];
	static struct answer a[SPHERES_BATCH];
	struct tab_col cols[TAB_COLS];
	double row[TAB_COLS];
	int by_x = spheres_by_x(in), k = spheres_key_columns(in, cols);
	k += columns(by_x, cols + k);
	int ncarried = spheres_carried(in, k, cols, cols + k), n = spheres_batch(in, w);
	struct tab_out *out = tab_create(output, spheres_history(in), command, spheres_law(in), k + ncarried, cols);
	for (; n; n = spheres_batch(in, w)) {
		answers(selection, n, w, a);
		for (int i = 0; i < n; i++) {
			struct worst *most = &worst[a[i].method];
			int key = spheres_key(in, &w[i].size, row), j = key;
			j += values(by_x, &w[i].size, &a[i], row + j);
			spheres_carry(in, &w[i], row + j);
			tab_put(out, row);
			if (!most->n++ || !(a[i].error <= most->error)) {
				most->size = w[i].size;
				most->error = a[i].error;
			}
			if (w[i].size.x_im > dark->size.x_im && (2 * w[i].size.x_im > DARK || !(a[i].q.ext > 0)))
				*dark = (struct dark){ w[i].size, row[key] };
			waves_free(&w[i]);
		}
	}
	tab_finish(out);
}

/* The worst row of each method: a warning where it does not hold, or what --verbose says. */
static void tell(enum method method, const struct worst *w, int verbose)
{
	char at[SIZE_NAME];
	size_name(&w->size, at);
	if (method != METHOD_MIE && !(w->error < FAILS))
		warn(method_table[method].name, "%s: this method does not hold there (estimated error %.2g, worst of this run)", at, w->error);
	if (verbose)
		warn("verbose", "method %s for %lld sizes; estimated error at most %.2g, at %s", method_table[method].name, w->n, w->error, at);
}

int main(int argc, char **argv)
{
	static struct sizes_options sizes = SIZES_INIT;    /* static: the lists in it live as long as the process */
	static struct worst worst[METHODS];
	struct dark dark = { .size = { .x_im = 0 } };
	int method = METHOD_AUTO, verbose = 0;
	double tolerance = -1;
	const char *output = NULL;
	const struct opt opts[] = {
		SIZES_OPTIONS(sizes),
		{ "--method", OPT_CHOICE, &method, 0, 0, "auto|mie|rayleigh|goa|cam|evans-fournier",
		  "the cheapest within --tolerance, Lorenz-Mie theory, or an approximation", 0 },
		{ "--tolerance", OPT_REAL, &tolerance, 1e-14, 1, "T", "largest error that auto may choose a cheaper method for", 0 },
		{ "--verbose", OPT_FLAG, &verbose, 0, 0, NULL, "say which methods were used and their estimated errors", 1 },
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [SIZES | COEFFICIENTS]",
		"Cross sections and asymmetry parameter of spheres.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one table at most");
	if (tolerance >= 0 && method != METHOD_AUTO)
		die("--tolerance", "is for --method auto");
	sizes.clear_host = method != METHOD_AUTO && method != METHOD_MIE;
	struct spheres *in = spheres_open(&sizes, args.n ? args.operand[0] : NULL);
	if (spheres_coeffs(in) && method != METHOD_AUTO && method != METHOD_MIE)
		die("--method", "%s has no use for the coefficients in %s", method_table[method].name, spheres_coeffs(in));
	struct method_selection *selection = method_selection_new(method, tolerance < 0 ? TOLERANCE : tolerance);
	if (!selection)
		die(NULL, "out of memory");
	run(in, selection, output, args.history, worst, &dark);
	for (int k = 0; k < METHODS; k++)
		if (worst[k].n)
			tell(k, &worst[k], verbose);
	if (dark.size.x_im > 0) {
		char at[SIZE_NAME];
		warn("host", "%s: far-field extinction means little there: %.4g at beta = %.3g (worst of this run)",
		     size_name(&dark.size, at), dark.ext, 2 * dark.size.x_im);
	}
	method_selection_free(selection);
	spheres_close(in);
	return 0;
}

/* xsect - cross sections and asymmetry parameter of spheres. */
#include "base/die.h"
#include "optics/goa.h"
#include "optics/mie.h"
#include "pipe/coeffs.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define GOA_ORDER 3    /* rays of the phase function, as published */
#define GOA_FAILS 1    /* estimated error from which on the model does not hold (goa.h) */
#define DARK 1         /* beta above which light is lost within a radius: extinction seen from afar grows as e^beta (mie_host.h) */

enum { MIE, GOA };
static const char *const names[] = { "mie", "goa" };
static const double codes[] = { 1, 3 };    /* as in the column method */

struct answer {
	struct efficiencies q;
	double error;
};

/* What is worst in this run: the estimate, and a host that absorbs too much for an extinction seen from afar. */
struct worst {
	struct size size, dark;
	double error, dark_ext;
};

/* The published extinction formula has the ray of one chord only, the phase function has three. */
static void by_goa(const struct size *size, struct answer *a)
{
	double ignored;
	struct efficiencies rays = goa_efficiencies(size->x, size->m, GOA_ORDER, &ignored);
	a->q = goa_efficiencies(size->x, size->m, 1, &a->error);
	a->q.g = rays.g;
	a->q.back = rays.back;
}

/* n sizes; those whose coefficients were read have them. The others are solved at once, but in a host that absorbs. */
static void by_mie(int n, struct waves *w, struct answer *a)
{
	static double x[COEFFS_BATCH], error[COEFFS_BATCH];
	static double complex m[COEFFS_BATCH];
	static struct efficiencies q[COEFFS_BATCH];
	static int of[COEFFS_BATCH];
	int many = 0, failed = 0;
	for (int i = 0; i < n; i++) {
		if (w[i].a || w[i].size.x_im > 0)
			continue;
		x[many] = w[i].size.x;
		m[many] = w[i].size.m;
		of[many++] = i;
	}
	if (many && mie_many(many, x, m, q, error))
		die(NULL, "out of memory");
	for (int k = 0; k < many; k++)
		a[of[k]] = (struct answer){ q[k], error[k] };
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n - many > 1)
	for (int i = 0; i < (many < n ? n : 0); i++) {    /* the rest, one by one */
		if (!w[i].a && w[i].size.x_im == 0)
			continue;
		if (waves_solve(&w[i]))
			failed = 1;
		else
			a[i].q = waves_efficiencies(&w[i], &a[i].error);
		waves_drop(&w[i]);
	}
	if (failed)
		die(NULL, "out of memory");
}

static int columns(int by_x, struct tab_col *cols)
{
	static const struct tab_col by_size[] = {
		{ "c_ext", TAB_F64, "um^2" }, { "c_sca", TAB_F64, "um^2" }, { "c_abs", TAB_F64, "um^2" },
		{ "g", TAB_F64, "1" }, { "method", TAB_I32, "1" }, { "error", TAB_F64, "1" },
	}, by_parameter[] = {
		{ "q_ext", TAB_F64, "1" }, { "q_sca", TAB_F64, "1" }, { "q_abs", TAB_F64, "1" },
		{ "g", TAB_F64, "1" }, { "q_back", TAB_F64, "1" }, { "method", TAB_I32, "1" }, { "error", TAB_F64, "1" },
	};
	memcpy(cols, by_x ? by_parameter : by_size, by_x ? sizeof by_parameter : sizeof by_size);
	return by_x ? 7 : 6;
}

static int values(int by_x, int method, const struct size *size, const struct answer *a, double *row)
{
	double area = by_x ? 1 : M_PI * size->radius * size->radius;
	int n = 0;
	row[n++] = a->q.ext * area;
	row[n++] = a->q.sca * area;
	row[n++] = a->q.abs * area;
	row[n++] = a->q.g;
	if (by_x)
		row[n++] = a->q.back;
	row[n++] = codes[method];
	row[n++] = a->error;
	return n;
}

static struct worst run(struct coeffs *in, int method, const char *output, const char *command)
{
	static struct waves w[COEFFS_BATCH];
	static struct answer a[COEFFS_BATCH];
	struct worst worst = { .error = -1, .dark = { .x_im = 0 } };
	struct tab_col cols[TAB_COLS];
	double row[TAB_COLS];
	int by_x = coeffs_by_x(in), k = coeffs_columns(in, cols);
	k += columns(by_x, cols + k);
	int ncarried = coeffs_carried(in, k, cols, cols + k), n = coeffs_batch(in, w);
	struct tab_out *out = tab_create(output, coeffs_history(in), command, k + ncarried, cols);
	for (; n; n = coeffs_batch(in, w)) {
		if (method == MIE)
			by_mie(n, w, a);
#pragma omp parallel for schedule(dynamic) if (n > 1)
		for (int i = 0; i < (method == GOA ? n : 0); i++)
			by_goa(&w[i].size, &a[i]);
		for (int i = 0; i < n; i++) {
			int key = coeffs_key(in, &w[i].size, row), j = key;
			j += values(by_x, method, &w[i].size, &a[i], row + j);
			memcpy(row + j, w[i].size.carried, (size_t)ncarried * sizeof *row);
			tab_put(out, row);
			if (!(a[i].error <= worst.error)) {
				worst.size = w[i].size;
				worst.error = a[i].error;
			}
			if (w[i].size.x_im > worst.dark.x_im && (2 * w[i].size.x_im > DARK || !(a[i].q.ext > 0))) {
				worst.dark = w[i].size;
				worst.dark_ext = row[key];
			}
			waves_free(&w[i]);
		}
	}
	tab_finish(out);
	return worst;
}

int main(int argc, char **argv)
{
	static struct sizes_options sizes = SIZES_INIT;    /* static: the lists in it live as long as the process */
	int method = MIE, verbose = 0;
	const char *output = NULL;
	const struct opt opts[] = {
		SIZES_OPTIONS(sizes),
		{ "--method", OPT_CHOICE, &method, 0, 0, "mie|goa", "Lorenz-Mie theory, or geometrical optics approximation", 0 },
		{ "--verbose", OPT_FLAG, &verbose, 0, 0, NULL, "say which method was used and its estimated error", 1 },
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [SIZES | COEFFICIENTS]",
		"Cross sections and asymmetry parameter of spheres.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one table at most");
	sizes.clear_host = method == GOA;
	struct coeffs *in = coeffs_open(&sizes, args.n ? args.operand[0] : NULL);
	if (coeffs_read(in) && method != MIE)
		die("--method", "%s has no use for the coefficients in %s", names[method], coeffs_read(in));
	struct worst w = run(in, method, output, args.history);
	char at[SIZE_NAME];
	size_name(&w.size, at);
	if (method == GOA && !(w.error < GOA_FAILS))
		warn("goa", "%s: geometrical optics does not hold there (estimated error %.2g, worst of this run)", at, w.error);
	if (w.dark.x_im > 0) {
		char dark[SIZE_NAME];
		warn("host", "%s: far-field extinction means little there: %.4g at beta = %.3g (worst of this run)",
		     size_name(&w.dark, dark), w.dark_ext, 2 * w.dark.x_im);
	}
	if (verbose)
		warn("verbose", "method %s; estimated error at most %.2g, at %s", names[method], w.error, at);
	coeffs_close(in);
	return 0;
}

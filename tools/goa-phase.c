/* goa-phase - scattering amplitudes and phase functions of large spheres by geometrical optics. */
#include "base/die.h"
#include "optics/goa/goa.h"
#include "optics/goa/goa_plus.h"
#include "toolkit/phase_table.h"

#include <math.h>
#include <stdlib.h>

#define FAILS 1        /* estimated error from which on a model does not hold (goa.h, goa_plus.h) */
#define KEPT 8         /* indices whose rays a thread keeps: wavelengths of one material, in turn for each size */

enum { GOA, PLUS, INCOHERENT };

struct model {
	int which, order;
};

/* What is known of one refractive index, by the thread that found it; one of the two. */
static _Thread_local struct kept {
	struct goa *goa;
	struct goa_plus *plus;
	double complex m;
} kept[KEPT];
static _Thread_local int oldest;

/* The worst that happened in this run. */
static struct {
	double error, x;
} worst;

static struct kept *rays(double complex m, const struct model *model)
{
	for (int k = 0; k < KEPT; k++)
		if ((kept[k].goa || kept[k].plus) && kept[k].m == m)
			return &kept[k];
	struct kept *k = &kept[oldest++ % KEPT];
	goa_free(k->goa);
	goa_plus_free(k->plus);
	k->m = m;
	k->goa = model->which == PLUS ? NULL : goa_new(m, model->order);
	k->plus = model->which == PLUS ? goa_plus_new(m) : NULL;
	return k->goa || k->plus ? k : NULL;
}

static void judge(double error, double x)
{
#pragma omp critical
	if (error > worst.error || (error == worst.error && x < worst.x)) {
		worst.error = error;
		worst.x = x;
	}
}

static int plus(struct goa_plus *g, const struct size *size, int n, const double *theta, struct phase_result *out)
{
	struct efficiencies q;
	if (goa_plus_aim(g, n, theta) || goa_plus_at(g, size->x, out->s1, out->s2, &q))
		return -1;
	out->norm = M_PI * size->x * size->x * q.sca;
	out->q_sca = q.sca;
	judge(goa_plus_error(size->x, size->m), size->x);
	return 0;
}

/* Powers without phases: their roots stand as the real parts of the amplitudes. */
static int apart(struct goa *g, double x, int n, struct phase_result *out)
{
	double *power = malloc(2 * (size_t)n * sizeof *power);
	int failed = !power || goa_incoherent(g, x, power, power + n, &out->norm);
	for (int k = 0; !failed && k < n; k++) {
		out->s1[k] = sqrt(power[k]);
		out->s2[k] = sqrt(power[n + k]);
	}
	free(power);
	return failed;
}

static int phase(const void *context, struct waves *w, int n, const double *theta, struct phase_result *out)
{
	const struct model *model = context;
	double x = w->size.x, error;
	struct efficiencies q;
	struct kept *k = rays(w->size.m, model);
	if (!k)
		return -1;
	if (k->plus)
		return plus(k->plus, &w->size, n, theta, out);
	if (goa_aim(k->goa, n, theta) || goa_measure(k->goa, x, &q, &out->norm, &error))
		return -1;
	if (model->which == INCOHERENT) {
		if (apart(k->goa, x, n, out))
			return -1;
	} else {
		goa_at(k->goa, x, out->s1, out->s2);
	}
	judge(error, x);
	/* Far below where GOA holds its extinction can be negative; the weight in an average cannot. */
	out->q_sca = q.sca > 0 ? q.sca : out->norm / (M_PI * x * x);
	return 0;
}

/* The rays of this thread; those of others are left to the system. */
static void forget(void)
{
	for (int k = 0; k < KEPT; k++) {
		goa_free(kept[k].goa);
		goa_plus_free(kept[k].plus);
	}
}

int main(int argc, char **argv)
{
	static struct sizes_options sizes = SIZES_INIT;    /* static: the lists in it live as long as the process */
	static struct phase_options angles = { .tolerance = 1e-3 };
	struct model model = { GOA, 3 };
	const char *output = NULL;
	long long order = -1;
	const struct opt opts[] = {
		SIZES_OPTIONS(sizes),
		PHASE_OPTIONS(angles),
		{ "--tolerance", OPT_REAL, &angles.tolerance, 1e-6, 0.1, "T",
		  "error allowed to the p of a mean over sizes: half the integral of |dp|", 0 },
		{ "--verbose", OPT_FLAG, &angles.verbose, 0, 0, NULL, "say how many sizes a mean took", 1 },
		{ "--order", OPT_INT, &order, 0, GOA_ORDER_MAX, "P",
		  "highest order of rays, the number of chords inside the sphere: 3", 0 },
		{ "--model", OPT_CHOICE, &model.which, 0, 0, "goa|goa+|incoherent",
		  "geometrical optics as published; with what it lacks; or without interference", 0 },
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [SIZES]",
		"Scattering amplitudes and phase functions of large spheres by geometrical optics.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one table at most");
	if (order >= 0 && model.which == PLUS)
		die("--order", "is for goa and incoherent; goa+ has its own");
	if (order >= 0)
		model.order = (int)order;
	sizes.clear_host = 1;
	struct coeffs *in = coeffs_open_sizes(&sizes, args.n ? args.operand[0] : NULL);
	if (coeffs_table(in) && tab_find(coeffs_table(in), "a_re", "1") >= 0)
		die(tab_path(coeffs_table(in)), "holds coefficients, not sizes; mie-phase takes them");
	phase_table(&angles, in, phase, &model, output, args.history);
	coeffs_close(in);
	if (worst.error >= FAILS)
		warn(NULL, "geometrical optics does not hold at x = %.6g (estimated error %.2g, the worst of this run); see mie-phase",
		     worst.x, worst.error);
	forget();
	return 0;
}

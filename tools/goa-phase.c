/* goa-phase - scattering amplitudes and phase functions of large spheres by geometrical optics. */
#include "base/die.h"
#include "optics/goa.h"
#include "pipe/phase.h"

#include <math.h>

#define GOA_FAILS 1    /* estimated error from which on the model does not hold (goa.h) */
#define KEPT 8         /* indices whose rays a thread keeps: wavelengths of one material, in turn for each size */

/* What is known of one refractive index, by the thread that found it. */
static _Thread_local struct {
	struct goa *goa;
	double complex m;
} kept[KEPT];
static _Thread_local int oldest;

/* The worst that happened in this run. */
static struct {
	double error, x;
} worst;

static struct goa *rays(double complex m, int order)
{
	for (int k = 0; k < KEPT; k++)
		if (kept[k].goa && kept[k].m == m)
			return kept[k].goa;
	int k = oldest++ % KEPT;
	goa_free(kept[k].goa);
	kept[k].m = m;
	return kept[k].goa = goa_new(m, order);
}

static void judge(double error, double x)
{
#pragma omp critical
	if (error > worst.error || (error == worst.error && x < worst.x)) {
		worst.error = error;
		worst.x = x;
	}
}

static int model(const void *context, struct waves *w, int n, const double *theta, struct phase_result *out)
{
	double x = w->size.x, error;
	struct efficiencies q;
	struct goa *g = rays(w->size.m, (int)*(const long long *)context);
	if (!g || goa_aim(g, n, theta) || goa_measure(g, x, &q, &out->norm, &error))
		return -1;
	goa_at(g, x, out->s1, out->s2);
	judge(error, x);
	/* Far below where GOA holds its extinction can be negative; the weight in an average cannot. */
	out->q_sca = q.sca > 0 ? q.sca : out->norm / (M_PI * x * x);
	return 0;
}

/* The threads' rays go with them, but for those of this one. */
static void forget(void)
{
	for (int k = 0; k < KEPT; k++)
		goa_free(kept[k].goa);
}

int main(int argc, char **argv)
{
	struct sizes_options sizes = SIZES_INIT;
	struct phase_options phase = { 0 };
	const char *output = NULL;
	long long order = 3;
	int published = 0;
	const struct opt opts[] = {
		SIZES_OPTIONS(sizes),
		PHASE_OPTIONS(phase),
		{ "--order", OPT_INT, &order, 0, GOA_ORDER_MAX, "P", "highest order of rays, the number of chords inside the sphere", 0 },
		{ "--model", OPT_CHOICE, &published, 0, 0, "goa", "geometrical optics as published", 0 },
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [SIZES]",
		"Scattering amplitudes and phase functions of large spheres by geometrical optics.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one table at most");
	struct coeffs *in = coeffs_open_sizes(&sizes, args.n ? args.operand[0] : NULL);
	if (coeffs_table(in) && tab_find(coeffs_table(in), "a_re", "1") >= 0)
		die(tab_path(coeffs_table(in)), "holds coefficients, not sizes; mie-phase takes them");
	phase_table(&phase, in, model, &order, output, args.history);
	coeffs_close(in);
	if (worst.error >= GOA_FAILS)
		warn(NULL, "geometrical optics does not hold at x = %.6g (estimated error %.2g, the worst of this run); see mie-phase",
		     worst.x, worst.error);
	forget();
	return 0;
}

/* mie-phase - scattering amplitudes and phase functions of spheres by Lorenz-Mie theory. */
#include "base/die.h"
#include "optics/mie.h"
#include "pipe/phase.h"

#include <math.h>

static int model(const void *context, struct waves *w, int n, const double *theta, struct phase_result *out)
{
	(void)context;
	if (waves_solve(w))
		return -1;
	struct efficiencies q = mie_efficiencies(w->size.x, w->lossless, w->n, w->a, w->b);
	out->q_sca = q.sca;
	out->norm = M_PI * w->size.x * w->size.x * q.sca;    /* k^2 C_sca: p as the sums give it, not renormalised */
	return mie_amplitudes(w->n, w->a, w->b, n, theta, out->s1, out->s2);
}

int main(int argc, char **argv)
{
	static struct sizes_options sizes = SIZES_INIT;    /* static: the lists in it live as long as the process */
	static struct phase_options phase;
	const char *output = NULL;
	const struct opt opts[] = {
		SIZES_OPTIONS(sizes),
		PHASE_OPTIONS(phase),
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [SIZES | COEFFICIENTS]",
		"Scattering amplitudes and phase functions of spheres by Lorenz-Mie theory.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one table at most");
	struct coeffs *in = coeffs_open(&sizes, args.n ? args.operand[0] : NULL);
	phase_table(&phase, in, model, NULL, output, args.history);
	coeffs_close(in);
	return 0;
}

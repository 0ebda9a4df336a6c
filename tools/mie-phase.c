/* mie-phase - scattering amplitudes and phase functions of spheres by Lorenz-Mie theory. */
#include "base/die.h"
#include "toolkit/phase_model_mie.h"
#include "toolkit/phase_table.h"

#include <math.h>

#define TOLERANCE 1e-3    /* of the default grid; amplitudes are as good as they can be unless one is asked for */

int main(int argc, char **argv)
{
	static struct sizes_options sizes = SIZES_INIT;    /* static: the lists in it live as long as the process */
	static struct phase_options phase;
	struct phase_model_mie request = { 0 };
	const char *output = NULL;
	double tolerance = NAN;
	const struct opt opts[] = {
		SIZES_OPTIONS(sizes),
		PHASE_OPTIONS(phase),
		{ "--tolerance", OPT_REAL, &tolerance, 1e-6, 0.1, "T", "error allowed to p: half the integral of |dp|", 0 },
		{ "--verbose", OPT_FLAG, &phase.verbose, 0, 0, NULL, "say which method was used, and how many sizes a mean took", 1 },
		{ "--direct", OPT_FLAG, &request.direct, 0, 0, NULL, "sum angle by angle, even where a transform is faster", 0 },
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [SIZES | COEFFICIENTS]",
		"Scattering amplitudes and phase functions of spheres by Lorenz-Mie theory.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one table at most");
	phase.tolerance = isnan(tolerance) ? TOLERANCE : tolerance;
	/* Of the error asked for, a tenth is the amplitudes'; the grid has the rest. */
	if (!isnan(tolerance)) {
		request.tolerance = tolerance / 10;
		phase.tolerance = tolerance - request.tolerance;
	}
	request.direct |= phase.theta.n > 0;
	struct spheres *in = spheres_open(&sizes, args.n ? args.operand[0] : NULL);
	/* Of what is given, angles and sizes, GOA+ may have all of the error. */
	if (!isnan(tolerance) && phase.angles && !phase.average && !request.direct && !spheres_coeffs(in))
		request.rough = tolerance;
	if (phase.verbose && request.rough == 0)
		warn("verbose", "method mie for all sizes");
	struct phase_model model = phase_model_mie_new(&request);
	phase_table(&phase, in, &model, output, args.history);
	phase_model_mie_free(&model);
	spheres_close(in);
	return 0;
}

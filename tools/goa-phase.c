/* goa-phase - scattering amplitudes and phase functions of large spheres by geometrical optics. */
#include "base/die.h"
#include "optics/goa/goa.h"
#include "toolkit/coeffs.h"
#include "toolkit/phase_model_goa.h"
#include "toolkit/phase_table.h"

#define ORDER 3        /* unless asked for */

int main(int argc, char **argv)
{
	static struct sizes_options sizes = SIZES_INIT;    /* static: the lists in it live as long as the process */
	static struct phase_options angles = { .tolerance = 1e-3 };
	const char *output = NULL;
	int which = PHASE_GOA;
	long long order = -1;
	const struct opt opts[] = {
		SIZES_OPTIONS(sizes),
		PHASE_OPTIONS(angles),
		{ "--tolerance", OPT_REAL, &angles.tolerance, 1e-6, 0.1, "T",
		  "error allowed to the p of a mean over sizes: half the integral of |dp|", 0 },
		{ "--verbose", OPT_FLAG, &angles.verbose, 0, 0, NULL, "say how many sizes a mean took", 1 },
		{ "--order", OPT_INT, &order, 0, GOA_ORDER_MAX, "P",
		  "highest order of rays, the number of chords inside the sphere: 3", 0 },
		{ "--model", OPT_CHOICE, &which, 0, 0, "goa|goa+|incoherent",
		  "geometrical optics as published; with what it lacks; or without interference", 0 },
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [SIZES]",
		"Scattering amplitudes and phase functions of large spheres by geometrical optics.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one table at most");
	if (order >= 0 && which == PHASE_GOA_PLUS)
		die("--order", "is for goa and incoherent; goa+ has its own");
	sizes.clear_host = 1;
	struct spheres *in = spheres_open_sizes(&sizes, args.n ? args.operand[0] : NULL);
	if (spheres_table(in) && coeffs_in(spheres_table(in)))
		die(tab_path(spheres_table(in)), "holds coefficients, not sizes; mie-phase takes them");
	struct phase_model model = phase_model_goa_new(which, order < 0 ? ORDER : (int)order, (int)sizes.threads);
	phase_table(&angles, in, &model, output, args.history);
	spheres_close(in);
	double x, error = phase_model_goa_worst(&model, &x);
	if (error >= PHASE_MODEL_GOA_FAILS)
		warn(NULL, "geometrical optics does not hold at x = %.6g (estimated error %.2g, the worst of this run); see mie-phase", x, error);
	phase_model_goa_free(&model);
	return 0;
}

/* medium-bake - particles, or a size distribution with a concentration, and their optics become a medium file. */
#include "base/die.h"
#include "base/opt.h"
#include "format/limits.h"
#include "format/tab.h"
#include "medium/bake.h"
#include "medium/classes.h"
#include "medium/medium_file.h"
#include "medium/particle_counts.h"
#include "medium/particle_grid.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
	const char *xsect = NULL, *phase = NULL, *psd = NULL, *density = NULL, *output = NULL;
	long long voxels = 0;
	double concentration = NAN, sphere = NAN, box[3] = { NAN, NAN, NAN };
	const struct opt opts[] = {
		{ "--xsect", OPT_FILE, &xsect, 0, 0, "FILE", "cross sections by class and wavelength, from xsect", 0 },
		{ "--phase", OPT_FILE, &phase, 0, 0, "FILE", "phase functions, from mie-phase, goa-phase or txttab", 0 },
		{ "--psd", OPT_FILE, &psd, 0, 0, "FILE", "a size distribution instead of particles", 0 },
		{ "--concentration", OPT_PER_M3, &concentration, 0, DBL_MAX, "N/m3", "its particles a volume", 0 },
		{ "--box", OPT_BOX, box, 1e-9, 1e6, "X,Y,Z", "the medium fills a box", 0 },
		{ "--sphere", OPT_M, &sphere, 1e-9, 1e6, "R", "the medium fills a sphere", 0 },
		{ "--density", OPT_FILE, &density, 0, 0, "GRID.npy", "relative density in the box, [z][y][x], with --psd", 0 },
		{ "--voxels", OPT_INT, &voxels, 1, MEDIUM_VOXELS_SIDE, "N", "voxels along the longest side", 0 },
		{ "-o", OPT_FILE, &output, 0, 0, "FILE", "the medium file", 1 },
		OPT_END
	};
	const struct opt_tool tool = { "--xsect FILE --phase FILE [OPTION].. -o FILE [PARTICLES]",
		"Bake particles, or a size distribution, and their optics into a medium.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	struct medium m = { 0 };
	int bounded = !isnan(sphere) || !isnan(box[0]);
	if (!xsect || !phase || !output)
		die(!xsect ? "--xsect" : !phase ? "--phase" : "-o", "is needed");
	if (!isnan(sphere) && !isnan(box[0]))
		die("--sphere", "excludes --box");
	if (args.n > (psd ? 0 : 1))
		die(args.operand[args.n - 1], psd ? "--psd takes no particles" : "one table of particles at most");
	if (psd && isnan(concentration))
		die("--concentration", "is needed with --psd");
	if (psd && !bounded)
		die("--box", "or --sphere is needed with --psd");
	if (!psd && !isnan(concentration))
		die("--concentration", "needs --psd");
	if (!psd && density)
		die("--density", "needs --psd; particles have their own");
	m.kind = psd ? MEDIUM_DENSITY : MEDIUM_PARTICLES;
	m.round = !isnan(sphere);
	for (int a = 0; a < 3 && bounded; a++)
		m.half[a] = m.round ? sphere : box[a] / 2;

	if (psd)
		bake_density(density, (int)voxels, &m);
	char *history = classes_cross_sections(xsect, &m);
	char *matter = psd ? bake_psd(psd, concentration, &m) : bake_particles(args.n ? args.operand[0] : NULL, bounded, &m);
	char *phases = classes_phase_functions(phase, &m);
	m.history = tab_join(history, phases, matter, args.history, NULL);
	if (m.kind == MEDIUM_PARTICLES) {
		particle_grid_build(&m);
		particle_counts_build(&m, (int)voxels);
	}
	medium_file_write(output, &m);
	medium_free(&m);
	free(history);
	free(matter);
	free(phases);
	free(args.history);
	return 0;
}

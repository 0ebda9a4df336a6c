/* medium-bake - particles, or a size distribution with a concentration, and their optics become a medium file. */
#include "base/die.h"
#include "base/opt.h"
#include "base/standard.h"
#include "format/limits.h"
#include "format/tab.h"
#include "medium/bake.h"
#include "medium/classes.h"
#include "medium/host.h"
#include "medium/medium_file.h"
#include "medium/particle_counts.h"
#include "medium/particle_grid.h"
#include "medium/provenance.h"
#include "medium/thinning.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Refuse, or where histories alone speak against it warn of, tables that do not belong together. matter is the history of what is
 * baked, exact whether its radii are those of the cross sections: then these are good for it. */
static void check_provenance(const char *xsect, const char *phase, int psd, int exact, const char *matter, const char *cross_sections,
                             const char *phases)
{
	char *sizes = exact ? NULL : provenance_stranger(PROVENANCE_SIZES, matter, cross_sections);
	if (sizes && psd)
		die(standard_input(xsect), "is of other radii than --psd, and not made from it (psd %s)", sizes);
	if (sizes)
		warn(standard_input(xsect), "is of another size distribution than the particles, it seems (psd %s)", sizes);
	free(sizes);
	sizes = provenance_stranger(PROVENANCE_SIZES, matter, phases);
	char *apart = provenance_stranger(PROVENANCE_SIZES, phases, cross_sections);
	if (sizes && (apart || !provenance_known(PROVENANCE_SIZES, cross_sections)))
		warn(standard_input(phase), "is of another size distribution than what is baked, it seems (psd %s)", sizes);
	free(sizes);
	free(apart);
	char *optics = provenance_stranger(PROVENANCE_OPTICS, cross_sections, phases);
	if (optics)
		warn(standard_input(phase), "is of other particles than the cross sections, it seems (%s)", optics);
	free(optics);
}

/* What a tolerance leaves: half of it is for classes, and what these do not take for the angles of phase functions. */
static void thin(struct medium *m, double tolerance, const char *output, int verbose)
{
	struct thinned t;
	thinning_classes(m, tolerance / 2, &t);
	thinning_nodes(m, tolerance - t.classes_error, &t);
	if (verbose)
		warn(output, "%d of %d classes, a particle's own optics within %.2g; %zu of %zu angles, half-L1 within %.2g", m->n_classes,
		     t.classes, t.classes_error, m->n_nodes, t.nodes, t.nodes_error);
}

/* What is in the file, and how thick it is. */
static void tell(const struct medium *m, const char *output)
{
	double depth = medium_depth(m) / fmin(m->half[0], fmin(m->half[1], m->half[2]));
	size_t nodes = m->n_nodes * sizeof(float) * (1 + (size_t)m->n_waves);
	size_t particles = m->n_particles * 4 * sizeof(float) + m->n_first * sizeof(uint32_t);
	size_t voxels = m->n_voxel_count * sizeof(uint32_t) + m->n_density * sizeof(float);
	warn(output, "%zu particles, %d classes, %d wavelengths; mean optical depth at %g um %.4g along x, %.4g along y, %.4g along z; "
	     "%.1f MB of phase functions, %.1f of particles, %.1f of %d x %d x %d voxels", m->n_particles, m->n_classes, m->n_waves,
	     m->wavelength[0], depth * m->half[0], depth * m->half[1], depth * m->half[2], 1e-6 * (double)nodes, 1e-6 * (double)particles,
	     1e-6 * (double)voxels, m->voxels[0], m->voxels[1], m->voxels[2]);
}

int main(int argc, char **argv)
{
	const char *xsect = NULL, *phase = NULL, *psd = NULL, *density = NULL, *host = NULL, *output = NULL;
	long long voxels = 0;
	int verbose = 0;
	double tolerance = 0, concentration = NAN, visibility = NAN, sphere = NAN, box[3] = { NAN, NAN, NAN };
	const struct opt opts[] = {
		{ "--xsect", OPT_FILE, &xsect, 0, 0, "FILE", "cross sections by class and wavelength, from xsect", 0 },
		{ "--phase", OPT_FILE, &phase, 0, 0, "FILE", "phase functions, from mie-phase, goa-phase or txttab", 0 },
		{ "--psd", OPT_FILE, &psd, 0, 0, "FILE", "a size distribution instead of particles", 0 },
		{ "--concentration", OPT_PER_M3, &concentration, 0, DBL_MAX, "N/m3", "its particles a volume", 0 },
		{ "--visibility", OPT_M, &visibility, 1e-6, 1e9, "V", "or as many as let one see so far at 550 nm", 0 },
		{ "--box", OPT_BOX, box, 1e-9, 1e6, "X,Y,Z", "the medium fills a box", 0 },
		{ "--sphere", OPT_M, &sphere, 1e-9, 1e6, "R", "the medium fills a sphere", 0 },
		{ "--density", OPT_FILE, &density, 0, 0, "GRID.npy", "relative density in the box, [z][y][x], or of each class, with --psd", 0 },
		{ "--host", OPT_TEXT, &host, 0, 0, "M", "what is between the particles, which absorbs; default: as the cross sections say", 0 },
		{ "--voxels", OPT_INT, &voxels, 1, MEDIUM_VOXELS_SIDE, "N", "voxels along the longest side", 0 },
		{ "--tolerance", OPT_REAL, &tolerance, 1e-6, 0.1, "T", "merge classes and leave out angles that change less", 0 },
		{ "--verbose", OPT_FLAG, &verbose, 0, 0, NULL, "say what is baked", 1 },
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
	if (psd && isnan(concentration) == isnan(visibility))
		die("--concentration", isnan(visibility) ? "or --visibility is needed with --psd" : "excludes --visibility");
	if (psd && !bounded)
		die("--box", "or --sphere is needed with --psd");
	if (!psd && (!isnan(concentration) || !isnan(visibility)))
		die(isnan(visibility) ? "--concentration" : "--visibility", "needs --psd");
	if (!psd && density)
		die("--density", "needs --psd; particles have their own");
	m.kind = psd ? MEDIUM_DENSITY : MEDIUM_PARTICLES;
	m.round = !isnan(sphere);
	for (int a = 0; a < 3 && bounded; a++)
		m.half[a] = m.round ? sphere : box[a] / 2;

	struct bake_matter matter_of = { 0 };
	if (psd)
		matter_of = bake_density(density, (int)voxels, &m);
	char *history = classes_cross_sections(xsect, &m);
	int exact = 0;
	char *matter = psd ? bake_psd(psd, isnan(visibility) ? concentration : 1, &matter_of, density, &m, &exact)
	    : bake_particles(args.n ? args.operand[0] : NULL, bounded, &m);
	char *surrounds = host ? xtext("%s", host) : provenance_host(history);
	host_absorption(host ? "--host" : "--host of the cross sections", surrounds, &m);
	free(surrounds);
	if (!isnan(visibility)) {
		double wavelength;
		concentration = bake_visibility(visibility, &m, &wavelength);
		if (fabs(wavelength - 0.55) > 1e-6)
			warn("--visibility", "is taken at %g um: the cross sections do not reach 0.55 um", wavelength);
		if (verbose)
			warn(output, "one sees %g m at %g um where %.6g/m3 make an extinction of %.4g/m", visibility, wavelength, concentration,
			     -log(0.02) / visibility);
	}
	char *phases = classes_phase_functions(phase, &m);
	check_provenance(xsect, phase, psd != NULL, exact, matter, history, phases);
	m.history = tab_join(history, phases, matter, args.history, NULL);
	if (tolerance > 0)
		thin(&m, tolerance, output, verbose);
	if (m.kind == MEDIUM_PARTICLES) {
		particle_grid_build(&m);
		particle_counts_build(&m, (int)voxels);
	}
	medium_file_write(output, &m);
	if (verbose)
		tell(&m, output);
	medium_free(&m);
	free(matter_of.integral);
	free(history);
	free(matter);
	free(phases);
	free(args.history);
	return 0;
}

/* particles - place the particles of a size distribution at random. */
#include "base/die.h"
#include "base/opt.h"
#include "format/columns.h"
#include "medium/placement.h"

#include <float.h>
#include <math.h>

int main(int argc, char **argv)
{
	const char *psd = NULL, *density = NULL, *output = NULL;
	long long seed = 1;
	double count = NAN, concentration = NAN, box[3] = { NAN, NAN, NAN }, sphere = NAN;
	const struct opt opts[] = {
		{ "--psd", OPT_FILE, &psd, 0, 0, "FILE", "the size distribution, a table with radius and weight", 0 },
		{ "--count", OPT_REAL, &count, 1, PLACEMENT_MOST, "N", "exactly so many particles", 0 },
		{ "--concentration", OPT_PER_M3, &concentration, 0, DBL_MAX, "N/m3", "so many on average, where the density is 1", 0 },
		{ "--box", OPT_BOX, box, 1e-9, 1e9, "X,Y,Z", "in a box around the origin, of these edges", 0 },
		{ "--sphere", OPT_M, &sphere, 1e-9, 1e9, "R", "in a sphere around the origin, of this radius", 0 },
		{ "--density", OPT_FILE, &density, 0, 0, "GRID.npy", "relative density in the box, [z][y][x]", 0 },
		{ "--seed", OPT_INT, &seed, 0, 0x1p53, "S", "seed of the random numbers", 0 },
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "--psd FILE (--count N | --concentration N/m3) (--box X,Y,Z | --sphere R) [OPTION]..",
		"Place the particles of a size distribution at random.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n)
		die(args.operand[0], "no operands; the size distribution is given by --psd");
	if (!psd)
		die("--psd", "needed: the size distribution, a table made by psd");
	if (isnan(count) == isnan(concentration))
		die("--count", "give either --count or --concentration");
	if (!isnan(count) && count != floor(count))
		die("--count", "'%.17g' is not a whole number", count);
	if (isnan(box[0]) == isnan(sphere))
		die("--box", "give either --box or --sphere");
	struct placement_request request = { .round = isnan(box[0]), .count = count, .concentration = concentration, .seed = (uint64_t)seed };
	for (int i = 0; i < 3; i++)
		request.box[i] = request.round ? 2 * sphere : box[i];

	struct tab *t = tab_open(psd);
	struct placement *p = placement_new(&request, t, density);
	const struct tab_col cols[] = { column_position[0], column_position[1], column_position[2], column_radius, column_class };
	struct tab_out *out = tab_create(output, tab_history(t), args.history, NULL, 5, cols);
	tab_close(t);
	for (struct placed q; placement_next(p, &q);)
		tab_put(out, (double[]){ q.at[0], q.at[1], q.at[2], q.radius, (double)q.class });
	tab_finish(out);
	placement_free(p);
	return 0;
}

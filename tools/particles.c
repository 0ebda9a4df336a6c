/* particles - place the particles of a size distribution at random. */
#include "base/die.h"
#include "base/opt.h"
#include "format/columns.h"
#include "format/npy.h"
#include "medium/density.h"
#include "medium/rng.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#define MOST 1e12                /* particles, and points tried */

enum { PLACES, CLASSES, NUMBER };        /* streams of random numbers */

struct sizes {
	size_t n;
	double *radius, *below;  /* below: weights of the classes up to and with this one */
};

static struct sizes read_sizes(struct tab *t)
{
	struct sizes s = { 0, NULL, NULL };
	int radius = tab_need(t, &column_radius), weight = tab_need(t, &column_weight);
	double row[TAB_COLS], sum = 0;
	for (size_t room = 0; tab_next(t, row); s.n++) {
		if (s.n == room) {
			room = 2 * room + 16;
			s.radius = xgrow(s.radius, room, sizeof(double));
			s.below = xgrow(s.below, room, sizeof(double));
		}
		if (!(row[radius] > 0 && isfinite(row[radius])))
			die(tab_path(t), "row %llu: a radius is greater than 0, not %g", (unsigned long long)tab_row(t), row[radius]);
		if (!(row[weight] >= 0 && isfinite(row[weight])))
			die(tab_path(t), "row %llu: a weight is at least 0, not %g", (unsigned long long)tab_row(t), row[weight]);
		s.radius[s.n] = row[radius];
		s.below[s.n] = sum += row[weight];
	}
	if (!(sum > 0 && isfinite(sum)))
		die(tab_path(t), "has no class with a weight");
	return s;
}

/* The class in which the share u of all weights lies; one without weight is never drawn. */
static size_t draw(const struct sizes *s, double u)
{
	size_t lo = 0, hi = s->n - 1;
	double want = u * s->below[hi];
	while (lo < hi) {
		size_t mid = lo + (hi - lo) / 2;
		if (s->below[mid] > want)
			hi = mid;
		else
			lo = mid + 1;
	}
	return lo;
}

/* A coordinate as the f32 column holds it, not rounded out of the box. */
static double inside(double v, double half)
{
	float f = (float)v;
	return fabs((double)f) <= half ? f : nextafterf(f, 0);
}

/* Densities over their maximum: the chance that a point is kept. */
static double scale(struct npy_grid *g, const char *name)
{
	double top = 0, sum = 0;
	size_t n = g->nx * g->ny * g->nz;
	for (size_t i = 0; i < n; i++) {
		top = fmax(top, g->v[i]);
		sum += g->v[i];
	}
	if (!(top > 0))
		die(name, "is 0 everywhere");
	if (sum / (double)n < 1e-4 * top)
		die(name, "has a mean less than 1e-4 of its maximum; crop it, or raise the rest");
	return top;
}

int main(int argc, char **argv)
{
	const char *psd = NULL, *density = NULL, *output = NULL;
	long long seed = 1;
	double count = NAN, concentration = NAN, box[3] = { NAN, NAN, NAN }, sphere = NAN;
	const struct opt opts[] = {
		{ "--psd", OPT_FILE, &psd, 0, 0, "FILE", "the size distribution, a table with radius and weight", 0 },
		{ "--count", OPT_REAL, &count, 1, MOST, "N", "exactly so many particles", 0 },
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
	int round = isnan(box[0]);
	for (int i = 0; round && i < 3; i++)
		box[i] = 2 * sphere;

	struct tab *t = tab_open(psd);
	struct sizes sizes = read_sizes(t);
	struct npy_grid grid = { 0, 0, 0, NULL };
	double top = 1;
	if (density) {
		grid = npy_density(density);
		top = scale(&grid, density);
	}
	/* Points uniform in the box, of which some are kept, are a Poisson process if their own number is Poisson's: no volume
	 * and no mean density need to be known. */
	double tries = INFINITY;
	if (isnan(count)) {
		double mean = concentration * box[0] * box[1] * box[2] * top;
		if (!(mean <= MOST))
			die("--concentration", "makes more than %g particles", MOST);
		tries = rng_poisson(mean, (uint64_t)seed, NUMBER);
		count = INFINITY;
	}
	const struct tab_col cols[] = {
		column_position[0], column_position[1], column_position[2], column_radius, column_class,
	};
	struct tab_out *out = tab_create(output, tab_history(t), args.history, 5, cols);
	tab_close(t);
	uint64_t kept = 0;
	for (uint64_t i = 0; (double)i < tries && (double)kept < count; i++) {
		uint32_t w[4];
		double u[4];
		if (i == 10000000 && !kept && tries == INFINITY)
			die(density, "is 0 almost everywhere in the sphere");
		rng_block((uint64_t)seed, i, PLACES, w);
		for (int j = 0; j < 4; j++)
			u[j] = rng_unit32(w[j]);
		double x = 2 * u[0] - 1, y = 2 * u[1] - 1, z = 2 * u[2] - 1;
		if (round && x * x + y * y + z * z > 1)
			continue;
		if (density && u[3] * top >= density_at(&grid, u[0], u[1], u[2]))
			continue;
		rng_block((uint64_t)seed, i, CLASSES, w);
		size_t class = draw(&sizes, rng_unit53(w[0], w[1]));
		tab_put(out, (double[]){ inside(x * box[0] / 2, box[0] / 2), inside(y * box[1] / 2, box[1] / 2),
		    inside(z * box[2] / 2, box[2] / 2), sizes.radius[class], (double)class });
		kept++;
	}
	tab_finish(out);
	free(sizes.radius);
	free(sizes.below);
	free(grid.v);
	return 0;
}

/* mie-phase - scattering amplitudes and phase functions of spheres by Lorenz-Mie theory. */
#include "base/die.h"
#include "optics/goa/goa_plus.h"
#include "optics/mie/mie_fast_amplitudes.h"
#include "optics/select/method.h"
#include "toolkit/phase_table.h"

#include <math.h>
#include <stdlib.h>

#define TOLERANCE 1e-3    /* of the default grid; amplitudes are as good as they can be unless one is asked for */
#define BEHIND 10         /* from 180 degrees, over the number of partial waves */
#define KEPT 64           /* indices whose rays are kept; others' are found for each size */

struct request {
	int direct;           /* sums only */
	double tolerance;     /* of amplitudes, 0: none */
	double rough;         /* error in L1 at which GOA+ may do, 0: never */
};

/* One sphere: its transform, or the coefficients for sums. */
struct opened {
	struct phase_state state;
	struct waves *w;
	int n;
	struct legendre_series *series;
};

static void sphere_close(struct phase_state *state)
{
	struct opened *s = (struct opened *)state;
	legendre_series_free(s->series);
	waves_drop(s->w);
	free(s);
}

static struct phase_state *sphere_open(const void *context, struct waves *w, size_t angles)
{
	const struct request *r = context;
	struct opened *s = calloc(1, sizeof *s);
	if (!s || waves_solve(w)) {
		free(s);
		return NULL;
	}
	s->w = w;
	s->state.q_sca = waves_efficiencies(w, NULL).sca;
	s->state.norm = waves_norm(w, s->state.q_sca);    /* k^2 C_sca: p as the sums give it, not renormalised */
	s->n = mie_terms_enough(w->n, w->a, w->b, r->tolerance);
	if (!r->direct && method_transform_pays(s->n, angles)) {
		s->series = mie_fast_amplitudes_new(s->n, w->a, w->b);
		if (!s->series) {
			free(s);
			return NULL;
		}
	}
	return &s->state;
}

static int sphere_at(const struct phase_state *state, int n, const double *theta, double complex *s1, double complex *s2)
{
	const struct opened *s = (const struct opened *)state;
	const struct waves *w = s->w;
	if (!s->series)
		return mie_amplitudes(s->n, w->a, w->b, n, theta, s1, s2);
	mie_fast_amplitudes_at(s->series, n, theta, s1, s2);
	/* What a series rounds off the forward peak is, where little is scattered backwards, most of all seen there: the few angles about
	 * that axis are summed. */
	double behind = 180 - BEHIND * (180 / M_PI) / s->n;
	int failed = 0;
	for (int i = 0, end; i < n && !failed; i = end) {
		for (end = i + 1; end < n && (theta[end] > behind) == (theta[i] > behind);)
			end++;
		if (theta[i] > behind)
			failed = mie_amplitudes(s->n, w->a, w->b, end - i, theta + i, s1 + i, s2 + i);
	}
	return failed;
}

static const struct phase_profile profile = { sphere_open, sphere_at, sphere_close };

/* Rays of an index, found by the thread that needs them first, serve all: the angles never change. */
static struct {
	double complex m;
	struct goa_plus *rays;
} kept[KEPT];
static int nkept;

static struct goa_plus *find_rays(double complex m, int n, const double *theta)
{
	struct goa_plus *g = goa_plus_new(m);
	if (!g || !goa_plus_aim(g, n, theta))
		return g;
	goa_plus_free(g);
	return NULL;
}

static int goa_plus(const struct size *size, int n, const double *theta, struct phase_result *out)
{
	struct goa_plus *g;
	struct efficiencies q;
	int k = 0, own;
#pragma omp critical
	{
		while (k < nkept && kept[k].m != size->m)
			k++;
		own = k == nkept && (k == KEPT || (k + 1) * n > METHOD_GOA_PLUS_ANGLES);
		if (k == nkept && !own && (kept[k].rays = find_rays(size->m, n, theta)))
			kept[nkept++].m = size->m;
		g = own ? NULL : kept[k].rays;
	}
	if (own)
		g = find_rays(size->m, n, theta);
	int failed = !g || goa_plus_at(g, size->x, out->s1, out->s2, &q);
	if (own)
		goa_plus_free(g);
	if (failed)
		return -1;
	out->q_sca = q.sca;
	out->norm = M_PI * size->x * size->x * q.sca;
	return 0;
}

/* A size at given angles. Where there is a choice it is by size, index and number of angles alone. */
static int model(const void *context, struct waves *w, int n, const double *theta, struct phase_result *out)
{
	const struct request *r = context;
	if (r->rough > 0) {
		out->method = "mie";
		out->error = r->tolerance;
		const struct sphere sphere = { .x = w->size.x, .m = w->size.m };
		double error;
		if (w->size.x_im == 0 && method_goa_plus_pays(&sphere, n, r->rough, &error)) {
			out->method = "goa+";
			out->error = error;
			return goa_plus(&w->size, n, theta, out);
		}
	}
	struct phase_state *s = sphere_open(context, w, (size_t)n);
	if (!s)
		return -1;
	out->q_sca = s->q_sca;
	out->norm = s->norm;
	int failed = sphere_at(s, n, theta, out->s1, out->s2);
	sphere_close(s);
	return failed;
}

int main(int argc, char **argv)
{
	static struct sizes_options sizes = SIZES_INIT;    /* static: the lists in it live as long as the process */
	static struct phase_options phase = { .profile = &profile };
	static struct request request;
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
	struct coeffs *in = coeffs_open(&sizes, args.n ? args.operand[0] : NULL);
	/* Of what is given, angles and sizes, GOA+ may have all of the error. */
	if (!isnan(tolerance) && phase.angles && !phase.average && !request.direct && !coeffs_read(in))
		request.rough = tolerance;
	if (phase.verbose && request.rough == 0)
		warn("verbose", "method mie for all sizes");
	phase_table(&phase, in, model, &request, output, args.history);
	coeffs_close(in);
	return 0;
}

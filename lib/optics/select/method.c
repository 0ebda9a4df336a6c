#include "optics/select/method.h"

#include "optics/cam/cam.h"
#include "optics/closed_form/evans_fournier.h"
#include "optics/closed_form/rayleigh.h"
#include "optics/goa/goa.h"
#include "optics/goa/goa_plus.h"

#include <math.h>
#include <stdlib.h>

/* ------------------------------------------------------------------ efficiencies */

static struct efficiencies by_rayleigh(const struct sphere *s, const void *prepared, int asked, double *error)
{
	(void)prepared, (void)asked;
	*error = rayleigh_error(s->x, s->m);
	return rayleigh_efficiencies(s->x, s->m);
}

static struct efficiencies by_evans_fournier(const struct sphere *s, const void *prepared, int asked, double *error)
{
	(void)prepared, (void)asked;
	*error = evans_fournier_error(s->x, s->m);
	return evans_fournier_efficiencies(s->x, s->m);
}

static void *cam_prepare(double complex m) { return cam_new(m); }
static void cam_extend(void *cam, double x) { cam_reach(cam, x); }
static void cam_forget(void *cam) { cam_free(cam); }

/* Asked for by its name it has the ripple, which takes longer. */
static struct efficiencies by_cam(const struct sphere *s, const void *prepared, int asked, double *error)
{
	*error = cam_error(s->x, s->m);
	return cam_at(prepared, s->x, asked);
}

#define GOA_ORDER 3          /* rays of the phase function, as published; extinction has the ray of one chord only */

/* Of an index: for extinction, and for the rays. */
struct goa_prepared {
	struct goa *first, *rays;
	int failed;                /* memory ran out */
};

static void goa_forget(void *prepared)
{
	struct goa_prepared *p = prepared;
	goa_free(p->first);
	goa_free(p->rays);
	free(p);
}

static void *goa_prepare(double complex m)
{
	struct goa_prepared *p = calloc(1, sizeof *p);
	if (!p)
		return NULL;
	p->first = goa_new(m, 1);
	p->rays = goa_new(m, GOA_ORDER);
	if (p->first && p->rays)
		return p;
	goa_forget(p);
	return NULL;
}

static void goa_extend(void *prepared, double x)
{
	struct goa_prepared *p = prepared;
	p->failed |= goa_reach(p->first, x) || goa_reach(p->rays, x);
}

static struct efficiencies by_goa(const struct sphere *s, const void *prepared, int asked, double *error)
{
	const struct goa_prepared *p = prepared;
	struct efficiencies rays = { 0 }, q = { 0 };
	double norm;
	(void)asked;
	*error = INFINITY;
	if (p->failed || goa_measure(p->rays, s->x, &rays, &norm, error) || goa_measure(p->first, s->x, &q, &norm, error))
		return q;
	q.g = rays.g;
	q.back = rays.back;
	/* g lacks the light of four and more chords */
	*error = 1.2 * *error + 0.01 * fmax(1, creal(s->m) / 2) * exp(-8 * s->x * cimag(s->m));
	return q;
}

/* Costs in terms of Lorenz-Mie series, of which a sphere has about x: time over that of mie_many, as `method_selection --costs' of the tests measures
 * it. AVX-512, m = 1.33, 1.5, 1.33+0.001i, 1.5+0.1i (and 0.75), x = 100 to 1e4: the fit 42 to 83; CAM 300 to 430 (1200), and for each
 * octave that the sizes of an index spread over 1.0e5 to 1.3e5 (2.9e5). The table's are round, with margin: a sphere that Lorenz-Mie theory
 * serves is exact. Rayleigh's 6 to 14 are less than any series. */
const struct method_row method_table[METHODS] = {
	[METHOD_AUTO] = { .name = "auto" },
	[METHOD_MIE] = { .name = "mie" },      /* its cost: the number of terms; it serves where no other does */
	[METHOD_RAYLEIGH] = { .name = "rayleigh", .serves = METHOD_SMALL, .error = rayleigh_error, .efficiencies = by_rayleigh },
	/* never for auto: CAM is cheaper and closer */
	[METHOD_GOA] = { .name = "goa", .efficiencies = by_goa, .prepare = goa_prepare, .extend = goa_extend, .forget = goa_forget },
	[METHOD_CAM] = { .name = "cam", .serves = METHOD_LARGE, .cost = 500, .first = 100000, .first_absorbing = 300000,
		.error = cam_error, .efficiencies = by_cam, .prepare = cam_prepare, .extend = cam_extend, .forget = cam_forget },
	/* after CAM, which is closer and, once prepared, hardly dearer */
	[METHOD_EVANS_FOURNIER] = { .name = "evans-fournier", .serves = METHOD_LARGE, .cost = 100, .error = evans_fournier_error,
		.efficiencies = by_evans_fournier },
};

/* ------------------------------------------------------------------ amplitudes */

/* Costs in 0.3 ns, which a term takes at an angle, as measured with AVX-512. */
static const struct {
	double begin, term, angle, term_angle;
} cost_sums = { .term_angle = 1 }, cost_transform = { .begin = 4e5, .term = 1200, .angle = 90 },
	/* before its terms are known, x of them: coefficients, and sums or, at many angles, what a transform costs a term */
	cost_mie = { .term = 100, .term_angle = 1 },
	/* waves at the edge, and 20 us an angle for rays, shared by so many sizes */
	cost_goa_plus = { .begin = 1e6, .angle = 64000.0 / 8 };

int method_transform_pays(int terms, size_t angles)
{
	double n = (double)angles;
	return cost_sums.term_angle * terms * n > cost_transform.begin + cost_transform.term * terms + cost_transform.angle * n;
}

int method_goa_plus_pays(const struct sphere *s, int angles, double tolerance, double *error)
{
	double mie = s->x * (cost_mie.term + cost_mie.term_angle * fmin(angles, cost_transform.term));
	*error = goa_plus_error(s->x, s->m);
	return *error <= tolerance && angles <= METHOD_GOA_PLUS_ANGLES && mie > cost_goa_plus.begin + cost_goa_plus.angle * angles;
}

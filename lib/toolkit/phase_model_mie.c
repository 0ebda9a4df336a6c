#include "toolkit/phase_model_mie.h"

#include "base/die.h"
#include "optics/goa/goa_plus.h"
#include "optics/mie/mie_fast_amplitudes.h"
#include "optics/select/method.h"

#include <math.h>
#include <stdlib.h>

#define BEHIND 10         /* from 180 degrees, over the number of partial waves */
#define KEPT 64           /* indices whose rays are kept; others' are found for each size */

struct context {
	const struct phase_model_mie *request;
	int n;                /* indices whose rays are kept: found by the thread that needs them first, they serve all */
	struct {
		double complex m;
		struct goa_plus *rays;
	} kept[KEPT];
};

/* One sphere: its series, or the coefficients for sums; or its rays. */
struct opened {
	struct phase_sphere known;
	struct waves *w;
	int n;
	struct legendre_series *series;
	struct goa_plus *rays;        /* NULL: Lorenz-Mie theory */
	int own;                      /* they are not kept */
};

static struct goa_plus *find_rays(double complex m, int n, const double *theta)
{
	struct goa_plus *g = goa_plus_new(m);
	if (!g || !goa_plus_aim(g, n, theta))
		return g;
	goa_plus_free(g);
	return NULL;
}

static int open_rays(struct context *c, struct opened *s, int n, const double *theta)
{
	double complex m = s->w->size.m;
	int k = 0;
#pragma omp critical
	{
		while (k < c->n && c->kept[k].m != m)
			k++;
		s->own = k == c->n && (k == KEPT || (k + 1) * n > METHOD_GOA_PLUS_ANGLES);
		if (k == c->n && !s->own && (c->kept[k].rays = find_rays(m, n, theta)))
			c->kept[c->n++].m = m;
		s->rays = s->own ? NULL : c->kept[k].rays;
	}
	if (s->own)
		s->rays = find_rays(m, n, theta);
	return s->rays ? 0 : -1;
}

static int open_waves(const struct phase_model_mie *r, struct opened *s, size_t angles)
{
	struct waves *w = s->w;
	if (waves_solve(w))
		return -1;
	s->known.q_sca = waves_efficiencies(w, NULL).sca;
	s->known.norm = waves_norm(w, s->known.q_sca);    /* k^2 C_sca: p as the sums give it, not renormalised */
	s->n = mie_terms_enough(w->n, w->a, w->b, r->tolerance);
	if (!r->direct && method_transform_pays(s->n, angles)) {
		s->series = mie_fast_amplitudes_new(s->n, w->a, w->b);
		return s->series ? 0 : -1;
	}
	return 0;
}

/* Where there is a choice of method it is by size, index and number of angles alone. */
static struct phase_sphere *open_sphere(void *context, struct waves *w, size_t n, const double *theta)
{
	struct context *c = context;
	const struct phase_model_mie *r = c->request;
	struct opened *s = calloc(1, sizeof *s);
	int failed, plus = 0;
	if (!s)
		return NULL;
	s->w = w;
	if (theta && r->rough > 0) {
		const struct sphere sphere = { .x = w->size.x, .m = w->size.m };
		double error;
		plus = w->size.x_im == 0 && method_goa_plus_pays(&sphere, (int)n, r->rough, &error);
		s->known.method = plus ? "goa+" : "mie";
		s->known.error = plus ? error : r->tolerance;
	}
	failed = plus ? open_rays(c, s, (int)n, theta) : open_waves(r, s, n);
	if (!failed)
		return &s->known;
	free(s);
	return NULL;
}

static int at(struct phase_sphere *known, int n, const double *theta, double complex *s1, double complex *s2)
{
	struct opened *s = (struct opened *)known;
	const struct waves *w = s->w;
	if (s->rays) {
		struct efficiencies q;
		double x = w->size.x;
		if (goa_plus_at(s->rays, x, s1, s2, &q))
			return -1;
		known->q_sca = q.sca;
		known->norm = M_PI * x * x * q.sca;
		return 0;
	}
	if (!s->series)
		return mie_amplitudes(s->n, w->a, w->b, n, theta, s1, s2);
	mie_fast_amplitudes_at(s->series, n, theta, s1, s2);
	/* What a series rounds off the forward peak is, where little is scattered backwards, most of all seen there: the few angles
	 * about that axis are summed. */
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

static void close_sphere(struct phase_sphere *known)
{
	struct opened *s = (struct opened *)known;
	legendre_series_free(s->series);
	waves_drop(s->w);
	if (s->own)
		goa_plus_free(s->rays);
	free(s);
}

struct phase_model phase_model_mie_new(const struct phase_model_mie *request)
{
	struct context *c = xalloc(1, sizeof *c);
	c->request = request;
	return (struct phase_model){ c, 1, 0, open_sphere, at, close_sphere };
}

void phase_model_mie_free(struct phase_model *model)
{
	struct context *c = model->context;
	for (int k = 0; k < c->n; k++)
		goa_plus_free(c->kept[k].rays);
	free(c);
}

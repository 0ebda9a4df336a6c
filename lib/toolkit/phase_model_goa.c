#include "toolkit/phase_model_goa.h"

#include "base/die.h"
#include "optics/goa/goa.h"
#include "optics/goa/goa_plus.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

#define KEPT 8         /* indices whose rays a thread keeps: wavelengths of one material, in turn for each size */

/* What is known of one refractive index; one of the two. */
struct rays {
	struct goa *goa;
	struct goa_plus *plus;
	double complex m;
};

struct context {
	enum phase_model_goa which;
	int order, threads;
	struct thread {
		struct rays kept[KEPT];
		int oldest;
	} *thread;
	double worst_error, worst_x;    /* in this run */
};

struct sphere {
	struct phase_sphere known;
	struct context *context;
	struct rays *rays;
	double x, blur, error;
};

static struct rays *rays_of(struct context *c, double complex m)
{
	struct thread *t = &c->thread[omp_get_thread_num()];
	for (int k = 0; k < KEPT; k++)
		if ((t->kept[k].goa || t->kept[k].plus) && t->kept[k].m == m)
			return &t->kept[k];
	struct rays *r = &t->kept[t->oldest++ % KEPT];
	goa_free(r->goa);
	goa_plus_free(r->plus);
	r->m = m;
	r->goa = c->which == PHASE_GOA_PLUS ? NULL : goa_new(m, c->order);
	r->plus = c->which == PHASE_GOA_PLUS ? goa_plus_new(m) : NULL;
	return r->goa || r->plus ? r : NULL;
}

static struct phase_sphere *open_sphere(void *context, struct waves *w, size_t n, const double *theta)
{
	struct context *c = context;
	struct sphere *s = calloc(1, sizeof *s);
	if (!s)
		return NULL;
	s->context = c;
	s->x = w->size.x;
	s->blur = w->blur;
	s->rays = rays_of(c, w->size.m);
	int failed = !s->rays;
	if (!failed && s->rays->plus) {
		failed = goa_plus_aim(s->rays->plus, (int)n, theta);
		s->error = goa_plus_error(w->size.x, w->size.m);
	} else if (!failed) {
		struct efficiencies q;
		failed = goa_aim(s->rays->goa, (int)n, theta) || goa_measure(s->rays->goa, s->x, &q, &s->known.norm, &s->error);
		s->known.q_sca = q.sca;
	}
	if (!failed)
		return &s->known;
	free(s);
	return NULL;
}

/* Powers without phases: their roots stand as the real parts of the amplitudes. blur: of waves; 0: no interference. */
static int powers(struct goa *g, double x, double blur, int n, double complex *s1, double complex *s2, double *norm)
{
	double *power = malloc(2 * (size_t)n * sizeof *power);
	int failed = !power || (blur > 0 ? goa_blurred(g, x, blur, power, power + n) : goa_incoherent(g, x, power, power + n, norm));
	for (int k = 0; !failed && k < n; k++) {
		s1[k] = sqrt(power[k]);
		s2[k] = sqrt(power[n + k]);
	}
	free(power);
	return failed ? -1 : 0;
}

static int at(struct phase_sphere *known, int n, const double *theta, double complex *s1, double complex *s2)
{
	struct sphere *s = (struct sphere *)known;
	struct rays *r = s->rays;
	(void)theta;    /* those that the rays were found for */
	if (r->plus) {
		struct efficiencies q;
		if (goa_plus_at(r->plus, s->x, s1, s2, &q))
			return -1;
		known->norm = M_PI * s->x * s->x * q.sca;
		known->q_sca = q.sca;
		return 0;
	}
	if (s->context->which == PHASE_GOA && s->blur == 0)
		goa_at(r->goa, s->x, s1, s2);
	else if (powers(r->goa, s->x, s->context->which == PHASE_GOA ? s->blur : 0, n, s1, s2, &known->norm))
		return -1;
	/* Far below where GOA holds its extinction can be negative; the weight in an average cannot. */
	if (!(known->q_sca > 0))
		known->q_sca = known->norm / (M_PI * s->x * s->x);
	return 0;
}

static void close_sphere(struct phase_sphere *known)
{
	struct sphere *s = (struct sphere *)known;
	struct context *c = s->context;
#pragma omp critical
	if (s->error > c->worst_error || (s->error == c->worst_error && s->x < c->worst_x)) {
		c->worst_error = s->error;
		c->worst_x = s->x;
	}
	free(s);
}

struct phase_model phase_model_goa_new(enum phase_model_goa which, int order, int threads)
{
	struct context *c = xalloc(1, sizeof *c);
	c->which = which;
	c->order = order;
	c->threads = threads;
	c->thread = xalloc((size_t)threads, sizeof *c->thread);
	return (struct phase_model){ c, 0, which == PHASE_GOA, open_sphere, at, close_sphere };
}

void phase_model_goa_free(struct phase_model *model)
{
	struct context *c = model->context;
	for (int i = 0; i < c->threads; i++)
		for (int k = 0; k < KEPT; k++) {
			goa_free(c->thread[i].kept[k].goa);
			goa_plus_free(c->thread[i].kept[k].plus);
		}
	free(c->thread);
	free(c);
}

double phase_model_goa_worst(const struct phase_model *model, double *x)
{
	const struct context *c = model->context;
	*x = c->worst_x;
	return c->worst_error;
}

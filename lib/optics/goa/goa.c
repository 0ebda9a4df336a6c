#include "optics/goa/goa.h"

#include "optics/goa/goa_norm.h"
#include "optics/goa/impact_quadrature.h"

#include <stdlib.h>

#define PANELS 24      /* of the quadrature over the impact parameter */
#define GLORY 4        /* highest order looked at for forward glories */
#define GRIDS 26       /* sizes up to 2^0 .. 2^25 */
#define CHUNK 4096     /* angles of goa_amplitudes whose rays are held at once */

struct goa {
	double complex m;
	int order;
	const struct goa_lanes *lanes;
	struct caustic caustic[GOA_ORDER_MAX + 1];
	struct goa_rays asked, back;
	struct goa_beam *front;         /* forward up to GLORY, for the estimate of errors */
	int fronts;
	struct impact impact[IMPACT_NODES(PANELS)];
	int impacts;                    /* 0: does not absorb */
	struct goa_norm_grid grid[GRIDS];    /* for the norm, by size */
};

static void caps(const struct goa *g, double x, struct goa_cap *cap)
{
	for (int p = 1; p <= g->order || p <= GLORY; p++) {
		const struct caustic *c = &g->caustic[p];
		double u = x * cos(c->incidence);
		cap[p].rainbow = isnan(c->tau) ? 0 : cbrt(c->bend / (2 * u * u));
		cap[p].slope = fmax(0.4607 * sqrt(c->third / x), 2 / x);
		cap[p].bend = c->bend;
	}
}

static void amplitudes(const struct goa *g, const struct goa_rays *r, double x, double complex *s1, double complex *s2)
{
	struct goa_cap cap[GOA_ORDER_MAX + 1];
	caps(g, x, cap);
	for (int b = 0, from = 0; from < r->blocks.n; b++, from += GOA_WIDTH) {
		double s[4][GOA_WIDTH] = { { 0 } }, d[GOA_WIDTH];
		g->lanes->coherent(&r->packet[r->blocks.first[b]], r->blocks.first[b + 1] - r->blocks.first[b], x, cap, s);
		g->lanes->diffraction(&r->angles[b], x, d);
		for (int i = 0; i < GOA_WIDTH && from + i < r->blocks.n; i++) {
			s1[from + i] = CMPLX(s[0][i] + d[i], s[1][i]);
			s2[from + i] = CMPLX(s[2][i] + d[i], s[3][i]);
		}
	}
}

static int level_of(double x) { return (int)fmin(fmax(ceil(log2(x)), 0), GRIDS - 1); }

int goa_reach(struct goa *g, double x)
{
	int level = level_of(x);
	struct goa_norm_grid *grid = &g->grid[level];
	return grid->rays.blocks.n ? 0 : goa_norm_grid_new(g->m, g->order, g->caustic, ldexp(1, level), grid);
}

/* goa_norm_grid_sum, negative when memory ran out. */
static double integral(struct goa *g, int interfere, double x, double *along)
{
	struct goa_cap cap[GOA_ORDER_MAX + 1];
	if (goa_reach(g, x))
		return -1;
	caps(g, x, cap);
	return goa_norm_grid_sum(g->lanes, &g->grid[level_of(x)], interfere, x, cap, along);
}

struct goa *goa_new(double complex m, int order)
{
	struct goa *g = calloc(1, sizeof *g);
	if (!g)
		return NULL;
	g->m = m;
	g->order = order;
	g->lanes = goa_lanes();
	g->impacts = cimag(m) == 0 ? 0 : impact_quadrature(m, PANELS, g->impact);
	int most = order > GLORY ? order : GLORY;
	for (int p = 0; p <= most; p++)
		g->caustic[p] = rays_caustic(creal(m), p);
	g->front = malloc((size_t)((most + 1) * (most + 8)) * sizeof *g->front);    /* the sum of RAYS_MAX */
	if (g->front)
		g->fronts = goa_rays_trace(m, most, g->caustic, 0, g->front);
	if (g->front && !goa_rays_find(m, order, g->caustic, 1, (double[]){ 180 }, &g->back))
		return g;
	goa_free(g);
	return NULL;
}

void goa_free(struct goa *g)
{
	if (!g)
		return;
	free(g->front);
	goa_rays_free(&g->asked);
	goa_rays_free(&g->back);
	for (int k = 0; k < GRIDS; k++)
		goa_norm_grid_free(&g->grid[k]);
	free(g);
}

int goa_aim(struct goa *g, int n, const double *theta)
{
	if (angle_blocks_are(&g->asked.blocks, n, theta))
		return 0;
	goa_rays_free(&g->asked);
	return goa_rays_find(g->m, g->order, g->caustic, n, theta, &g->asked);
}

void goa_at(const struct goa *g, double x, double complex *s1, double complex *s2)
{
	amplitudes(g, &g->asked, x, s1, s2);
}

int goa_incoherent(struct goa *g, double x, double *i1, double *i2, double *norm)
{
	struct goa_cap cap[GOA_ORDER_MAX + 1];
	const struct goa_rays *r = &g->asked;
	double along;
	*norm = integral(g, 0, x, &along);
	if (*norm < 0)
		return -1;
	caps(g, x, cap);
	for (int b = 0, from = 0; from < r->blocks.n; b++, from += GOA_WIDTH) {
		double s[2][GOA_WIDTH] = { { 0 } }, d[GOA_WIDTH];
		g->lanes->incoherent(&r->packet[r->blocks.first[b]], r->blocks.first[b + 1] - r->blocks.first[b], x, cap, s);
		g->lanes->diffraction(&r->angles[b], x, d);
		for (int i = 0; i < GOA_WIDTH && from + i < r->blocks.n; i++) {
			i1[from + i] = s[0][i] + d[i] * d[i];
			i2[from + i] = s[1][i] + d[i] * d[i];
		}
	}
	return 0;
}

int goa_blurred(struct goa *g, double x, double fastest, double *i1, double *i2)
{
	struct goa_cap cap[GOA_ORDER_MAX + 1];
	const struct goa_rays *r = &g->asked;
	const size_t *first = r->blocks.first;
	size_t most = 0;
	for (int b = 0; b < angle_blocks_count(r->blocks.n); b++)
		most = first[b + 1] - first[b] > most ? first[b + 1] - first[b] : most;
	double (*room)[GOA_WIDTH] = malloc((most + 1) * sizeof *room);
	if (!room)
		return -1;
	caps(g, x, cap);
	for (int b = 0, from = 0; from < r->blocks.n; b++, from += GOA_WIDTH) {
		double s[2][GOA_WIDTH], d[GOA_WIDTH];
		g->lanes->diffraction(&r->angles[b], x, d);
		g->lanes->blurred(&r->packet[first[b]], first[b + 1] - first[b], &r->angles[b], d, x, cap, fastest * M_2_PI, room, s);
		for (int i = 0; i < GOA_WIDTH && from + i < r->blocks.n; i++) {
			i1[from + i] = fmax(s[0][i], 0);
			i2[from + i] = fmax(s[1][i], 0);
		}
	}
	free(room);
	return 0;
}

int goa_amplitudes(double x, double complex m, int order, int n, const double *theta, double complex *s1, double complex *s2)
{
	struct goa *g = goa_new(m, order);
	int failed = !g;
	for (int k = 0; k < n && !failed; k += CHUNK) {
		failed = goa_aim(g, n - k < CHUNK ? n - k : CHUNK, theta + k);
		if (!failed)
			goa_at(g, x, s1 + k, s2 + k);
	}
	goa_free(g);
	return failed ? -1 : 0;
}

double goa_norm(double x, double complex m, int order)
{
	struct goa *g = goa_new(m, order);
	double along, norm = g ? integral(g, 1, x, &along) : -1;
	goa_free(g);
	return norm;
}

/* Rays bent round to the forward axis off-centre (a forward glory): what eq 12 leaves out of extinction, in the mean ~ x^(-1/2). */
static double glory(const struct goa *g, double x)
{
	struct goa_cap cap[GOA_ORDER_MAX + 1];
	double sum = 0;
	caps(g, x, cap);
	for (int i = 0; i < g->fronts; i++) {
		const struct goa_beam *b = &g->front[i];
		if (!b->ray.axial)
			sum += 2 / x * goa_rays_spread(x, &b->ray, &cap[b->ray.p]) * (cabs(b->f1) + cabs(b->f2)) *
			       exp(-x * cimag(b->path));
	}
	return sum;
}

/* Extinction, eq 12 (eq 14 is its p = 1):
 *     Q = 2 - (2/x) sum_(p odd) Im{ E_p / (1 - p/m) exp(2 i x (p m - 1)) },  E_p = (1 - R^2) R^(p-1),  R = (1-m)/(1+m).
 * *missing: size of the next term of the p = 1 wave's own expansion, (1/2x) [1/(m-1) - (m-1)/m] of it (Nussenzveig and Wiscombe
 * 1980), which outgrows everything where x |m - 1| is small; without its absorption, which does not save the series there. */
static double extinction(const struct goa *g, double x, double *missing)
{
	double complex m = cabs(g->m - 1) < 1e-9 ? 1 + 1e-9 : g->m, r = (1 - m) / (1 + m), e = 1 - r * r;
	double q = 2;
	*missing = 0;
	for (int p = 1; p <= g->order; p += 2, e *= r * r) {
		double complex focus = 1 - p / m;
		double least = p == 1 ? 0 : fmax(0.4607 * sqrt(g->caustic[p].third / x), 2 / x) / 2;
		if (cabs(focus) < least)
			focus = focus == 0 ? least : focus * (least / cabs(focus));
		double complex term = 2 / x * e / focus;
		q -= cimag(term * cexp(2 * I * x * (p * m - 1)));
		if (p == 1)
			*missing = cabs(term) / (2 * x) * cabs(1 / (m * focus) - (m - 1) / m);
	}
	return q;
}

/* Absorption: of the energy that enters at each impact parameter s = sin i the part lost along all chords,
 *     Q = int_0^1 2 s ds (1/2) sum_j (1 - |R_j|^2) (1 - e^-a) / (1 - |R_j|^2 e^-a),  a = 2 x Im(chord). */
static double absorption(const struct goa *g, double x)
{
	double q = 0;
	for (int k = 0; k < g->impacts; k++) {
		const struct impact *e = &g->impact[k];
		double lost = -expm1(-2 * x * e->chord), sum = 0;
		for (int j = 0; j < 2; j++)
			if (e->reflected[j] < 1)
				sum += (1 - e->reflected[j]) * lost / (1 - e->reflected[j] * (1 - lost));
		q += e->weight / 2 * sum;
	}
	return q;
}

int goa_measure(struct goa *g, double x, struct efficiencies *q, double *norm, double *error)
{
	double complex s1, s2;
	double along, missing;
	*q = (struct efficiencies){ 0 };
	*error = INFINITY;
	*norm = integral(g, 1, x, &along);
	if (*norm < 0) {
		*norm = 0;
		return -1;
	}
	amplitudes(g, &g->back, x, &s1, &s2);
	q->ext = extinction(g, x, &missing);
	q->abs = fmin(absorption(g, x), fmax(q->ext, 0));
	q->sca = q->ext - q->abs;
	q->g = *norm > 0 ? along / *norm : 0;
	q->back = 4 * creal(s1 * conj(s1)) / (x * x);
	/* What the rays leave out is first of all the edge, 1.9924 x^(-2/3) of extinction, and a ripple about a quarter of it; of metals the
	 * next term, (2/x) Im (m^2 + 1)/sqrt(m^2 - 1), is as large. */
	double complex m2 = g->m * g->m;
	double least = fmin(q->ext, q->sca), edge = 1.25 * 1.9924 * pow(x, -2.0 / 3);
	if (cimag(m2) != 0)
		edge += 3 / x * fabs(cimag((m2 + 1) / csqrt(m2 - 1)));
	*error = least > 0 ? (edge + missing + glory(g, x)) / least : 1;
	return 0;
}

struct efficiencies goa_efficiencies(double x, double complex m, int order, double *error)
{
	struct efficiencies q = { 0 };
	double norm;
	struct goa *g = goa_new(m, order);
	*error = INFINITY;
	if (g)
		goa_measure(g, x, &q, &norm, error);
	goa_free(g);
	return q;
}

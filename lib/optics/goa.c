#include "optics/goa.h"

#include "base/cmplx.h"
#include "optics/rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NODES 8        /* nodes of a panel's quadrature */
#define CHUNK 4096    /* angles of goa_amplitudes whose rays are held at once */
#define GLORY 4       /* highest order looked at for forward glories */
#define GRIDS 16      /* sizes up to 2^0 .. beyond 2^14 */

/* Gauss-Legendre on [-1, 1], Abramowitz and Stegun table 25.4. */
static const double node[NODES] = { -0.9602898564975363, -0.7966664774136267, -0.5255324099163290, -0.1834346424956498,
	0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363 };
static const double weight[NODES] = { 0.1012285362903763, 0.2223810344533745, 0.3137066458778873, 0.3626837833783620,
	0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763 };

/* A ray and what does not depend on size: its amplitude is -x sqrt(D) f exp(i x path). */
struct beam {
	double complex f1, f2;       /* F_j with the constant phase */
	double complex path;         /* of p chords, less the way saved outside: p m 2 cos t - 2 cos i where m is real */
	struct ray ray;
};

struct beams {
	int n;                       /* angles */
	double *theta;               /* degrees */
	size_t *first;               /* first beam of each angle, n + 1 of them */
	struct beam *beam;
};

struct goa {
	double complex m;
	int order;
	struct caustic caustic[GOA_ORDER_MAX + 1];
	struct beams asked;
	struct beams front, back;    /* the axes; the front one up to GLORY, for the estimate of errors */
	struct beams grid[GRIDS];    /* for the norm, by size */
	double *weight[GRIDS];       /* with 2 pi sin theta */
};

/* Fresnel amplitudes R_1 (perpendicular), R_2 (parallel). c_t = sqrt(1 - sin^2 i/m^2), Im c_t >= 0. */
static void fresnel(double complex m, double sin_i, double cos_i, double complex *r1, double complex *r2)
{
	double complex ct;
	if (cimag(m) == 0) {
		double n = creal(m), q2 = (n - 1) * (n + 1) + cos_i * cos_i;
		ct = q2 >= 0 ? sqrt(q2) / n : CMPLX(0, sqrt(-q2) / n);
	} else {
		ct = csqrt((m * m - sin_i * sin_i) / (m * m));
		ct = CMPLX(creal(ct), fabs(cimag(ct)));    /* rounding may have put 1 + i0 below the cut */
	}
	*r1 = (cos_i - m * ct) / (cos_i + m * ct);
	*r2 = (m * cos_i - ct) / (m * cos_i + ct);
}

/* Phase path of one chord over x: 2 [sqrt(m^2 - s^2) - s (arccos(s/m) - arccos(s/n))], s = sin i; 2 n cos t for real m.
 * It keeps the ray of the real index and is exact to first order beyond it (physics of appendix C, improved). */
static double complex chord(double complex m, const struct ray *r)
{
	if (cimag(m) == 0)
		return 2 * r->q;
	double n = creal(m), s = r->sin_i;
	double complex root = csqrt(m * m - s * s), bend = s * (cacos(s / m) - acos(fmin(s / n, 1)));
	double complex path = 2 * (root - bend);
	return CMPLX(creal(path), fmax(cimag(path), 0));
}

static int trace(double complex m, int order, const struct caustic *caustic, double theta, struct beam *out)
{
	static const double complex eighth[8] = { 1, CMPLX(M_SQRT1_2, M_SQRT1_2), I, CMPLX(-M_SQRT1_2, M_SQRT1_2),
		-1, CMPLX(-M_SQRT1_2, -M_SQRT1_2), -I, CMPLX(M_SQRT1_2, -M_SQRT1_2) };
	struct ray ray[RAYS_MAX(GOA_ORDER_MAX)];
	int n = 0;
	for (int p = 0; p <= order; p++) {
		int rays = rays_find(creal(m), p, &caustic[p], theta, ray);
		for (int k = 0; k < rays; k++) {
			const struct ray *r = &ray[k];
			struct beam *b = &out[n];
			double complex r1, r2;
			fresnel(m, r->sin_i, r->cos_i, &r1, &r2);
			double complex f1 = p ? 1 - r1 * r1 : r1, f2 = p ? 1 - r2 * r2 : r2;
			for (int i = 1; i < p; i++) {
				f1 *= -r1;
				f2 *= -r2;
			}
			if (cabs(f1) + cabs(f2) < 1e-18)    /* nothing, whatever the size; of 100 orders most */
				continue;
			b->f1 = f1 * eighth[r->eighths];
			b->f2 = f2 * eighth[r->eighths];
			b->path = (p ? p * chord(m, r) : 0) - 2 * r->cos_i;
			b->ray = *r;
			n++;
		}
	}
	return n;
}

static void beams_free(struct beams *b)
{
	free(b->theta);
	free(b->first);
	free(b->beam);
	memset(b, 0, sizeof *b);
}

static int beams_find(const struct goa *g, int order, int n, const double *theta, struct beams *b)
{
	size_t room = 0, used = 0, most = 0;
	for (int p = 0; p <= order; p++)
		most += RAYS_MAX(p);
	memset(b, 0, sizeof *b);
	b->n = n;
	b->theta = malloc((n ? (size_t)n : 1) * sizeof *b->theta);
	b->first = malloc(((size_t)n + 1) * sizeof *b->first);
	if (!b->theta || !b->first)
		goto no_memory;
	for (int k = 0; k < n; k++) {
		b->theta[k] = theta[k];
		b->first[k] = used;
		if (used + most > room) {
			room = 2 * room + most;
			struct beam *more = realloc(b->beam, room * sizeof *more);
			if (!more)
				goto no_memory;
			b->beam = more;
		}
		used += (size_t)trace(g->m, order, g->caustic, theta[k], b->beam + used);
	}
	b->first[n] = used;
	return 0;
no_memory:
	beams_free(b);
	return -1;
}

/* What the caps of goa.h allow at size x, for one order. */
struct cap {
	double rainbow;       /* dT */
	double slope;         /* least |Theta'| */
};

static void caps(const struct goa *g, double x, struct cap *cap)
{
	for (int p = 1; p <= g->order || p <= GLORY; p++) {
		const struct caustic *c = &g->caustic[p];
		double u = x * cos(c->incidence);
		cap[p].rainbow = isnan(c->tau) ? 0 : cbrt(c->bend / (2 * u * u));
		cap[p].slope = fmax(0.4607 * sqrt(c->third / x), 2 / x);
	}
}

/* sqrt(D), D = sin i cos i / (sin theta |Theta'|). */
static double spread(double x, const struct ray *r, const struct cap *cap, const struct caustic *c)
{
	if (r->p == 0)
		return 0.5;
	double slope = r->slope, ratio = r->ratio, dt = cap[r->p].rainbow, least = cap[r->p].slope;
	if (r->gap < dt)
		slope = r->gap > 1e-10 * dt ? slope * sqrt(dt / r->gap) : sqrt(2 * c[r->p].bend * dt);
	slope = fmax(slope, least);
	double most = r->axial ? 1 / least : fmax(1 / least, x * r->sin_i * r->sin_i);
	return sqrt(fmin(ratio, most) * r->cos_i / slope);
}

/* J1(x sin theta)/(x sin theta) x^2 in the forward half. */
static double diffraction(double x, double theta)
{
	if (theta >= 90)
		return 0;
	double z = x * sin(theta * (M_PI / 180));
	return z < 1e-4 ? x * x * (0.5 - z * z / 16) : x * x * j1(z) / z;
}

static void amplitudes(const struct goa *g, const struct beams *b, double x, double complex *s1, double complex *s2)
{
	struct cap cap[GOA_ORDER_MAX + 1];
	caps(g, x, cap);
	for (int k = 0; k < b->n; k++) {
		double complex sum1 = 0, sum2 = 0;
		for (size_t i = b->first[k]; i < b->first[k + 1]; i++) {
			const struct beam *beam = &b->beam[i];
			double phase = x * creal(beam->path), fade = x * cimag(beam->path), sine, cosine;
			double size = x * spread(x, &beam->ray, cap, g->caustic);
			if (fade > 0)
				size *= exp(-fade);
			sincos(phase, &sine, &cosine);
			double complex wave = CMPLX(size * cosine, size * sine);
			sum1 -= wave * beam->f1;
			sum2 -= wave * beam->f2;
		}
		double d = diffraction(x, b->theta[k]);
		s1[k] = sum1 + d;
		s2[k] = sum2 + d;
	}
}

/* How strongly nodes must crowd towards the axis: b with (pi/2) b/sinh(b) = step * half, the width of the first of half panels. */
static double crowding(double step, int half)
{
	double lo = 0, hi = 40, want = step * half / (M_PI / 2);
	if (want >= 1)
		return 0;
	for (int k = 0; k < 60; k++) {
		double b = (lo + hi) / 2;
		if (b / sinh(b) > want)
			lo = b;
		else
			hi = b;
	}
	return lo;
}

/* Angles and weights that integrate |S|^2 for sizes up to x: panels 5/x wide, in which the fastest interference turns by 10 rad.
 * Beyond x = 6000 that would be too many; panels then widen away from the axes, and interference far from them is sampled
 * rather than resolved. */
static int grid_new(struct goa *g, double x, struct beams *b, double **weights)
{
	int half = (int)fmin(fmax(ceil(M_PI / 2 * x / 5), 64), 2048), n = 2 * half * NODES;
	double crowd = crowding(5 / x, half), *theta = malloc((size_t)n * sizeof *theta), *w = malloc((size_t)n * sizeof *w);
	if (!theta || !w)
		goto no_memory;
	for (int k = 0; k < half; k++) {
		double at[2];
		for (int e = 0; e < 2; e++) {
			double u = (double)(k + e) / half;
			at[e] = 90 * (crowd > 0 ? sinh(crowd * u) / sinh(crowd) : u);
		}
		for (int j = 0; j < NODES; j++) {
			double t = (at[0] + at[1]) / 2 + node[j] * (at[1] - at[0]) / 2;
			int i = k * NODES + j, mirror = n - 1 - i;
			theta[i] = t;
			theta[mirror] = 180 - t;
			w[i] = w[mirror] = 2 * M_PI * sin(t * (M_PI / 180)) * weight[j] * (at[1] - at[0]) / 2 * (M_PI / 180);
		}
	}
	if (beams_find(g, g->order, n, theta, b))
		goto no_memory;
	free(theta);
	*weights = w;
	return 0;
no_memory:
	free(theta);
	free(w);
	return -1;
}

/* Integrals over the sphere of (|S1|^2 + |S2|^2)/2, and of the same times cos theta. */
static int integrals(struct goa *g, double x, double *all, double *along)
{
	int level = (int)fmin(fmax(ceil(log2(x)), 0), GRIDS - 1);
	struct beams *b = &g->grid[level];
	if (level == GRIDS - 1)    /* made for each size */
		beams_free(b), free(g->weight[level]), g->weight[level] = NULL;
	if (!b->n && grid_new(g, level == GRIDS - 1 ? x : ldexp(1, level), b, &g->weight[level]))
		return -1;
	double complex *s1 = malloc((size_t)b->n * sizeof *s1), *s2 = malloc((size_t)b->n * sizeof *s2);
	*all = *along = 0;
	if (s1 && s2) {
		amplitudes(g, b, x, s1, s2);
		for (int k = 0; k < b->n; k++) {
			double a = cabs(s1[k]), c = cabs(s2[k]), v = g->weight[level][k] * (a * a + c * c) / 2;
			*all += v;
			*along += v * cos(b->theta[k] * (M_PI / 180));
		}
	}
	int status = s1 && s2 ? 0 : -1;
	free(s1);
	free(s2);
	return status;
}

struct goa *goa_new(double complex m, int order)
{
	struct goa *g = calloc(1, sizeof *g);
	if (!g)
		return NULL;
	g->m = m;
	g->order = order;
	for (int p = 0; p <= order || p <= GLORY; p++)
		g->caustic[p] = rays_caustic(creal(m), p);
	if (!beams_find(g, order > GLORY ? order : GLORY, 1, (double[]){ 0 }, &g->front) &&
	    !beams_find(g, order, 1, (double[]){ 180 }, &g->back))
		return g;
	goa_free(g);
	return NULL;
}

void goa_free(struct goa *g)
{
	if (!g)
		return;
	beams_free(&g->asked);
	beams_free(&g->front);
	beams_free(&g->back);
	for (int k = 0; k < GRIDS; k++) {
		beams_free(&g->grid[k]);
		free(g->weight[k]);
	}
	free(g);
}

int goa_aim(struct goa *g, int n, const double *theta)
{
	if (n && n == g->asked.n && !memcmp(theta, g->asked.theta, (size_t)n * sizeof *theta))
		return 0;
	beams_free(&g->asked);
	return beams_find(g, g->order, n, theta, &g->asked);
}

void goa_at(const struct goa *g, double x, double complex *s1, double complex *s2)
{
	amplitudes(g, &g->asked, x, s1, s2);
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
	double norm = -1, along;
	struct goa *g = goa_new(m, order);
	if (!g || integrals(g, x, &norm, &along))
		norm = -1;
	goa_free(g);
	return norm;
}

/* Rays bent round to the forward axis off-centre (a forward glory): what eq 12 leaves out of extinction, in the mean ~ x^(-1/2). */
static double glory(const struct goa *g, double x)
{
	struct cap cap[GOA_ORDER_MAX + 1];
	double sum = 0;
	caps(g, x, cap);
	for (size_t i = 0; i < g->front.first[1]; i++) {
		const struct beam *b = &g->front.beam[i];
		if (!b->ray.axial)
			sum += 2 / x * spread(x, &b->ray, cap, g->caustic) * (cabs(b->f1) + cabs(b->f2)) * exp(-x * cimag(b->path));
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
static double absorption(double complex m, double x)
{
	enum { PANELS = 24 };
	double n = creal(m), edge = n < 1 ? asin(n) : M_PI / 2, q = 0;
	if (cimag(m) == 0)
		return 0;
	for (int k = 0; k < 2 * PANELS; k++) {
		double lo = k < PANELS ? edge * k / PANELS : edge + (M_PI / 2 - edge) * (k - PANELS) / PANELS;
		double width = k < PANELS ? edge / PANELS : (M_PI / 2 - edge) / PANELS;
		if (width == 0)
			break;
		for (int j = 0; j < NODES; j++) {
			double i = lo + width * (1 + node[j]) / 2, s = sin(i), c = cos(i);
			struct ray r = { .sin_i = s, .cos_i = c };
			double complex r1, r2;
			fresnel(m, s, c, &r1, &r2);
			double kept = k < PANELS ? exp(-2 * x * cimag(chord(m, &r))) : 0;
			double lost = k < PANELS ? -expm1(-2 * x * cimag(chord(m, &r))) : 1;
			double sum = 0, reflected[2] = { creal(r1 * conj(r1)), creal(r2 * conj(r2)) };
			for (int f = 0; f < 2; f++)
				if (reflected[f] < 1)
					sum += (1 - reflected[f]) * lost / (1 - reflected[f] * kept);
			q += weight[j] * width / 2 * 2 * s * c * sum / 2;
		}
	}
	return q;
}

int goa_measure(struct goa *g, double x, struct efficiencies *q, double *norm, double *error)
{
	double complex s1, s2;
	double along, missing;
	*q = (struct efficiencies){ 0 };
	*error = INFINITY;
	if (integrals(g, x, norm, &along))
		return -1;
	amplitudes(g, &g->back, x, &s1, &s2);
	q->ext = extinction(g, x, &missing);
	q->abs = fmin(absorption(g->m, x), fmax(q->ext, 0));
	q->sca = q->ext - q->abs;
	q->g = *norm > 0 ? along / *norm : 0;
	q->back = 4 * creal(s1 * conj(s1)) / (x * x);
	/* What the rays leave out is first of all the edge, 1.9924 x^(-2/3) of extinction; and a ripple about a quarter of it. */
	double least = fmin(q->ext, q->sca), edge = 1.25 * 1.9924 * pow(x, -2.0 / 3);
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

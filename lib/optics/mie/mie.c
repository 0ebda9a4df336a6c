#include "optics/mie/mie.h"

#include "optics/numerics/lane_math.h"
#include "optics/mie/mie_lanes.h"
#include "optics/mie/mie_resonances.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* one sphere, in plain doubles */
#define LANES 1
#define UNROLL 1
#include "optics/mie/mie_coefficients.h"

int mie_terms(double x, double complex m)
{
	double edge = lane_cbrt(x), broad = cimag(m) * x;
	double n = x + 7 * edge + 8;                  /* psi_l / chi_l < 1e-16, falling as e^(-1.89 t^(3/2)) at x + t x^(1/3) */
	if (broad >= 1)
		return (int)n + 1;
	/* Narrow resonances, below y, lift it by 1/chi_l^2, but by no more than absorption, which broadens them: < 1e-32 without any. */
	double t = 12;
	if (broad > 1e-18) {
		double width = (36 - log(broad)) / 1.89;
		t = lane_cbrt(width * width);
	}
	double y = sqrt(norm2(m)) * x + 2, most = x + t * edge + 10, narrow = y < most ? y : most;
	return (int)(n > narrow ? n : narrow) + 1;
}

/* A chunk of orders: arrays from the one before its first. */
struct chunk {
	double psi[1 + MIE_CHUNK + MIE_SPARE], chi[1 + MIE_CHUNK + MIE_SPARE], p[1 + MIE_CHUNK + MIE_SPARE];
	double size[MIE_CHUNK + MIE_SPARE], re[MIE_CHUNK + MIE_SPARE], im[MIE_CHUNK + MIE_SPARE];
	double wave[4][1 + MIE_CHUNK + MIE_SPARE], sca[MIE_CHUNK + MIE_SPARE];
};

/* From so many terms on p is computed twice, the second time chunk by chunk: all of it would not fit into caches. */
#define TWICE 16384

/* Upward over orders l .. l + count - 1. */
INLINE void upward_chunk(struct upward *k, const struct constants *g, const struct downward_orders *e, int with_p, int l, int count,
                         int from_x, struct chunk *c)
{
	struct upward own = *k;
	c->psi[0] = own.psi;
	c->chi[0] = own.chi;
	c->p[0] = own.p;
	for (int i = 1; i <= count; i++, l++) {
		upward_to(&own, g, with_p, l, 2.0 * l - 1, from_x, from_x ? e->x[l - 1] : 0);
		c->psi[i] = own.psi;
		c->chi[i] = own.chi;
		if (with_p)
			c->p[i] = own.p;
	}
	*k = own;
}

/* p of the chunk from order l on, again; to n. */
static struct psi_products psi_downward_chunk(const struct psi_downward *marks, const struct psi_course *course, int l, int n,
                                              struct chunk *c)
{
	struct psi_products t = { .size = c->size, .re = c->re, .im = c->im, .base = l, .n = n };
	int top = (course->most + 1) & ~1, end = l - 1 + MIE_CHUNK;
	struct psi_downward d = end < top ? marks[end / MIE_CHUNK] : psi_downward_start();
	psi_downward(&d, course, end < top ? end : top, l - 1, &t, NULL);
	return t;
}

/* The orders of one sphere, chunk after chunk to take: recurrences one order after the other, coefficients from these side by side. */
static int by_orders(const struct mie_lanes *lanes, double x, double complex m, int n, int weighted,
                     void (*take)(const struct mie_lanes *, const struct mie_row *, void *), void *context)
{
	struct spheres s = { .x = { x }, .m_re = { creal(m) }, .m_im = { cimag(m) }, .terms = { n }, .most = n, .absorb = cimag(m) > 0,
		.near = mie_near(m) };
	int twice = s.absorb && !s.near && n >= TWICE;
	double *room = malloc(((twice ? 3 : DOWNWARD_ARRAYS) * ((size_t)n + 2) + MIE_SPARE) * sizeof *room);
	struct psi_downward *marks = twice ? malloc(((size_t)n / MIE_CHUNK + 2) * sizeof *marks) : NULL;
	struct chunk c;
	if (!room || (twice && !marks)) {
		free(room);
		free(marks);
		return -1;
	}
	for (int i = 0; i < 4; i++)
		c.wave[i][0] = 0;
	struct downward_orders e = downward_all(&s, room, marks);
	const struct constants g = constants_of(s.absorb, x, creal(m), cimag(m), e.beyond[0], n);
	int with_p = !s.absorb && !s.near;
	struct upward k = upward_start(&g, with_p);
	for (int l = 1, count; l <= n; l += count) {
		count = n + 1 - l < MIE_CHUNK ? n + 1 - l : MIE_CHUNK;
		if (l + count > x)
			upward_chunk(&k, &g, &e, with_p, l, count, 1, &c);
		else if (with_p)
			upward_chunk(&k, &g, &e, 1, l, count, 0, &c);
		else
			upward_chunk(&k, &g, &e, 0, l, count, 0, &c);
		if (twice)
			e.p = psi_downward_chunk(marks, &e.course, l, n, &c);
		int at = l - e.p.base;
		struct mie_row row = { .absorbs = s.absorb, .near = s.near, .first = l, .count = count, .weighted = weighted,
			.x = x, .m_re = creal(m), .m_im = cimag(m), .beyond = e.beyond[0], .psi = c.psi, .chi = c.chi, .p = c.p,
			.ex = e.x + l, .er = e.y_re + l, .ei = e.y_im + l, .size = e.p.size + at, .re = e.p.re + at, .im = e.p.im + at,
			.a_re = c.wave[0] + 1, .a_im = c.wave[1] + 1, .b_re = c.wave[2] + 1, .b_im = c.wave[3] + 1, .sca = c.sca };
		lanes->waves(&row);
		take(lanes, &row, context);
		for (int i = 0; i < 4; i++)
			c.wave[i][0] = c.wave[i][count];
	}
	free(room);
	free(marks);
	return 0;
}

struct coefficients {
	double complex *a, *b;
};

static void take_coefficients(const struct mie_lanes *lanes, const struct mie_row *r, void *context)
{
	struct coefficients *to = context;
	(void)lanes;
	for (int i = 0; i < r->count; i++) {
		to->a[r->first + i] = CMPLX(r->a_re[i], r->a_im[i]);
		to->b[r->first + i] = CMPLX(r->b_re[i], r->b_im[i]);
	}
}

int mie_coefficients(double x, double complex m, int n, double complex *a, double complex *b)
{
	a[0] = b[0] = 0;
	return by_orders(mie_lanes(), x, m, n, 0, take_coefficients, &(struct coefficients){ a, b });
}

static void take_sums(const struct mie_lanes *lanes, const struct mie_row *r, void *context) { lanes->sums(r, context); }

int mie_one(const struct mie_lanes *lanes, double x, double complex m, int n, struct efficiencies *q, double *error)
{
	struct mie_sums sums = { 0 };
	int bad = by_orders(lanes, x, m, n, 1, take_sums, &sums);
	*q = mie_sums_efficiencies(x, cimag(m) == 0, &sums);
	*error = mie_sums_error(x, cimag(m) == 0, &sums);
	return bad;
}

int mie_lossless(int n, const double complex *a, const double complex *b)
{
	/* Squares below the normal range have lost digits; so small a wave tells nothing. */
	for (int l = 1; l <= n; l++) {
		double a2 = norm2(a[l]), b2 = norm2(b[l]);
		if (fabs(creal(a[l]) - a2) > 16 * DBL_EPSILON * a2 + DBL_MIN || fabs(creal(b[l]) - b2) > 16 * DBL_EPSILON * b2 + DBL_MIN)
			return 0;
	}
	return 1;
}

struct efficiencies mie_sums_efficiencies(double x, int lossless, const struct mie_sums *s)
{
	double sca = lossless || s->sca > s->ext ? s->ext : s->sca;    /* greater by rounding alone: Re a >= |a|^2 */
	struct efficiencies q;
	q.ext = 2 / (x * x) * s->ext;
	q.sca = 2 / (x * x) * sca;
	q.abs = q.ext - q.sca;
	q.g = 2 * s->asym / sca;
	q.back = (s->back_re * s->back_re + s->back_im * s->back_im) / (x * x);    /* S1(180 deg) = sum (2l+1) (-1)^l (b - a) / 2 */
	return q;
}

double mie_sums_error(double x, int lossless, const struct mie_sums *s)
{
	/* The largest coefficient is about (4/9) |m-1| x^3 where x is small, |m-1| x where it is large and m near 1; of all, the sum of
	 * (2l+1) |a|^2 tells: 3 |a_1|^2 or about x^2 times the largest. */
	double volume = 4.0 / 9 * x * x * x, full = (volume < 1 ? volume : 1) * (x > 1 ? x : 1);
	double sca = lossless ? s->ext : s->sca, flat = full / sqrt(sca / (x * x > 3 ? x * x : 3));
	double error = 2 * DBL_EPSILON * (10 + x + s->broad + (flat > 1 ? flat : 1));
	return s->moved > error * sca ? s->moved / sca : error;
}

void mie_sums_of(int lossless, int n, const double complex *a, const double complex *b, struct mie_sums *sums)
{
	const struct mie_lanes *lanes = mie_lanes();
	struct chunk c;
	*sums = (struct mie_sums){ 0 };
	for (int i = 0; i < 4; i++)
		c.wave[i][0] = 0;
	for (int l = 1, count; l <= n; l += count) {
		count = n + 1 - l < MIE_CHUNK ? n + 1 - l : MIE_CHUNK;
		for (int i = 1; i <= count; i++) {
			int at = l + i - 1;
			double w = 2.0 * at + 1;
			c.wave[0][i] = w * creal(a[at]);
			c.wave[1][i] = w * cimag(a[at]);
			c.wave[2][i] = w * creal(b[at]);
			c.wave[3][i] = w * cimag(b[at]);
			c.sca[i - 1] = w * (norm2(a[at]) + norm2(b[at]));
		}
		struct mie_row row = { .absorbs = !lossless, .first = l, .count = count, .weighted = 1,
			.a_re = c.wave[0] + 1, .a_im = c.wave[1] + 1, .b_re = c.wave[2] + 1, .b_im = c.wave[3] + 1, .sca = c.sca };
		lanes->sums(&row, sums);
		for (int i = 0; i < 4; i++)
			c.wave[i][0] = c.wave[i][count];
	}
}

struct efficiencies mie_efficiencies(double x, int lossless, int n, const double complex *a, const double complex *b, double *error)
{
	struct mie_sums sums;
	mie_sums_of(lossless, n, a, b, &sums);
	if (error) {
		sums.moved = mie_resonances_rough(x, n, a, b);
		*error = mie_sums_error(x, lossless, &sums);
	}
	return mie_sums_efficiencies(x, lossless, &sums);
}

/* The estimate of the error of efficiencies, on narrow resonances, where half a unit in the last place of x or m does more than
 * all other rounding, and elsewhere: against series of their own in long doubles, summed by recurrences that have nothing in
 * common with the library's but the theory. MIE_ROWS=1 writes x, m, the error and its estimate. */
#include "optics/mie/mie.h"
#include "support/tap.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

typedef long double real;

#define ORDERS 4000
#define RESONANCES 200
#define ELSEWHERE 20000
#define TIGHT 30      /* so many times the truth are estimates beside resonances, or less */

static uint64_t state = 11;

/* Uniform in [0, 1); the same everywhere. */
static double uniform(void)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

/* psi_l(z), chi_l(z) for l = 0 .. n and chi NULL where not asked for: psi downward from far beyond z, chi upward. */
static void riccati(real z, int n, real *psi, real *chi)
{
	int top = (int)fmaxl(n, z) + 60 + (int)(8 * cbrtl(z));
	real next = 0, own = 1e-4000L, at_0 = 0, at_1 = 0;
	for (int l = top; l >= 0; l--) {
		real before = (2 * l + 3) / z * own - next;      /* psi_l from psi_{l+1} = own */
		next = own;
		own = before;
		if (l <= n)
			psi[l] = own;
		if (fabsl(own) > 1e2000L) {
			own *= 1e-2000L;
			next *= 1e-2000L;
			for (int k = l; k <= n; k++)
				psi[k] *= 1e-2000L;
		}
	}
	at_0 = sinl(z);
	at_1 = sinl(z) / z - cosl(z);
	real scale = fabsl(at_0) > fabsl(at_1) ? at_0 / psi[0] : at_1 / psi[1];
	for (int l = 0; l <= n; l++)
		psi[l] *= scale;
	if (!chi)
		return;
	chi[0] = cosl(z);
	chi[1] = cosl(z) / z + sinl(z);
	for (int l = 1; l < n; l++)
		chi[l + 1] = (2 * l + 1) / z * chi[l] - chi[l - 1];
}

/* A and C of a_l (te 0) or b_l, times psi_l(m x): a_l = A / (A - iC). */
struct pair {
	real a, c;
};

static struct pair parts(int te, int l, real x, real m, const real *psi, const real *chi, const real *of_y)
{
	real y = m * x, inside = of_y[l - 1] - l / y * of_y[l], psi_slope = psi[l - 1] - l / x * psi[l], chi_slope = chi[l - 1] - l / x * chi[l];
	real left = te ? m * inside : inside, right = te ? of_y[l] : m * of_y[l];
	return (struct pair){ left * psi[l] - right * psi_slope, left * chi[l] - right * chi_slope };
}

struct sums {
	real ext, g;
};

static struct sums series(real x, real m)
{
	static real psi[ORDERS + 1], chi[ORDERS + 1], of_y[ORDERS + 1], wave[ORDERS + 2][4];
	int n = (int)fmaxl(m * x, x + 8 * cbrtl(x)) + 12;
	struct sums s = { 0, 0 };
	riccati(x, n, psi, chi);
	riccati(m * x, n, of_y, NULL);
	for (int l = 1; l <= n; l++)
		for (int te = 0; te < 2; te++) {
			struct pair p = parts(te, l, x, m, psi, chi, of_y);
			real ratio = p.c / p.a;
			wave[l][2 * te] = 1 / (1 + ratio * ratio);
			wave[l][2 * te + 1] = isinf(ratio) ? 0 : ratio / (1 + ratio * ratio);
		}
	for (int i = 0; i < 4; i++)
		wave[n + 1][i] = 0;
	for (int l = 1; l <= n; l++) {
		real *w = wave[l], *next = wave[l + 1];
		s.ext += (2 * l + 1) * (w[0] + w[2]);
		s.g += (real)(l * (l + 2)) / (l + 1) * (w[0] * next[0] + w[1] * next[1] + w[2] * next[2] + w[3] * next[3])
		       + (real)(2 * l + 1) / ((real)l * (l + 1)) * (w[0] * w[2] + w[1] * w[3]);
	}
	s.g *= 2 / s.ext;
	s.ext *= 2 / (x * x);
	return s;
}

/* C, by which resonances are found. */
static real denominator(int te, int l, real x, real m)
{
	static real psi[ORDERS + 1], chi[ORDERS + 1], of_y[ORDERS + 1];
	riccati(x, l + 1, psi, chi);
	riccati(m * x, l + 1, of_y, NULL);
	return parts(te, l, x, m, psi, chi, of_y).c;
}

/* The error of what x and m give, against the series there and with either moved by half a unit to either side, over its
 * estimate; and from coefficients. lifted: whether the estimate is twice what it is without resonances, or more. */
static double over(double x, double m, double *streamed, int *lifted)
{
	static const int move[][2] = { { 0, 0 }, { -1, 0 }, { 1, 0 }, { 0, -1 }, { 0, 1 } };
	double complex index = m;
	struct efficiencies q;
	double error, worst = 0, of_x = (nextafter(x, INFINITY) - x) / 2, of_m = (nextafter(m, INFINITY) - m) / 2;
	if (mie_many(1, &x, &index, &q, &error))
		exit(2);
	for (int k = 0; k < 5; k++) {
		struct sums s = series(x + move[k][0] * (real)of_x, m + move[k][1] * (real)of_m);
		worst = fmax(worst, fmax((double)fabsl(q.ext / s.ext - 1), (double)fabsl(q.g - s.g)));
	}
	if (getenv("MIE_ROWS"))
		fprintf(stderr, "%.17g %g %.2e %.2e\n", x, m, worst, error);
	if (streamed) {
		int n = mie_terms(x, m);
		double complex *a = malloc(2 * ((size_t)n + 1) * sizeof *a);
		double of_stream;
		if (!a || mie_coefficients(x, m, n, a, a + n + 1))
			exit(2);
		mie_efficiencies(x, 1, n, a, a + n + 1, &of_stream);
		*streamed = worst / of_stream;
		free(a);
	}
	if (lifted)
		*lifted = error > 4 * DBL_EPSILON * (11 + x);
	return worst / error;
}

/* x of some resonance of order l between x = l/m and l, its width beside it; 0 where none is found. */
static real resonance(int te, int l, double m, real *width)
{
	int steps = 8 * l, first = (int)(steps * uniform());
	real low = l / (real)m, step = (l - low) / steps;
	for (int i = 0; i < steps; i++) {
		real from = low + (first + i) % steps * step, to = from + step, old = denominator(te, l, from, m);
		if ((old > 0) == (denominator(te, l, to, m) > 0))
			continue;
		for (int k = 0; k < 64; k++) {
			real middle = (from + to) / 2, c = denominator(te, l, middle, m);
			if ((c > 0) == (old > 0))
				from = middle;
			else
				to = middle;
		}
		static real psi[ORDERS + 1], chi[ORDERS + 1];
		riccati(from, l + 1, psi, chi);
		*width = 1 / (((real)m * m - 1) * chi[l] * chi[l]);
		return from;
	}
	return 0;
}

int main(void)
{
	static const double index[] = { 1.3333, 1.5, 2, 3 };
	double known = over(44.401004015, 1.5, NULL, NULL), most = 0, most_streamed = 0;
	int worse = 0, worse_streamed = 0, found = 0, lifted = 0, loose = 0;
	ok(known < 1, "m = 1.5, x = 44.401004015: error %.2g of its estimate", known);
	while (found < RESONANCES) {
		double m = index[found % 4], at = 20 * pow(10, uniform()), streamed;
		int te = uniform() < 0.5, l = (int)(at * (1 + (m - 1) * uniform()));
		real width, x = resonance(te, l, m, &width);
		if (!(x >= 20 && x <= 200) || width > 1e-3 || width < 1e-13)
			continue;
		double ratio = over((double)(x + (2 * uniform() - 1) * 2 * width), m, &streamed, NULL);
		most = fmax(most, ratio);
		most_streamed = fmax(most_streamed, streamed);
		worse += ratio > 1;
		worse_streamed += streamed > 1;
		found++;
	}
	ok(worse < RESONANCES / 100 && most < 10, "on %d resonances: %d errors above the estimate, at most %.2g of it", found, worse, most);
	ok(worse_streamed < RESONANCES / 100 && most_streamed < 10, "from coefficients: %d, at most %.2g of it", worse_streamed, most_streamed);
	worse = 0;
	most = 0;
	for (int i = 0; i < ELSEWHERE; i++) {
		int beside;
		double ratio = over(pow(10, 2 * uniform()), 1.1 * pow(4.5, uniform()), NULL, &beside);
		worse += ratio > 1;
		most = fmax(most, ratio);
		lifted += beside;
		loose += beside && ratio * TIGHT < 1;
	}
	ok(worse < ELSEWHERE / 100 && most < 10, "on %d spheres anywhere: %d, at most %.2g of it", ELSEWHERE, worse, most);
	ok(loose < lifted / 10, "where it is more than twice that of other rounding, on %d of them, it is %d times the error or more on %d",
	   lifted, TIGHT, loose);
	worse = 0;
	most = 0;
	for (int i = 0; i < ELSEWHERE / 10; i++) {
		double ratio = over(pow(10, 2 * uniform()), 5 * pow(6, uniform()), NULL, NULL);
		worse += ratio > 1;
		most = fmax(most, ratio);
	}
	ok(worse < ELSEWHERE / 10 / 20 && most < 10, "on %d spheres of large index: %d, at most %.2g of it", ELSEWHERE / 10, worse,
	   most);
	return done_testing();
}

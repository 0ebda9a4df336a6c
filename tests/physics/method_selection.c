/* The selection of methods against Lorenz-Mie theory: estimates of error are honest, auto keeps its tolerance, limits, sound numbers.
 * method_selection --honest N: the shares of N random spheres a method and a tolerance where the truth is worse, as a table.
 * method_selection --costs: what methods cost in terms of Lorenz-Mie series, as a table: the origin of the costs of optics/select/method.c. */
#include "optics/select/method_selection.h"
#include "optics/closed_form/rayleigh.h"
#include "support/tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define SIZES 50        /* of one index, for auto */

/* The same on every machine. */
static double uniform(void)
{
	static unsigned long long s = 20221125;
	s = s * 6364136223846793005u + 1442695040888963407u;
	return (double)(s >> 11) / 9007199254740992.0;
}

static double between(double a, double b) { return a * pow(b / a, uniform()); }

/* Real above 1 and below, absorbing, and metals or foci of the central ray (n = 3, 5, 7), in equal shares. */
static double complex index_of(int kind)
{
	double n = kind % 4 == 1 ? 0.4 + 0.59 * uniform() : 1.01 + 1.99 * uniform(), other = uniform();
	if (kind % 4 == 3)
		return other < 0.2 ? 3 + 2 * (int)(3 * uniform()) : CMPLX(between(0.05, 30), between(0.05, 30));
	if (kind % 4 < 2)
		return n;
	return CMPLX(other < 0.3 ? 0.4 + 0.59 * uniform() : n, between(1e-6, 1));
}

static double truth(const struct efficiencies *q, const struct efficiencies *mie)
{
	return fmax(fmax(fabs(q->ext / mie->ext - 1), fabs(q->sca / mie->sca - 1)), fabs(q->g - mie->g));
}

struct shares {
	int n, worse;
	double most, beyond;     /* largest true error over the estimate; where that was */
	double complex m;
};

static void count(struct shares *s, double error, double estimate, double x, double complex m)
{
	s->n++;
	s->worse += error > estimate;
	if (error / estimate > s->most) {
		s->most = error / estimate;
		s->beyond = x;
		s->m = m;
	}
}

/* n spheres, `sizes' of each index; how many indices and sizes a method is asked about. tolerance: 0 where estimates are held against the
 * truth, else the tolerance is. */
static struct shares honest(enum method method, double tolerance, int n, int sizes, double most)
{
	struct shares s = { 0 };
	double *x = malloc((size_t)sizes * 3 * sizeof *x), *error = x + sizes, *ignored = error + sizes;
	double complex *m = malloc((size_t)sizes * sizeof *m);
	struct sphere *sphere = malloc((size_t)sizes * sizeof *sphere);
	struct efficiencies *q = malloc((size_t)sizes * 2 * sizeof *q), *mie = q + sizes;
	enum method *used = malloc((size_t)sizes * sizeof *used);
	for (int done = 0, kind = 0; done < n; done += sizes, kind++) {
		struct method_selection *l = method_selection_new(method, tolerance);
		double complex index = index_of(kind);
		for (int i = 0; i < sizes; i++) {
			x[i] = between(0.01, most);
			m[i] = index;
			sphere[i] = (struct sphere){ x[i], m[i] };
		}
		if (!l || method_selection_many(l, sizes, sphere, q, error, used) || mie_many(sizes, x, m, mie, ignored))
			exit(2);
		for (int i = 0; i < sizes; i++)
			if (tolerance > 0)
				count(&s, truth(&q[i], &mie[i]), tolerance, x[i], m[i]);
			else if (error[i] < 1)       /* where a method says it fails, there is nothing to hold it to */
				count(&s, truth(&q[i], &mie[i]), error[i], x[i], m[i]);
		method_selection_free(l);
	}
	free(x);
	free(m);
	free(sphere);
	free(q);
	free(used);
	return s;
}

static int table(int n)
{
	printf("# method\ttolerance\tspheres\tshare worse\tworst over the estimate\n");
	for (int k = METHOD_RAYLEIGH; k <= METHOD_EVANS_FOURNIER; k++) {
		struct shares s = honest(k, 0, k == METHOD_GOA ? n / 20 : n, 1, 1e5);
		printf("%s\t-\t%d\t%.2g\t%.2g\n", method_table[k].name, s.n, (double)s.worse / s.n, s.most);
	}
	for (int k = 1; k <= 6; k++) {
		struct shares s = honest(METHOD_AUTO, pow(10, -k), n, SIZES, 1e5);
		printf("auto\t1e-%d\t%d\t%.2g\t%.2g\n", k, s.n, (double)s.worse / s.n, s.most);
	}
	return 0;
}

static double now(void)
{
	struct timespec t;
	clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The least of seven runs; x from 100 to 1e4, evenly in the logarithm. */
static int costs(void)
{
	enum { N = 2048 };
	static const double complex of[] = { 1.33, 1.5, 1.33 + 0.001 * I, 1.5 + 0.1 * I, 0.75 };
	static double x[N], error[N], estimate;
	static double complex m[N];
	static struct efficiencies q[N];
	printf("# m\tns a term\tmethod\tterms a sphere\tterms an octave of an index\n");
	for (unsigned k = 0; k < sizeof of / sizeof *of; k++)
		for (int method = METHOD_RAYLEIGH; method <= METHOD_EVANS_FOURNIER; method++) {
			const struct method_row *row = &method_table[method];
			double term = INFINITY, sphere = INFINITY, index = INFINITY, terms = 0;
			for (int i = 0; i < N; i++) {
				x[i] = 100 * pow(100, (double)i / N);
				m[i] = of[k];
				terms += x[i];
			}
			for (int run = 0; run < 7 && row->serves != METHOD_NEVER; run++) {
				double begun = now(), found, prepared;
				if (mie_many(N, x, m, q, error))
					exit(2);
				found = now();
				void *own = row->prepare ? row->prepare(of[k]) : NULL;
				for (int i = 0; i < N && own; i++)
					row->extend(own, x[i]);
				prepared = now();
				for (int i = 0; i < N; i++)
					q[i] = row->efficiencies(&(struct sphere){ row->serves == METHOD_SMALL ? x[i] / 1e5 : x[i], of[k] },
					                         own, 0, &estimate);
				sphere = fmin(sphere, (now() - prepared) / N);
				index = fmin(index, (prepared - found) / log2(100));
				term = fmin(term, (found - begun) / terms);
				if (own)
					row->forget(own);
			}
			if (row->serves != METHOD_NEVER)
				printf("%g+%gi\t%.2f\t%s\t%.0f\t%.0f\n", creal(of[k]), cimag(of[k]), term * 1e9, row->name,
				       sphere / term, row->prepare ? index / term : 0);
		}
	return 0;
}

/* As x falls, Q_sca ~ x^4, and so Q_ext where nothing absorbs. */
static void small(void)
{
	static const enum method methods[] = { METHOD_AUTO, METHOD_RAYLEIGH, METHOD_EVANS_FOURNIER };
	static const struct sphere s[] = { { 1e-3, 1.33 }, { 1e-3, 0.75 }, { 1e-3, 1.5 + 0.1 * I }, { 2e-3, 1.33 } };
	for (int k = 0; k < 3; k++) {
		struct method_selection *l = method_selection_new(methods[k], 1e-3);
		struct efficiencies q[4];
		double error[4], worst = 0;
		enum method used[4];
		if (!l || method_selection_many(l, 4, s, q, error, used))
			exit(2);
		for (int i = 0; i < 3; i++) {
			double complex m2 = s[i].m * s[i].m, dipole = (m2 - 1) / (m2 + 2);
			worst = fmax(worst, fabs(q[i].sca / (8.0 / 3 * pow(s[i].x, 4) * creal(dipole * conj(dipole))) - 1));
		}
		worst = fmax(worst, fabs(q[3].ext / q[0].ext / 16 - 1));
		ok(worst < 1e-3, "%s: x -> 0, Q_sca = (8/3) x^4 |m^2 - 1|^2/|m^2 + 2|^2 (worst %.1e)", method_table[methods[k]].name, worst);
		method_selection_free(l);
	}
}

/* As x grows, Q_ext -> 2 + 1.9924 x^(-2/3), and glories where nothing absorbs. */
static void large(void)
{
	static const enum method methods[] = { METHOD_CAM, METHOD_EVANS_FOURNIER };
	static const struct sphere s[] = { { 1e6, 1.33 }, { 1e6, 0.75 }, { 1e6, 1.5 + 0.1 * I } };
	for (int k = 0; k < 2; k++) {
		struct method_selection *l = method_selection_new(methods[k], 0);
		struct efficiencies q[3];
		double error[3], worst = 0, edge;
		enum method used[3];
		if (!l || method_selection_many(l, 3, s, q, error, used))
			exit(2);
		for (int i = 0; i < 3; i++)
			worst = fmax(worst, fabs(q[i].ext - 2));
		edge = fabs((q[2].ext - 2) / (1.9924 * pow(s[2].x, -2.0 / 3)) - 1);     /* an absorbing sphere has nothing else */
		ok(worst < 1e-3 && edge < (methods[k] == METHOD_CAM ? 0.01 : 1), 
		   "%s: x = 1e6, Q_ext -> 2 (within %.1e), as the edge's share (to %.1e of it)",
		   method_table[methods[k]].name, worst, edge);
		method_selection_free(l);
	}
	/* without absorption and with next to none the same */
	struct method_selection *l = method_selection_new(METHOD_CAM, 0);
	struct efficiencies q[2];
	double error[2];
	enum method used[2];
	if (!l || method_selection_many(l, 2, (struct sphere[]){ { 1e3, 1.4 }, { 1e3, CMPLX(1.4, 1e-12) } }, q, error, used))
		exit(2);
	ok(fabs(q[0].ext - q[1].ext) + fabs(q[0].sca - q[1].sca) + fabs(q[0].g - q[1].g) < 1e-6, "cam: k -> 0 is k = 0");
	method_selection_free(l);
}

/* Nothing but sound numbers wherever a method is asked: x to 1e6, or 1e3 where that takes longer, |m| to 100. */
static void sound_numbers(enum method method, int n)
{
	int bad = 0;
	struct method_selection *l = method_selection_new(method, 1e-2);
	double *error = malloc((size_t)n * sizeof *error);
	struct sphere *s = malloc((size_t)n * sizeof *s);
	struct efficiencies *q = malloc((size_t)n * sizeof *q);
	enum method *used = malloc((size_t)n * sizeof *used);
	for (int i = 0; i < n; i++) {
		int odd = i / 64 % 8;        /* 64 sizes of one index */
		s[i].x = between(1e-8, method == METHOD_CAM ? 1e3 : 1e6);
		s[i].m = i % 64 ? s[i - 1].m : odd == 0 ? between(0.01, 100) : odd == 1 ? CMPLX(between(0.01, 100), between(1e-6, 100)) :
			odd == 2 ? 1 + between(1e-8, 1e-2) : odd == 3 ? 1 - between(1e-8, 1e-2) :
			odd == 4 ? 3 + 2 * (int)(4 * uniform()) : index_of(i / 64);
	}
	if (!l || method_selection_many(l, n, s, q, error, used))
		exit(2);
	for (int i = 0; i < n; i++) {
		int sound = isfinite(q[i].ext) && isfinite(q[i].sca) && isfinite(q[i].abs) && isfinite(q[i].g) && isfinite(q[i].back) &&
			isfinite(error[i]) && error[i] > 0 && q[i].ext >= 0 && q[i].sca >= 0 && q[i].abs >= 0 &&
			fabs(q[i].g) <= 1 + 1e-12 &&
			q[i].back >= 0 && (cimag(s[i].m) > 0 || (q[i].sca == q[i].ext && q[i].abs == 0));
		if (!sound && !bad++)
			printf("# x = %.17g, m = %.17g + %.17g i: %g %g %g %g %g +- %g\n", s[i].x, creal(s[i].m), cimag(s[i].m),
			       q[i].ext, q[i].sca, q[i].abs, q[i].g, q[i].back, error[i]);
	}
	ok(bad == 0, "%s: %d spheres of any size and index: finite, ext, sca, abs, back >= 0, |g| <= 1, sca = ext where m is real (%d not)",
	   method_table[method].name, n, bad);
	method_selection_free(l);
	free(error);
	free(s);
	free(q);
	free(used);
}

/* Next to no absorption, which is lost in the difference of extinction and scattering. */
static void little_absorption(void)
{
	static const double complex index[] = { 1.333 + 1.96e-9 * I, 1.5 + 1e-6 * I, 0.75 + 1e-4 * I, 3 + 1e-3 * I, 2 + 1.0 * I };
	double most = 0;
	for (int k = 0; k < 5; k++)
		for (int i = 0; i < 40; i++) {
			struct sphere s = { 0.001 * pow(400, i / 39.0), index[k] };
			struct efficiencies q = method_table[METHOD_RAYLEIGH].efficiencies(&s, NULL, 1, &(double){ 0 }), mie;
			double error;
			if (mie_many(1, &s.x, &s.m, &mie, &error))
				exit(2);
			/* of the series' own absorption: below x of 0.05 Lorenz-Mie theory's, a difference, has rounding of its own */
			double own = 4 * error * mie.ext / mie.abs;
			most = fmax(most, (fabs(q.abs / mie.abs - 1) - own) / rayleigh_error(s.x, s.m));
		}
	ok(most < 1, "rayleigh: absorption within the estimate however little (%.2g of it)", most);
}

/* What cam.h says of absorption, with the mean of resonances. */
static void absorption_of_large(void)
{
	enum { N = 4000 };
	static const double complex index[] = { 1.33 + 1e-6 * I, 1.5 + 1e-6 * I, 1.33 + 1e-4 * I };
	static double x[N], error[N];
	static double complex m[N];
	static struct efficiencies q[N];
	for (int k = 0; k < 3; k++) {
		void *own = method_table[METHOD_CAM].prepare(index[k]);
		double all = 0, true_all = 0, share = 2 * pow(2.0 / 1000, 2.0 / 3);
		int far = 0;
		for (int i = 0; own && i < N; i++) {
			x[i] = 1000 + 20.0 * i / N;
			m[i] = index[k];
			method_table[METHOD_CAM].extend(own, x[i]);
		}
		if (!own || mie_many(N, x, m, q, error))
			exit(2);
		for (int i = 0; i < N; i++) {
			double abs = method_table[METHOD_CAM].efficiencies(&(struct sphere){ x[i], m[i] }, own, 0, &(double){ 0 }).abs;
			all += abs;
			true_all += q[i].abs;
			far += fabs(abs / q[i].abs - 1) > share;
		}
		ok(fabs(all / true_all - 1) < 2e-3 && far < N / 10,
		   "cam, m = %g + %.0ei: absorption over sizes to %.1e, of %d further than %.1e: %d", creal(index[k]), cimag(index[k]),
		   fabs(all / true_all - 1), N, share, far);
		method_table[METHOD_CAM].forget(own);
	}
}

int main(int argc, char **argv)
{
	if (argc == 3 && !strcmp(argv[1], "--honest"))
		return table(atoi(argv[2]));
	if (argc == 2 && !strcmp(argv[1], "--costs"))
		return costs();
	for (int k = METHOD_RAYLEIGH; k <= METHOD_EVANS_FOURNIER; k++) {
		struct shares s = honest(k, 0, k == METHOD_GOA ? 40 : 4000, k == METHOD_GOA ? 4 : 20, 1e4);
		ok(s.n > 20 && s.worse <= s.n / 100 && s.most < 10,
		   "%s: the estimate holds (of %d spheres exceeded by %d, at most %.2g times, at x = %.4g, m = %.4g + %.2gi)", method_table[k].name,
		   s.n, s.worse, s.most, s.beyond, creal(s.m), cimag(s.m));
	}
	sound_numbers(METHOD_RAYLEIGH, 100000);
	sound_numbers(METHOD_EVANS_FOURNIER, 100000);
	sound_numbers(METHOD_CAM, 100000);
	for (int k = 1; k <= 6; k++) {
		struct shares s = honest(METHOD_AUTO, pow(10, -k), 60 * SIZES, SIZES, 1e4);
		ok(s.worse <= s.n / 100 && s.most < 10, 
		   "auto, 1e-%d: kept (of %d spheres missed by %d, at most %.2g times, at x = %.4g, m = %.4g + %.2gi)",
		   k, s.n, s.worse, s.most, s.beyond, creal(s.m), cimag(s.m));
	}
	little_absorption();
	absorption_of_large();
	small();
	large();
	return done_testing();
}

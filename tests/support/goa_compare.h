/* Phase functions and efficiencies of GOA and GOA+ held against Lorenz-Mie theory. */
#ifndef SUPPORT_GOA_COMPARE_H
#define SUPPORT_GOA_COMPARE_H

#include "optics/numerics/gauss.h"
#include "optics/goa/goa.h"
#include "optics/goa/goa_plus.h"
#include "optics/mie/mie.h"

#include <math.h>
#include <stdlib.h>

/* Gauss panels 2/x wide, the first ones at both ends in four: 12.6 x nodes and more. */
static inline int compare_grid(double x, double **theta, double **weight)
{
	int panels = (int)ceil(M_PI * x / 2) + 40, fine = 16, n = 8 * (panels + 6 * fine), k = 0;
	*theta = malloc((size_t)n * sizeof **theta);
	*weight = malloc((size_t)n * sizeof **weight);
	for (int i = 0; i < panels; i++) {
		int parts = i < fine || i >= panels - fine ? 4 : 1;
		for (int j = 0; j < 8 * parts; j++) {
			double half = M_PI / panels / parts / 2, lo = M_PI * i / panels + 2 * half * (j / 8);
			int g = j % 8;
			double t = lo + half * (1 + gauss_node[g]);
			(*theta)[k] = t * (180 / M_PI);
			(*weight)[k++] = half * gauss_weight[g] * 2 * M_PI * sin(t);
		}
	}
	return k;
}

static inline double power(double complex a, double complex b)
{
	return (creal(a * conj(a)) + creal(b * conj(b))) / 2;
}

struct compared {
	double l1, integral, ext, abs;     /* integral of p; relative errors of efficiencies */
	double decades;                    /* the largest |log10 p/p(Mie)| where p is above 1e-4 of its mean about */
	double at;                         /* degrees */
};

/* Mie's S at theta. */
static inline struct efficiencies mie(double x, double complex m, int n, const double *theta, double complex *s1, double complex *s2)
{
	int terms = mie_terms(x, m);
	double complex *a = malloc(((size_t)terms + 1) * sizeof *a), *b = malloc(((size_t)terms + 1) * sizeof *b);
	mie_coefficients(x, m, terms, a, b);
	mie_amplitudes(terms, a, b, n, theta, s1, s2);
	struct efficiencies q = mie_efficiencies(x, cimag(m) == 0, terms, a, b, NULL);
	free(a);
	free(b);
	return q;
}

/* order < 0: GOA+. */
static inline struct compared compare(double x, double complex m, int order)
{
	double *theta, *weight;
	int n = compare_grid(x, &theta, &weight);
	size_t size = (size_t)n * sizeof(double complex);
	double complex *s1 = malloc(size), *s2 = malloc(size), *g1 = malloc(size), *g2 = malloc(size);
	double *p = malloc((size_t)n * sizeof *p), *sum = malloc(((size_t)n + 1) * sizeof *sum);
	struct efficiencies q = mie(x, m, n, theta, s1, s2), approx = { 0 };
	struct compared c = { 0 };
	double norm;
	if (order < 0) {
		struct goa_plus *g = goa_plus_new(m);
		goa_plus_aim(g, n, theta);
		goa_plus_at(g, x, g1, g2, &approx);
		goa_plus_free(g);
		norm = M_PI * x * x * approx.sca;
	} else {
		goa_amplitudes(x, m, order, n, theta, g1, g2);
		norm = goa_norm(x, m, order);
	}
	sum[0] = 0;
	for (int k = 0; k < n; k++) {
		p[k] = power(s1[k], s2[k]) / (M_PI * x * x * q.sca);
		double got = power(g1[k], g2[k]) / norm;
		c.l1 += weight[k] * fabs(got - p[k]) / 2;
		c.integral += weight[k] * got;
		sum[k + 1] = sum[k] + p[k];
	}
	/* a mean over nodes, not over the angle: they are dense nowhere but near the axes */
	for (int k = 0, lo = 0, hi = 0; k < n; k++) {
		double width = 20 / x * (180 / M_PI);
		while (theta[lo] < theta[k] - width)
			lo++;
		while (hi < n && theta[hi] <= theta[k] + width)
			hi++;
		double mean = (sum[hi] - sum[lo]) / (hi - lo), got = power(g1[k], g2[k]) / norm;
		double off = fabs(log10(got / p[k]));
		if (p[k] > 1e-4 * mean && !(off <= c.decades)) {
			c.decades = off;
			c.at = theta[k];
		}
	}
	c.ext = approx.ext / q.ext - 1;
	c.abs = q.abs > 0 ? approx.abs / q.abs - 1 : 0;
	free(theta), free(weight), free(s1), free(s2), free(g1), free(g2), free(p), free(sum);
	return c;
}

#endif

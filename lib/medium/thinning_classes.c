#include "medium/thinning.h"

#include "base/ascending.h"
#include "base/die.h"
#include "format/limits.h"
#include "optics/phase/phase.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Neighbouring classes that become one. */
struct group {
	int first, last;                /* classes, the last one in it */
	double error[MEDIUM_WAVES];     /* of its classes, each by its share of all particles */
};

/* Of all particles at each wavelength. */
struct sums {
	double sca[MEDIUM_WAVES], ext[MEDIUM_WAVES];
};

static double weight(const struct medium *m, const double *c, int k, int w)
{
	return m->count[k] * c[(size_t)k * (size_t)m->n_waves + (size_t)w];
}

/* The nodes of classes [first, last] together: returns how many; theta from malloc. */
static int nodes_of(const struct medium *m, int first, int last, double **theta)
{
	size_t all = 0, used = 0;
	int n = 0;
	for (int k = first; k <= last; k++)
		all += (size_t)m->node[2 * k + 1];
	double *t = xalloc(all, sizeof *t);
	for (int k = first; k <= last; k++)
		for (int i = 0; i < m->node[2 * k + 1]; i++)
			t[used++] = m->theta[m->node[2 * k] + i];
	qsort(t, all, sizeof *t, ascending);
	for (size_t i = 0; i < all; i++)
		if (!n || t[i] > t[n - 1])
			t[n++] = t[i];
	*theta = t;
	return n;
}

/* A class's phase function at nodes, its own among them. */
static void on_nodes(const struct medium *m, int class, int w, int n, const double *theta, double *out)
{
	const float *own = m->theta + m->node[2 * class], *p = m->p + (size_t)m->node[2 * class] * (size_t)m->n_waves;
	int last = m->node[2 * class + 1] - 1;
	for (int i = 0, at = 0; i < n; i++) {
		while (at + 1 < last && own[at + 1] <= theta[i])
			at++;
		double share = fmin(1, fmax(0, (theta[i] - own[at]) / ((double)own[at + 1] - own[at])));
		const float *q = p + (size_t)at * (size_t)m->n_waves + w;
		out[i] = q[0] + share * ((double)q[m->n_waves] - q[0]);
	}
}

/* The mean phase function of classes at a wavelength, weighted by what they scatter: p[n]; q[n] is room. */
static void mean_phase(const struct medium *m, int first, int last, int w, int n, const double *theta, double *p, double *q)
{
	double all = 0;
	memset(p, 0, (size_t)n * sizeof *p);
	for (int k = first; k <= last; k++)
		all += weight(m, m->c_sca, k, w);
	for (int k = first; k <= last; k++) {
		double share = all > 0 ? weight(m, m->c_sca, k, w) / all : 1. / (last - first + 1);
		on_nodes(m, k, w, n, theta, q);
		for (int i = 0; i < n; i++)
			p[i] += share * q[i];
	}
}

/* What it does to the particles of a group's classes that they are one. */
static void group_error(const struct medium *m, const struct sums *sums, struct group *g)
{
	double *theta;
	int n = nodes_of(m, g->first, g->last, &theta);
	double *p = xalloc((size_t)n, sizeof *p), *q = xalloc((size_t)n, sizeof *q);
	for (int w = 0; w < m->n_waves; w++) {
		double moved = 0, changed = 0, ext = 0, count = 0;
		mean_phase(m, g->first, g->last, w, n, theta, p, q);
		for (int k = g->first; k <= g->last; k++) {
			ext += weight(m, m->c_ext, k, w);
			count += m->count[k];
		}
		for (int k = g->first; k <= g->last; k++) {
			double own = weight(m, m->c_ext, k, w), sum = 0;
			on_nodes(m, k, w, n, theta, q);
			for (int i = 0; i + 1 < n; i++)
				sum += phase_half_l1(theta[i], theta[i + 1] - theta[i], q[i] - p[i], q[i + 1] - p[i + 1]);
			moved += sums->sca[w] > 0 ? weight(m, m->c_sca, k, w) / sums->sca[w] * sum : 0;
			changed += own > 0 ? own / sums->ext[w] * fabs(ext / count * m->count[k] / own - 1) : 0;
		}
		g->error[w] = fmax(moved, changed);
	}
	free(theta);
	free(p);
	free(q);
}

/* The cross sections of a group: means of a particle. */
static void mean_optics(const struct medium *m, const struct group *g, struct medium *to, int j)
{
	const size_t waves = (size_t)m->n_waves;
	double count = 0, radius = 0;
	for (int k = g->first; k <= g->last; k++) {
		count += m->count[k];
		radius += m->count[k] * m->radius[k];
	}
	to->count[j] = count;
	to->radius[j] = count > 0 ? radius / count : m->radius[g->first];    /* none of them: any will do */
	for (size_t w = 0; w < waves; w++) {
		double ext = 0, sca = 0;
		for (int k = g->first; k <= g->last; k++) {
			ext += weight(m, m->c_ext, k, (int)w);
			sca += weight(m, m->c_sca, k, (int)w);
		}
		size_t at = (size_t)j * waves + w, from = (size_t)g->first * waves + w;
		to->c_ext[at] = count > 0 ? ext / count : m->c_ext[from];
		to->c_sca[at] = count > 0 ? fmin(sca / count, to->c_ext[at]) : m->c_sca[from];
	}
}

/* Room for the nodes of class j behind those that are there. */
static void room_for(struct medium *to, int j, int n, size_t waves)
{
	to->node[2 * j] = (int32_t)to->n_nodes;
	to->node[2 * j + 1] = n;
	to->theta = xgrow(to->theta, to->n_nodes + (size_t)n, sizeof *to->theta);
	to->p = xgrow(to->p, (to->n_nodes + (size_t)n) * waves, sizeof *to->p);
}

/* The phase function of a group. */
static void append_mean(const struct medium *m, const struct group *g, struct medium *to, int j)
{
	const size_t waves = (size_t)m->n_waves;
	double *theta;
	int n = nodes_of(m, g->first, g->last, &theta);
	double *p = xalloc((size_t)n, sizeof *p), *q = xalloc((size_t)n, sizeof *q);
	room_for(to, j, n, waves);
	for (int i = 0; i < n; i++)
		to->theta[to->n_nodes + (size_t)i] = (float)theta[i];
	for (size_t w = 0; w < waves; w++) {
		mean_phase(m, g->first, g->last, (int)w, n, theta, p, q);
		for (int i = 0; i < n; i++)
			to->p[(to->n_nodes + (size_t)i) * waves + w] = (float)p[i];
	}
	to->n_nodes += (size_t)n;
	free(theta);
	free(p);
	free(q);
}

/* The mixture of all, which stays what it is. */
static void append_mixture(const struct medium *m, struct medium *to, int n)
{
	const size_t waves = (size_t)m->n_waves, from = (size_t)m->node[2 * m->n_classes], nodes = (size_t)m->node[2 * m->n_classes + 1];
	room_for(to, n, (int)nodes, waves);
	memcpy(to->theta + to->n_nodes, m->theta + from, nodes * sizeof *to->theta);
	memcpy(to->p + to->n_nodes * waves, m->p + from * waves, nodes * waves * sizeof *to->p);
	to->n_nodes += nodes;
}

/* Densities of classes become those of groups. All have the same integral: means by number. */
static void merge_densities(struct medium *m, const struct group *g, int n)
{
	const size_t voxels = m->n_density / (size_t)m->n_classes;
	for (int j = 0; j < n; j++) {
		double count = 0;
		for (int k = g[j].first; k <= g[j].last; k++)
			count += m->count[k];
		for (size_t i = 0; i < voxels; i++) {
			double all = 0;
			for (int k = g[j].first; k <= g[j].last; k++)
				all += (count > 0 ? m->count[k] / count : k == g[j].first) * m->density[(size_t)k * voxels + i];
			m->density[(size_t)j * voxels + i] = (float)all;    /* behind what is still read */
		}
	}
	m->n_density = (size_t)n * voxels;
}

static void merge_particles(struct medium *m, const struct group *g, int n)
{
	int32_t *becomes = xalloc((size_t)m->n_classes, sizeof *becomes);
	for (int j = 0; j < n; j++)
		for (int k = g[j].first; k <= g[j].last; k++)
			becomes[k] = j;
	for (size_t i = 0; i < m->n_particles; i++) {
		int32_t class;
		memcpy(&class, m->particle + 4 * i + 3, sizeof class);
		memcpy(m->particle + 4 * i + 3, &becomes[class], sizeof class);
	}
	free(becomes);
}

/* The classes of m become those of the groups. */
static void regroup(struct medium *m, const struct group *g, int n)
{
	const size_t waves = (size_t)m->n_waves;
	struct medium to = { .radius = xalloc((size_t)n, sizeof *to.radius), .count = xalloc((size_t)n, sizeof *to.count),
		.c_ext = xalloc((size_t)n * waves, sizeof *to.c_ext), .c_sca = xalloc((size_t)n * waves, sizeof *to.c_sca),
		.node = xalloc(2 * ((size_t)n + 1), sizeof *to.node) };
	for (int j = 0; j < n; j++) {
		mean_optics(m, &g[j], &to, j);
		if (n > 1)
			append_mean(m, &g[j], &to, j);
	}
	append_mixture(m, &to, n);
	if (n == 1)                      /* the only class is the mixture */
		memcpy(to.node, to.node + 2, 2 * sizeof *to.node);
	merge_particles(m, g, n);
	if (medium_by_class(m))
		merge_densities(m, g, n);
	void *const before[] = { m->radius, m->count, m->c_ext, m->c_sca, m->node, m->theta, m->p };
	for (size_t i = 0; i < sizeof before / sizeof *before; i++)
		free(before[i]);
	m->radius = to.radius;
	m->count = to.count;
	m->c_ext = to.c_ext;
	m->c_sca = to.c_sca;
	m->node = to.node;
	m->theta = to.theta;
	m->p = to.p;
	m->n_nodes = to.n_nodes;
	m->n_classes = n;
}

static double worst(const struct medium *m, const double *error)
{
	double most = 0;
	for (int w = 0; w < m->n_waves; w++)
		most = fmax(most, error[w]);
	return most;
}

/* Which two neighbouring groups cost least as one, and what the worst wavelength then has in all. */
static int cheapest(const struct medium *m, const struct group *g, const struct group *pair, int n, const double *total, double *least)
{
	int best = -1;
	*least = INFINITY;
	for (int j = 0; j + 1 < n; j++) {
		double after[MEDIUM_WAVES];
		for (int w = 0; w < m->n_waves; w++)
			after[w] = total[w] + pair[j].error[w] - g[j].error[w] - g[j + 1].error[w];
		if (worst(m, after) < *least) {
			*least = worst(m, after);
			best = j;
		}
	}
	return best;
}

void thinning_classes(struct medium *m, double tolerance, struct thinned *t)
{
	int n = m->n_classes;
	double total[MEDIUM_WAVES] = { 0 }, least;
	t->classes = n;
	t->classes_error = 0;
	if (n == 1)
		return;
	struct group *g = xalloc((size_t)n, sizeof *g), *pair = xalloc((size_t)n, sizeof *pair);    /* pair[j]: groups j and j + 1 as one */
	for (int j = 0; j < n; j++)
		g[j].first = g[j].last = j;
	if (m->kind == MEDIUM_DENSITY && !medium_by_class(m)) {
		g[0].last = n - 1;
		n = 1;
	}
	struct sums sums = { { 0 }, { 0 } };
	for (int w = 0; w < m->n_waves; w++)
		for (int k = 0; k < m->n_classes; k++) {
			sums.sca[w] += weight(m, m->c_sca, k, w);
			sums.ext[w] += weight(m, m->c_ext, k, w);
		}
	for (int j = 0; j + 1 < n; j++) {
		pair[j] = (struct group){ .first = j, .last = j + 1 };
		group_error(m, &sums, &pair[j]);
	}
	for (int best; n > 1 && (best = cheapest(m, g, pair, n, total, &least), least <= tolerance);) {
		for (int w = 0; w < m->n_waves; w++)
			total[w] += pair[best].error[w] - g[best].error[w] - g[best + 1].error[w];
		g[best] = pair[best];
		memmove(&g[best + 1], &g[best + 2], (size_t)(n - best - 2) * sizeof *g);
		memmove(&pair[best], &pair[best + 1], (size_t)(n - best - 1) * sizeof *pair);
		n--;
		for (int j = best > 0 ? best - 1 : 0; j <= best && j + 1 < n; j++) {
			pair[j] = (struct group){ .first = g[j].first, .last = g[j + 1].last };
			group_error(m, &sums, &pair[j]);
		}
	}
	t->classes_error = worst(m, total);
	if (n < m->n_classes)
		regroup(m, g, n);
	free(g);
	free(pair);
}

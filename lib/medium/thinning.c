#include "medium/thinning.h"

#include "base/ascending.h"
#include "base/die.h"
#include "format/limits.h"
#include "optics/phase/phase.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* int |d| over the ring between two nodes, half of it; d is linear. *sum gets the integral itself. */
static double half_l1(double theta, double h, double d0, double d1, double *sum)
{
	double whole = phase_interval(theta, h, d0, d1), part = fabs(whole);
	if (d0 * d1 < 0) {
		double to = h * d0 / (d0 - d1);
		part = fabs(phase_interval(theta, to, d0, 0)) + fabs(phase_interval(theta + to, h - to, 0, d1));
	}
	*sum += whole;
	return part / 2;
}

/* -------------------------------------------------------------------- classes */

/* Neighbouring classes that become one. */
struct group {
	int first, last;                /* classes, the last one in it */
	double error[MEDIUM_WAVES];     /* of its classes, each by its share */
};

/* All classes on the nodes of all. */
struct common {
	const struct medium *m;
	int n;                          /* nodes of all classes */
	double *theta;
	float *p;                       /* [class][node][wave] */
	double *scattered, *extinct;    /* [class][wave] shares of all particles in these */
};

static void on_nodes(const struct medium *m, int class, int n, const double *theta, float *out)
{
	const float *own = m->theta + m->node[2 * class], *p = m->p + (size_t)m->node[2 * class] * (size_t)m->n_waves;
	int last = m->node[2 * class + 1] - 1;
	for (int i = 0, at = 0; i < n; i++) {
		while (at + 1 < last && own[at + 1] <= theta[i])
			at++;
		double share = fmin(1, fmax(0, (theta[i] - own[at]) / ((double)own[at + 1] - own[at])));
		for (int w = 0; w < m->n_waves; w++) {
			const float *q = p + (size_t)at * (size_t)m->n_waves + w;
			out[(size_t)i * (size_t)m->n_waves + (size_t)w] = (float)(q[0] + share * (q[m->n_waves] - q[0]));
		}
	}
}

static struct common common_of(const struct medium *m)
{
	const size_t waves = (size_t)m->n_waves, classes = (size_t)m->n_classes;
	struct common c = { .m = m };
	size_t all = 0, used = 0;
	for (size_t k = 0; k < classes; k++)
		all += (size_t)m->node[2 * k + 1];
	c.theta = xalloc(all, sizeof *c.theta);
	for (size_t k = 0; k < classes; k++)
		for (int i = 0; i < m->node[2 * k + 1]; i++)
			c.theta[used++] = m->theta[m->node[2 * k] + i];
	qsort(c.theta, all, sizeof *c.theta, ascending);
	for (size_t i = 0; i < all; i++)
		if (!c.n || c.theta[i] > c.theta[c.n - 1])
			c.theta[c.n++] = c.theta[i];
	c.p = xalloc(classes * (size_t)c.n * waves, sizeof *c.p);
	for (size_t k = 0; k < classes; k++)
		on_nodes(m, (int)k, c.n, c.theta, c.p + k * (size_t)c.n * waves);
	c.scattered = xalloc(classes * waves, sizeof *c.scattered);
	c.extinct = xalloc(classes * waves, sizeof *c.extinct);
	for (size_t w = 0; w < waves; w++) {
		double sca = 0, ext = 0;
		for (size_t k = 0; k < classes; k++) {
			sca += c.scattered[k * waves + w] = m->count[k] * m->c_sca[k * waves + w];
			ext += c.extinct[k * waves + w] = m->count[k] * m->c_ext[k * waves + w];
		}
		for (size_t k = 0; k < classes; k++) {
			c.scattered[k * waves + w] = sca > 0 ? c.scattered[k * waves + w] / sca : 0;
			c.extinct[k * waves + w] = ext > 0 ? c.extinct[k * waves + w] / ext : 0;
		}
	}
	return c;
}

static void common_free(struct common *c)
{
	free(c->theta);
	free(c->p);
	free(c->scattered);
	free(c->extinct);
}

/* The mean phase function of classes [first, last] at a wavelength, weighted by what they scatter: p[n]. */
static void mean_phase(const struct common *c, int first, int last, int w, double *p)
{
	const size_t waves = (size_t)c->m->n_waves;
	double all = 0;
	for (int k = first; k <= last; k++)
		all += c->scattered[(size_t)k * waves + (size_t)w];
	for (int i = 0; i < c->n; i++) {
		p[i] = 0;
		for (int k = first; k <= last; k++) {
			double share = all > 0 ? c->scattered[(size_t)k * waves + (size_t)w] / all : 1. / (last - first + 1);
			p[i] += share * c->p[((size_t)k * (size_t)c->n + (size_t)i) * waves + (size_t)w];
		}
	}
}

/* What it does to the particles of classes [first, last] that they are one. */
static void group_error(const struct common *c, struct group *g)
{
	const struct medium *m = c->m;
	const size_t waves = (size_t)m->n_waves;
	double *p = xalloc((size_t)c->n, sizeof *p);
	for (size_t w = 0; w < waves; w++) {
		double moved = 0, changed = 0, ext = 0, count = 0, none = 0;
		mean_phase(c, g->first, g->last, (int)w, p);
		for (int k = g->first; k <= g->last; k++) {
			ext += m->count[k] * m->c_ext[(size_t)k * waves + w];
			count += m->count[k];
		}
		for (size_t k = (size_t)g->first; k <= (size_t)g->last; k++) {
			const float *q = c->p + k * (size_t)c->n * waves + w;
			double sum = 0;
			for (size_t i = 0; i + 1 < (size_t)c->n; i++)
				sum += half_l1(c->theta[i], c->theta[i + 1] - c->theta[i], q[i * waves] - p[i], q[(i + 1) * waves] - p[i + 1], &none);
			moved += c->scattered[k * waves + w] * sum;
			changed += count > 0 ? c->extinct[k * waves + w] * fabs(ext / count / m->c_ext[k * waves + w] - 1) : 0;
		}
		g->error[w] = g->first == g->last ? 0 : fmax(moved, changed);
	}
	free(p);
}

/* The classes of m become those of the groups. */
static void regroup(struct medium *m, const struct common *c, const struct group *g, int n)
{
	const size_t waves = (size_t)m->n_waves, nodes = (size_t)c->n;
	double *radius = xalloc((size_t)n, sizeof *radius), *count = xalloc((size_t)n, sizeof *count);
	double *c_ext = xalloc((size_t)n * waves, sizeof *c_ext), *c_sca = xalloc((size_t)n * waves, sizeof *c_sca);
	double *mean = xalloc(nodes, sizeof *mean);
	const int mixture = m->n_classes, at_mixture = m->node[2 * mixture], n_mixture = m->node[2 * mixture + 1];
	const int keeps = n == 1;       /* the mixture is the only class then, and has its own nodes */
	size_t own = keeps ? 0 : (size_t)n * nodes;
	float *theta = xalloc(own + (size_t)n_mixture, sizeof *theta), *p = xalloc((own + (size_t)n_mixture) * waves, sizeof *p);
	int32_t *node = xalloc(2 * ((size_t)n + 1), sizeof *node), *becomes = xalloc((size_t)m->n_classes, sizeof *becomes);
	for (size_t j = 0; j < (size_t)n; j++) {
		for (int k = g[j].first; k <= g[j].last; k++) {
			double weight = m->count[k];
			count[j] += weight;
			radius[j] += weight * m->radius[k];
			for (size_t w = 0; w < waves; w++) {
				c_ext[j * waves + w] += weight * m->c_ext[(size_t)k * waves + w];
				c_sca[j * waves + w] += weight * m->c_sca[(size_t)k * waves + w];
			}
			becomes[k] = (int32_t)j;
		}
		/* none of them: any will do */
		radius[j] = count[j] > 0 ? radius[j] / count[j] : m->radius[g[j].first];
		for (size_t w = 0; w < waves; w++) {
			size_t to = j * waves + w, from = (size_t)g[j].first * waves + w;
			c_ext[to] = count[j] > 0 ? c_ext[to] / count[j] : m->c_ext[from];
			c_sca[to] = count[j] > 0 ? fmin(c_sca[to] / count[j], c_ext[to]) : m->c_sca[from];
			if (keeps)
				continue;
			mean_phase(c, g[j].first, g[j].last, (int)w, mean);
			for (size_t i = 0; i < nodes; i++)
				p[(j * nodes + i) * waves + w] = (float)mean[i];
		}
		for (size_t i = 0; i < nodes && !keeps; i++)
			theta[j * nodes + i] = (float)c->theta[i];
		node[2 * j] = (int32_t)(keeps ? 0 : j * nodes);
		node[2 * j + 1] = keeps ? n_mixture : c->n;
	}
	memcpy(theta + own, m->theta + at_mixture, (size_t)n_mixture * sizeof *theta);
	memcpy(p + own * waves, m->p + (size_t)at_mixture * waves, (size_t)n_mixture * waves * sizeof *p);
	node[2 * n] = (int32_t)own;
	node[2 * n + 1] = n_mixture;
	for (size_t i = 0; i < m->n_particles; i++) {
		int32_t class;
		memcpy(&class, m->particle + 4 * i + 3, sizeof class);
		memcpy(m->particle + 4 * i + 3, &becomes[class], sizeof class);
	}
	if (medium_by_class(m)) {       /* all have the same integral: means by number */
		const size_t voxels = m->n_density / (size_t)m->n_classes;
		for (size_t j = 0; j < (size_t)n; j++)
			for (size_t i = 0; i < voxels; i++) {
				double all = 0;
				for (int k = g[j].first; k <= g[j].last; k++)
					all += (count[j] > 0 ? m->count[k] / count[j] : k == g[j].first) * m->density[(size_t)k * voxels + i];
				m->density[j * voxels + i] = (float)all;    /* behind what is still read */
			}
		m->n_density = (size_t)n * voxels;
	}
	double **const replaced[] = { &m->radius, &m->count, &m->c_ext, &m->c_sca }, *const by[] = { radius, count, c_ext, c_sca };
	for (size_t i = 0; i < sizeof by / sizeof *by; i++) {
		free(*replaced[i]);
		*replaced[i] = by[i];
	}
	free(m->theta);
	free(m->p);
	free(m->node);
	m->theta = theta;
	m->p = p;
	m->node = node;
	m->n_nodes = own + (size_t)n_mixture;
	m->n_classes = n;
	free(mean);
	free(becomes);
}

static double worst(const struct medium *m, const double *error)
{
	double most = 0;
	for (int w = 0; w < m->n_waves; w++)
		most = fmax(most, error[w]);
	return most;
}

void thinning_classes(struct medium *m, double tolerance, struct thinned *t)
{
	int n = m->n_classes, changed = 0;
	double total[MEDIUM_WAVES] = { 0 };
	t->classes = n;
	t->classes_error = 0;
	if (n == 1)
		return;
	struct common c = common_of(m);
	struct group *g = xalloc((size_t)n, sizeof *g), *pair = xalloc((size_t)n, sizeof *pair);    /* pair[j]: groups j and j + 1 as one */
	for (int j = 0; j < n; j++)
		g[j].first = g[j].last = j;
	if (m->kind == MEDIUM_DENSITY && !medium_by_class(m)) {
		g[0].last = n - 1;
		n = changed = 1;
	}
	for (int j = 0; j + 1 < n; j++) {
		pair[j] = (struct group){ .first = j, .last = j + 1 };
		group_error(&c, &pair[j]);
	}
	while (n > 1) {
		int best = -1;
		double least = INFINITY, after[MEDIUM_WAVES];
		for (int j = 0; j + 1 < n; j++) {
			for (int w = 0; w < m->n_waves; w++)
				after[w] = total[w] + pair[j].error[w] - g[j].error[w] - g[j + 1].error[w];
			if (worst(m, after) < least) {
				least = worst(m, after);
				best = j;
			}
		}
		if (!(least <= tolerance))
			break;
		for (int w = 0; w < m->n_waves; w++)
			total[w] += pair[best].error[w] - g[best].error[w] - g[best + 1].error[w];
		g[best] = pair[best];
		memmove(&g[best + 1], &g[best + 2], (size_t)(n - best - 2) * sizeof *g);
		memmove(&pair[best], &pair[best + 1], (size_t)(n - best - 1) * sizeof *pair);
		n--;
		changed = 1;
		for (int j = best > 0 ? best - 1 : 0; j <= best && j + 1 < n; j++) {
			pair[j] = (struct group){ .first = g[j].first, .last = g[j + 1].last };
			group_error(&c, &pair[j]);
		}
	}
	t->classes_error = worst(m, total);
	if (changed)
		regroup(m, &c, g, n);
	free(g);
	free(pair);
	common_free(&c);
}

/* -------------------------------------------------------------------- nodes */

/* A phase function whose nodes are left out one by one, that first which costs least: a heap of the nodes that are left. */
struct thinner {
	int n, waves;
	const float *theta, *p;         /* [node], [node][wave] */
	int *before, *after;            /* nodes left beside each */
	double *cost;                   /* of a node: its largest share of the tolerance, of all wavelengths, if it is left out */
	int *heap, *place, left;
	double *gap, *gap_sum;          /* [node][wave] half-L1 and integral of what was left out between it and the next one */
};

/* Half-L1 and integral of p less the line from node a to node b. */
static double chord(const struct thinner *t, int a, int b, int w, double *sum)
{
	double slope = ((double)t->p[b * t->waves + w] - t->p[a * t->waves + w]) / ((double)t->theta[b] - t->theta[a]), all = 0, d = 0;
	*sum = 0;
	for (int i = a; i < b; i++) {
		double next = i + 1 == b ? 0
		    : t->p[(i + 1) * t->waves + w] - (t->p[a * t->waves + w] + slope * ((double)t->theta[i + 1] - t->theta[a]));
		all += half_l1(t->theta[i], (double)t->theta[i + 1] - t->theta[i], d, next, sum);
		d = next;
	}
	return all;
}

static void set_cost(struct thinner *t, int i)
{
	int a = t->before[i], b = t->after[i];
	double most = 0, sum;
	if ((double)t->theta[b] - t->theta[a] > MEDIUM_INTERVAL)
		most = INFINITY;
	for (int w = 0; w < t->waves && most < INFINITY; w++)
		most = fmax(most, chord(t, a, b, w, &sum) - t->gap[a * t->waves + w] - t->gap[i * t->waves + w]);
	t->cost[i] = most;
}

static void exchange(struct thinner *t, int a, int b)
{
	int x = t->heap[a];
	t->heap[a] = t->heap[b];
	t->heap[b] = x;
	t->place[t->heap[a]] = a;
	t->place[t->heap[b]] = b;
}

/* Puts what is at a place of the heap where it belongs. */
static void settle(struct thinner *t, int at)
{
	const double *cost = t->cost;
	while (at > 0 && cost[t->heap[at]] < cost[t->heap[(at - 1) / 2]]) {
		exchange(t, at, (at - 1) / 2);
		at = (at - 1) / 2;
	}
	for (int child; (child = 2 * at + 1) < t->left; at = child) {
		if (child + 1 < t->left && cost[t->heap[child + 1]] < cost[t->heap[child]])
			child++;
		if (!(cost[t->heap[child]] < cost[t->heap[at]]))
			break;
		exchange(t, at, child);
	}
}

/* Leaves nodes out of one phase function; keep[n] is set to which stay. Returns the error: to half-L1 comes half of what the integral
 * is off by, as normalising may add no more. */
static double thin_one(struct thinner *t, double tolerance, char *keep)
{
	double *total = xalloc((size_t)t->waves, sizeof *total), *sum = xalloc((size_t)t->waves, sizeof *sum), most = 0;
	t->left = 0;
	for (int i = 0; i < t->n; i++) {
		keep[i] = 1;
		t->before[i] = i - 1;
		t->after[i] = i + 1;
	}
	for (int i = 1; i + 1 < t->n; i++) {
		t->place[i] = t->left;
		t->heap[t->left++] = i;
		set_cost(t, i);
	}
	for (int k = t->left / 2; k >= 0 && t->left; k--)
		settle(t, k);
	while (t->left) {
		int i = t->heap[0], a = t->before[i], b = t->after[i];
		double after = 0;
		if (!(t->cost[i] < INFINITY))
			break;
		for (int w = 0; w < t->waves; w++) {
			double s, e = chord(t, a, b, w, &s);
			double whole = total[w] + e - t->gap[a * t->waves + w] - t->gap[i * t->waves + w];
			double off = sum[w] + s - t->gap_sum[a * t->waves + w] - t->gap_sum[i * t->waves + w];
			after = fmax(after, whole + fabs(off) / 2);
		}
		if (after > tolerance)
			break;
		for (int w = 0; w < t->waves; w++) {
			size_t at = (size_t)(a * t->waves + w), here = (size_t)(i * t->waves + w);
			double s, e = chord(t, a, b, w, &s);
			total[w] += e - t->gap[at] - t->gap[here];
			sum[w] += s - t->gap_sum[at] - t->gap_sum[here];
			t->gap[at] = e;
			t->gap_sum[at] = s;
		}
		most = after;
		keep[i] = 0;
		t->after[a] = b;
		t->before[b] = a;
		exchange(t, 0, --t->left);
		if (t->left)
			settle(t, 0);
		for (int k = 0; k < 2; k++) {
			int beside = k ? b : a;
			if (beside > 0 && beside + 1 < t->n) {
				set_cost(t, beside);
				settle(t, t->place[beside]);
			}
		}
	}
	free(total);
	free(sum);
	return most;
}

void thinning_nodes(struct medium *m, double tolerance, struct thinned *out)
{
	const size_t waves = (size_t)m->n_waves;
	size_t used = 0;
	out->nodes = m->n_nodes;
	out->nodes_error = 0;
	for (int k = 0, from = -1, to = 0; k <= m->n_classes; k++) {
		int32_t *node = m->node + 2 * k;
		if (node[0] == from) {         /* shared with the class before */
			memcpy(node, (int32_t[]){ (int32_t)to, node[-1] }, 2 * sizeof *node);
			continue;
		}
		from = node[0];
		const size_t n = (size_t)node[1];
		float *theta = m->theta + from, *p = m->p + (size_t)from * waves;
		struct thinner t = { .n = (int)n, .waves = m->n_waves, .theta = theta, .p = p, .before = xalloc(n, sizeof(int)),
			.after = xalloc(n, sizeof(int)), .cost = xalloc(n, sizeof(double)), .heap = xalloc(n, sizeof(int)),
			.place = xalloc(n, sizeof(int)), .gap = xalloc(n * waves, sizeof(double)), .gap_sum = xalloc(n * waves, sizeof(double)) };
		char *keep = xalloc(n, 1);
		out->nodes_error = fmax(out->nodes_error, thin_one(&t, tolerance, keep));
		to = (int)used;
		for (size_t i = 0; i < n; i++)
			if (keep[i]) {             /* what is written lies before what is read */
				m->theta[used] = theta[i];
				memmove(m->p + used * waves, p + i * waves, waves * sizeof *p);
				used++;
			}
		node[0] = (int32_t)to;
		node[1] = (int32_t)(used - (size_t)to);
		for (size_t w = 0; w < waves; w++) {
			float *q = m->p + (size_t)to * waves + w;
			double norm = 0;
			for (size_t i = 0; i + 1 < (size_t)node[1]; i++)
				norm += phase_interval(m->theta[(size_t)to + i], (double)m->theta[(size_t)to + i + 1] - m->theta[(size_t)to + i],
				                       q[i * waves], q[(i + 1) * waves]);
			for (size_t i = 0; i < (size_t)node[1]; i++)
				q[i * waves] = (float)(q[i * waves] / norm);
		}
		void *const scratch[] = { t.before, t.after, t.cost, t.heap, t.place, t.gap, t.gap_sum, keep };
		for (size_t i = 0; i < sizeof scratch / sizeof *scratch; i++)
			free(scratch[i]);
	}
	m->n_nodes = used;
}

#include "medium/thinning.h"

#include "base/die.h"
#include "format/limits.h"
#include "optics/phase/phase.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
		double h = (double)t->theta[i + 1] - t->theta[i], next = i + 1 == b ? 0
		    : t->p[(i + 1) * t->waves + w] - (t->p[a * t->waves + w] + slope * ((double)t->theta[i + 1] - t->theta[a]));
		all += phase_half_l1(t->theta[i], h, d, next);
		*sum += phase_interval(t->theta[i], h, d, next);
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
	const size_t waves = (size_t)t->waves;
	double *total = xalloc(waves, sizeof *total), *sum = xalloc(waves, sizeof *sum), most = 0;
	double *chords = xalloc(waves, sizeof *chords), *sums = xalloc(waves, sizeof *sums);    /* of the gap that is made */
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
			chords[w] = chord(t, a, b, w, &sums[w]);
			double whole = total[w] + chords[w] - t->gap[a * t->waves + w] - t->gap[i * t->waves + w];
			double off = sum[w] + sums[w] - t->gap_sum[a * t->waves + w] - t->gap_sum[i * t->waves + w];
			after = fmax(after, whole + fabs(off) / 2);
		}
		if (after > tolerance)
			break;
		for (int w = 0; w < t->waves; w++) {
			size_t at = (size_t)(a * t->waves + w), here = (size_t)(i * t->waves + w);
			total[w] += chords[w] - t->gap[at] - t->gap[here];
			sum[w] += sums[w] - t->gap_sum[at] - t->gap_sum[here];
			t->gap[at] = chords[w];
			t->gap_sum[at] = sums[w];
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
	free(chords);
	free(sums);
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

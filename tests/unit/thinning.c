/* A medium thinned to a tolerance: what it promises, by sums over a grid of the test's own. */
#include "base/die.h"
#include "medium/medium_check.h"
#include "medium/thinning.h"
#include "optics/phase/phase.h"
#include "support/tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CLASSES 6
#define WAVES 2
#define FINE 400000     /* midpoints over [0, pi] */

/* p of a class at an angle: forward lobes that narrow with its size, ripples whose angles are its own, and a bow. */
static double shape(int k, int w, double theta)
{
	double g = 0.7 + 0.04 * k, hg = (1 - g * g) / pow(1 + g * g - 2 * g * cos(theta), 1.5);
	double ripple = 1 + 0.3 * cos((40 + 7 * k + 3 * w) * theta), bow = exp(-pow((theta - 2.4 - 0.02 * w) / 0.03, 2));
	return (hg * ripple + 0.4 * bow) / (4 * M_PI);
}

static struct medium *make(enum medium_kind kind)
{
	const int per = 2000;
	struct medium *m = xalloc(1, sizeof *m);
	*m = (struct medium){ .kind = kind, .history = xtext("%s", ""), .half = { 1, 1, 1 }, .n_waves = WAVES, .n_classes = CLASSES };
	m->wavelength = xalloc(WAVES, sizeof(double));
	m->radius = xalloc(CLASSES, sizeof(double));
	m->count = xalloc(CLASSES, sizeof(double));
	m->c_ext = xalloc(CLASSES * WAVES, sizeof(double));
	m->c_sca = xalloc(CLASSES * WAVES, sizeof(double));
	m->node = xalloc(2 * (CLASSES + 1), sizeof(int32_t));
	m->n_nodes = (CLASSES + 1) * (size_t)per;
	m->theta = xalloc(m->n_nodes, sizeof(float));
	m->p = xalloc(m->n_nodes * WAVES, sizeof(float));
	for (int w = 0; w < WAVES; w++)
		m->wavelength[w] = 0.5 + 0.1 * w;
	for (int k = 0; k < CLASSES; k++) {
		m->radius[k] = 10 + k;
		m->count[k] = 100 * (k + 1);
		for (int w = 0; w < WAVES; w++) {
			m->c_ext[k * WAVES + w] = 1000 * pow(1.02, k) * (1 + 0.01 * w);
			m->c_sca[k * WAVES + w] = m->c_ext[k * WAVES + w] * (0.9 - 0.01 * k);
		}
	}
	for (int k = 0; k <= CLASSES; k++) {
		float *theta = m->theta + k * per, *p = m->p + k * per * WAVES;
		m->node[2 * k] = k * per;
		m->node[2 * k + 1] = per;
		for (int i = 0; i < per; i++)
			theta[i] = (float)(M_PI * i / (per - 1));
		for (int w = 0; w < WAVES; w++) {
			double norm = 0, all = 0;
			for (int j = 0; j < CLASSES && k == CLASSES; j++)
				all += m->count[j] * m->c_sca[j * WAVES + w];
			for (int i = 0; i < per; i++) {
				double v = 0;
				for (int j = 0; j < CLASSES && k == CLASSES; j++)      /* of the classes as tabulated */
					v += m->count[j] * m->c_sca[j * WAVES + w] / all * m->p[(j * per + i) * WAVES + w];
				p[i * WAVES + w] = (float)(k == CLASSES ? v : shape(k, w, theta[i]));
			}
			for (int i = 0; i + 1 < per; i++)
				norm += phase_interval(theta[i], (double)theta[i + 1] - theta[i], p[i * WAVES + w], p[(i + 1) * WAVES + w]);
			for (int i = 0; i < per; i++)
				p[i * WAVES + w] = (float)(p[i * WAVES + w] / norm);
		}
	}
	for (int a = 0; a < 3; a++)
		m->voxels[a] = 1;
	if (kind == MEDIUM_DENSITY) {
		m->density = xalloc(1, sizeof(float));
		m->density[0] = 1;
		m->n_density = 1;
		m->matter = 8;
		return m;
	}
	for (int k = 0; k < CLASSES; k++)
		m->n_particles += (size_t)m->count[k];
	m->particle = xalloc(m->n_particles, 4 * sizeof(float));
	for (size_t i = 0; i < m->n_particles; i++) {
		int32_t class = 0;
		for (size_t below = (size_t)m->count[0]; i >= below; below += (size_t)m->count[++class])
			;
		memcpy(&m->particle[4 * i + 3], &class, sizeof class);
	}
	return m;
}

static double at(const struct medium *m, int class, int w, double theta)
{
	int from = m->node[2 * class], low = 0, high = m->node[2 * class + 1] - 1;
	while (high - low > 1) {
		int mid = (low + high) / 2;
		if (m->theta[from + mid] <= theta)
			low = mid;
		else
			high = mid;
	}
	double share = (theta - m->theta[from + low]) / ((double)m->theta[from + high] - m->theta[from + low]);
	double a = m->p[(from + low) * WAVES + w], b = m->p[(from + high) * WAVES + w];
	return a + share * (b - a);
}

static double half_l1(const struct medium *a, int ka, const struct medium *b, int kb, int w)
{
	double sum = 0;
	for (int i = 0; i < FINE; i++) {
		double theta = M_PI * (i + 0.5) / FINE;
		sum += fabs(at(a, ka, w, theta) - at(b, kb, w, theta)) * sin(theta);
	}
	return M_PI * sum * M_PI / FINE;
}

static double sum_of(const struct medium *m, const double *c, int w)
{
	double sum = 0;
	for (int k = 0; k < m->n_classes; k++)
		sum += m->count[k] * c[k * WAVES + w];
	return sum;
}

static void nodes(double tolerance)
{
	struct medium *was = make(MEDIUM_PARTICLES), *m = make(MEDIUM_PARTICLES);
	struct thinned t;
	double worst = 0, longest = 0;
	thinning_nodes(m, tolerance, &t);
	for (int k = 0; k <= CLASSES; k++) {
		for (int w = 0; w < WAVES; w++)
			worst = fmax(worst, half_l1(was, k, m, k, w));
		for (int i = 1; i < m->node[2 * k + 1]; i++)
			longest = fmax(longest, m->theta[m->node[2 * k] + i] - m->theta[m->node[2 * k] + i - 1]);
	}
	ok(worst <= tolerance && worst > tolerance / 4 && worst < t.nodes_error * 1.001 && t.nodes_error <= tolerance,
	   "tolerance %g: half-L1 %.3g, told %.3g", tolerance, worst, t.nodes_error);
	ok(m->n_nodes < was->n_nodes && t.nodes == was->n_nodes && longest < 0.0175, "%zu of %zu angles, none %.4f rad apart", m->n_nodes,
	   t.nodes, longest);
	medium_free(was);
	medium_free(m);
	free(was);
	free(m);
}

static void classes(double tolerance, int most)
{
	struct medium *was = make(MEDIUM_PARTICLES), *m = make(MEDIUM_PARTICLES);
	struct thinned t;
	double moved = 0, changed = 0, sums = 0, count[CLASSES] = { 0 };
	int32_t becomes[CLASSES];
	thinning_classes(m, tolerance, &t);
	for (size_t i = 0; i < m->n_particles; i++) {
		int32_t before, after;
		memcpy(&before, &was->particle[4 * i + 3], sizeof before);
		memcpy(&after, &m->particle[4 * i + 3], sizeof after);
		becomes[before] = after;
		count[after]++;
	}
	for (int w = 0; w < WAVES; w++) {
		double ext = sum_of(was, was->c_ext, w), sca = sum_of(was, was->c_sca, w), p = 0, c = 0;
		sums = fmax(sums, fmax(fabs(sum_of(m, m->c_ext, w) / ext - 1), fabs(sum_of(m, m->c_sca, w) / sca - 1)));
		for (int k = 0; k < CLASSES; k++) {
			double was_ext = was->c_ext[k * WAVES + w];
			p += was->count[k] * was->c_sca[k * WAVES + w] / sca * half_l1(was, k, m, becomes[k], w);
			c += was->count[k] * was_ext / ext * fabs(m->c_ext[becomes[k] * WAVES + w] / was_ext - 1);
		}
		moved = fmax(moved, p);
		changed = fmax(changed, c);
	}
	int counted = 1;
	for (int k = 0; k < m->n_classes; k++)
		counted &= count[k] == m->count[k];
	ok(m->n_classes <= most && counted && sums < 1e-12, "tolerance %g: %d classes, of the right numbers, sums within %.1g", tolerance,
	   m->n_classes, sums);
	ok(fmax(moved, changed) <= tolerance && fmax(moved, changed) <= t.classes_error * 1.001,
	   "a particle's phase function is moved by %.3g, its extinction by %.3g, told %.3g", moved, changed, t.classes_error);
	double mixture = fmax(half_l1(was, CLASSES, m, m->n_classes, 0), half_l1(was, CLASSES, m, m->n_classes, 1));
	ok(mixture < 1e-6, "the mixture's by %.1g", mixture);
	medium_free(was);
	medium_free(m);
	free(was);
	free(m);
}

int main(void)
{
	nodes(1e-2);
	nodes(1e-3);
	nodes(1e-4);
	classes(1e-6, CLASSES);
	classes(0.05, CLASSES - 1);
	classes(0.1, CLASSES - 2);
	classes(1, 1);

	struct medium *was = make(MEDIUM_DENSITY), *m = make(MEDIUM_DENSITY);
	struct thinned t;
	thinning_classes(m, 1e-6, &t);
	const char *wrong = medium_check(m);
	ok(m->n_classes == 1 && t.classes_error == 0 && fabs(sum_of(m, m->c_ext, 1) / sum_of(was, was->c_ext, 1) - 1) < 1e-12
	   && half_l1(was, CLASSES, m, 0, 1) < 1e-7 && half_l1(was, CLASSES, m, 1, 0) < 1e-7, "without particles one class is left, the mixture");
	thinning_nodes(m, 1e-3, &t);
	wrong = wrong ? wrong : medium_check(m);
	ok(!wrong && m->node[0] == m->node[2] && m->node[1] == m->node[3], "which is kept once (%s)", wrong ? wrong : "a good medium");
	medium_free(was);
	medium_free(m);
	free(was);
	free(m);
	return done_testing();
}

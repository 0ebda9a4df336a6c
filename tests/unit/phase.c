/* Tabulated phase functions: integrals, and directions drawn exactly by them. */
#include "optics/phase/phase.h"
#include "render/phase_sampler.h"
#include "render/kern/phase.h"
#include "render/kern/random.h"
#include "support/tap.h"

#include <math.h>
#include <stdlib.h>

#define NODES 400

/* Nodes crowded at 0 and 180 degrees, intervals below 1 degree; p rough on purpose: a peak of 1e4, a zero, a jump. */
static void table(double *theta, double *p)
{
	for (int i = 0; i < NODES; i++) {
		double u = (double)i / (NODES - 1);
		theta[i] = M_PI * (u - 0.9 * sin(2 * M_PI * u) / (2 * M_PI));
		p[i] = 1e4 * exp(-theta[i] * theta[i] / 2e-4) + 0.1 + 0.08 * sin(40 * theta[i]) + (theta[i] > 2 ? 0.3 : 0);
		if (i % 50 == 7)
			p[i] = 0;
	}
	theta[NODES - 1] = M_PI;
}

/* How far p may be off: angles are floats, 3e-7 at pi, and steps of the table are of them. */
static double p_error(const float *theta, const float *p, int i)
{
	return 1e-5 * fmax(p[i], p[i + 1]) + 6e-7 * fabs(p[i + 1] - p[i]) / (theta[i + 1] - theta[i]);
}

int main(void)
{
	static double theta[NODES], p[NODES];
	static float theta_f[NODES], p_f[NODES];
	static long hit[NODES];
	table(theta, p);

	double line[2] = { 1 / (4 * M_PI), 1 / (4 * M_PI) }, sum = 0, fine = 0;
	for (int i = 0; i < 180; i++)
		sum += phase_interval(i * M_PI / 180, M_PI / 180, line[0], line[1]);
	ok(fabs(sum - 1) < 1e-14, "an isotropic phase function integrates to 1: %.2g", sum - 1);
	double norm = phase_integral(NODES, theta, p);
	for (int i = 0; i + 1 < NODES; i++)        /* Simpson with 200 parts an interval */
		for (int k = 0; k < 200; k++) {
			double h = (theta[i + 1] - theta[i]) / 200, t = theta[i] + k * h;
			fine += 2 * M_PI * h / 6 * (phase_at(NODES, theta, p, t) * sin(t) + 4 * phase_at(NODES, theta, p, t + h / 2) * sin(t + h / 2)
			                            + phase_at(NODES, theta, p, t + h) * sin(t + h));
		}
	ok(fabs(fine / norm - 1) < 1e-10, "the exact integral is that of a fine quadrature: %.2g", fine / norm - 1);

	for (int i = 0; i < NODES; i++)
		p[i] /= norm;

	/* 2e6 draws: counts by interval against their probabilities; means of functions within the intervals. The kernels' tables divide
	 * some intervals. */
	const int32_t range[2] = { 0, NODES };
	const int draws = 2000000;
	for (int i = 0; i < NODES; i++) {
		theta_f[i] = (float)theta[i];
		p_f[i] = (float)p[i];
	}
	struct phase_sampler sampler;
	phase_sampler_make(&sampler, 1, 1, range, theta_f, p_f);
	struct scene scene = { .n_waves = 1, .carried = 1, .n_groups = 1 };
	struct tables t = { .phase = sampler.phase, .interval = sampler.interval, .alias = sampler.alias, .angle = sampler.angle };
	struct waves w = { 1, 0, 0 };
	double cosine = 0, cosine2 = 0, place = 0, place2 = 0, worst = 0, worst_value = 0;
	struct random r = random_of(1, 2, 3);
	for (int k = 0; k < draws; k++) {
		float sn, cs, value[CARRIED], again[CARRIED];
		phase_draw(&scene, &t, ALL_LANES, 0, 0, w, draw_bits(&r, 0), draw_bits(&r, 1), &sn, &cs, value);
		double angle = atan2(sn, cs), length = (double)sn * sn + (double)cs * cs;
		int i = 0;
		for (int step = NODES / 2 + 1; step; step /= 2)
			while (i + step < NODES - 1 && theta_f[i + step] <= angle)
				i += step;
		double f = (angle - theta_f[i]) / (theta_f[i + 1] - theta_f[i]);
		hit[i]++;
		cosine += cos(angle);
		cosine2 += cos(angle) * cos(angle);
		place += f;
		place2 += f * f;
		worst = fmax(worst, fabs(length - 1));
		phase_value(&scene, &t, ALL_LANES, 0, 0, (float)angle, w, again);
		worst_value = fmax(worst_value, fabs(value[0] - again[0]) / (fabs(again[0]) + p_error(theta_f, p_f, i)));
		next_vertex(&r, ALL_LANES);
	}

	/* The index finds the interval of any angle. */
	double worst_index = 0;
	for (int k = 0; k <= 4000000; k++) {
		float at = fminf((float)(k * (M_PI / 4000000)), theta_f[NODES - 1]), value[CARRIED];
		phase_value(&scene, &t, ALL_LANES, 0, 0, at, w, value);
		int i = 0;
		for (int step = NODES / 2 + 1; step; step /= 2)
			while (i + step < NODES - 1 && theta_f[i + step] <= at)
				i += step;
		double want = p_f[i] + (p_f[i + 1] - p_f[i]) * ((double)at - theta_f[i]) / ((double)theta_f[i + 1] - theta_f[i]);
		worst_index = fmax(worst_index, fabs(value[0] - want) / (want + p_error(theta_f, p_f, i)));
	}
	ok(worst_index < 1, "p at any angle: within %.2g of what rounding may do", worst_index);
	double chi2 = 0, bins = 0, mean_cosine = 0, mean_place = 0;
	for (int i = 0; i + 1 < NODES; i++) {
		double h = theta[i + 1] - theta[i], wanted = draws * phase_interval(theta[i], h, p[i], p[i + 1]);
		if (wanted > 20) {
			chi2 += (hit[i] - wanted) * (hit[i] - wanted) / wanted;
			bins++;
		}
		for (int k = 0; k < 100; k++) {        /* midpoint rule, 100 parts */
			double f = (k + 0.5) / 100, at = theta[i] + f * h, q = 2 * M_PI * (p[i] + f * (p[i + 1] - p[i])) * sin(at) * h / 100;
			mean_cosine += cos(at) * q;
			mean_place += f * q;
		}
	}
	double z = (chi2 - bins) / sqrt(2 * bins);
	double z_cosine = (cosine / draws - mean_cosine) / sqrt((cosine2 / draws - pow(cosine / draws, 2)) / draws);
	double z_place = (place / draws - mean_place) / sqrt((place2 / draws - pow(place / draws, 2)) / draws);
	/* three z-scores below 4.5: false alarm 2e-5 */
	ok(fabs(z) < 4.5, "draws fall into the intervals by their probability: chi-square z %.2f", z);
	ok(fabs(z_cosine) < 4.5, "mean cosine: z %.2f", z_cosine);
	ok(fabs(z_place) < 4.5, "places within the intervals: z %.2f", z_place);
	ok(worst < 1e-6, "sine and cosine are of one angle: %.2g", worst);
	ok(worst_value < 1, "p is that at the angle drawn: within %.2g of what rounding may do", worst_value);
	phase_sampler_free(&sampler);
	return done_testing();
}

#include "optics/goa/goa_norm.h"

#include "base/ascending.h"
#include "optics/numerics/gauss.h"
#include "optics/numerics/smoothstep.h"

#include <stdlib.h>
#include <string.h>

#define STEP 7             /* widest panel that resolves interference, over 1/X: its phase turns by 14 rad */
#define ALL 512            /* X up to which all of it is resolved */
#define FULL 35.0          /* theta X up to which all of it counts */
#define LAST 98.0         /* and up to which any does */
#define CROWDS 6           /* orders around whose caustics panels crowd */

/* The panels' ends in rad; out has room for most + 300. */
static int panels(double n, int order, const struct caustic *caustic, double most, double *out)
{
	int k = 0;
	if (most <= ALL) {
		int all = (int)fmax(ceil(M_PI * most / STEP), 128);
		for (; k <= all; k++)
			out[k] = M_PI * k / all;
		return k;
	}
	double end = LAST / most;
	for (int i = 0; i < LAST / STEP; i++) {
		out[k++] = STEP * i / most;
		out[k++] = M_PI - STEP * i / most;
	}
	for (double t = end; t < M_PI / 2; t *= 1.5) {
		out[k++] = t;
		out[k++] = M_PI - t;
	}
	for (int p = 0; p <= order && p <= CROWDS; p++) {
		/* the rainbow; the critical angle of a bubble, up to where order p goes */
		double tau = n < 1 ? 2 * asin(n) - p * M_PI : caustic[p].tau;
		if (isnan(tau))
			continue;
		double at = fabs(remainder(tau + (p - 1) * M_PI, 2 * M_PI));
		for (int i = 0; i <= 10; i++) {
			double t = i == 10 ? at : at + (i % 2 ? 1 : -1) * 0.3 * pow(4, -(i / 2));
			if (t > end && t < M_PI - end)
				out[k++] = t;
		}
	}
	qsort(out, (size_t)k, sizeof *out, ascending);
	return k;
}

int goa_norm_grid_new(double complex m, int order, const struct caustic *caustic, double most, struct goa_norm_grid *out)
{
	double *end = malloc(1000 * sizeof *end), *theta = NULL;
	int status = -1;
	memset(out, 0, sizeof *out);
	if (!end)
		return -1;
	int n = GOA_WIDTH * (panels(creal(m), order, caustic, most, end) - 1);
	theta = malloc((size_t)n * sizeof *theta);
	out->weight = malloc((size_t)n * sizeof *out->weight);
	out->share = malloc((size_t)n * sizeof *out->share);
	out->cosine = malloc((size_t)n * sizeof *out->cosine);
	out->reflected = malloc((size_t)n * sizeof *out->reflected);
	out->path = malloc((size_t)n * sizeof *out->path);
	if (theta && out->weight && out->share && out->cosine && out->reflected && out->path) {
		for (int k = 0; k < n; k++) {
			int i = k % GOA_WIDTH;
			double lo = end[k / GOA_WIDTH], half = (end[k / GOA_WIDTH + 1] - lo) / 2, first, second;
			double t = lo + half + half * gauss_node[i], near = fmin(t, M_PI - t);
			double complex r1, r2;
			theta[k] = t * (180 / M_PI);
			out->weight[k] = 2 * M_PI * sin(t) * half * gauss_weight[i];
			out->share[k] = most <= ALL ? 1 : smoothstep(LAST / most, most / (FULL - LAST), near, &first, &second);
			goa_rays_fresnel(m, cos(t / 2), sin(t / 2), &r1, &r2);
			out->cosine[k] = cos(t);
			/* -2 cos i with i = (pi - theta)/2; what is constant is pi/2 of the ray and 3 pi/4 of diffraction */
			out->reflected[k] = -(r1 + r2) / 2 * CMPLX(M_SQRT1_2, -M_SQRT1_2);
			out->path[k] = (sin(t) - 2 * sin(t / 2)) * M_2_PI;
		}
		status = goa_rays_find(m, order, caustic, n, theta, &out->rays);
	}
	free(end);
	free(theta);
	if (status)
		goa_norm_grid_free(out);
	return status;
}

void goa_norm_grid_free(struct goa_norm_grid *g)
{
	goa_rays_free(&g->rays);
	free(g->weight);
	free(g->share);
	free(g->cosine);
	free(g->reflected);
	free(g->path);
	memset(g, 0, sizeof *g);
}

double goa_norm_grid_sum(const struct goa_lanes *lanes, const struct goa_norm_grid *g, int interfere, double x,
                         const struct goa_cap *cap, double *along)
{
	double sum = 0;
	*along = 0;
	for (int b = 0; b * GOA_WIDTH < g->rays.blocks.n; b++) {
		double s[4][GOA_WIDTH] = { { 0 } }, apart[2][GOA_WIDTH] = { { 0 } }, d[GOA_WIDTH];
		const struct goa_packet *first = &g->rays.packet[g->rays.blocks.first[b]];
		const struct goa_angles *angles = &g->rays.angles[b];
		size_t n = g->rays.blocks.first[b + 1] - g->rays.blocks.first[b];
		int some = 0, all = 1;
		for (int i = 0; i < GOA_WIDTH; i++) {
			some |= interfere && g->share[b * GOA_WIDTH + i] > 0;
			all &= interfere && g->share[b * GOA_WIDTH + i] == 1;
		}
		if (some)
			lanes->coherent(first, n, x, cap, s);
		if (!all)
			lanes->incoherent(first, n, x, cap, apart);
		lanes->diffraction(angles, x, d);
		for (int i = 0; i < GOA_WIDTH; i++) {
			int k = b * GOA_WIDTH + i;
			double share = interfere ? g->share[k] : 0, root = angles->root[i], re1 = s[0][i] + d[i];
			double re2 = s[2][i] + d[i];
			double value = share * (re1 * re1 + s[1][i] * s[1][i] + re2 * re2 + s[3][i] * s[3][i]) / 2;
			if (share < 1) {
				/* far from the front the mean of the lobe's rings */
				double power = (apart[0][i] + apart[1][i]) / 2 +
					(g->share[k] > 0 ? d[i] * d[i] : x * root * root / 2);
				if (interfere && root != 0) {
					/* the reflected ray and that half of diffraction whose phase keeps to it: towards the
					 * front they part only as x theta^3/8 */
					double sine, cosine;
					lane_sincos(x * g->path[k], &sine, &cosine);
					power += x * sqrt(x) * root / 2 *
						 (creal(g->reflected[k]) * cosine - cimag(g->reflected[k]) * sine);
				}
				value += (1 - share) * power;
			}
			sum += g->weight[k] * value;
			*along += g->weight[k] * value * g->cosine[k];
		}
	}
	return sum;
}

/* The loops of GOA: compiled for each processor, BUILD the name of what comes out. */
#include "optics/goa/goa_lanes.h"

#include "optics/numerics/smoothstep.h"

#include <math.h>

/* x sqrt(D) of a packet's rays, with what absorption leaves; returns 0 where that is nothing. */
static int spreads(const struct goa_packet *k, double x, const struct goa_cap *cap, double size[GOA_WIDTH])
{
	int64_t capped = 0;
	if (x * k->clearest > GOA_ABSORBED)
		return 0;
#pragma omp simd reduction(| : capped)
	for (int i = 0; i < GOA_WIDTH; i++) {
		capped |= x < k->until[i];
		size[i] = x * k->spread[i];
	}
	for (int i = 0; capped && i < GOA_WIDTH; i++)
		if (x < k->until[i])
			size[i] = x * goa_rays_spread(x, &k->ray[i], &cap[k->ray[i].p]);
	if (k->fades)
#pragma omp simd
		for (int i = 0; i < GOA_WIDTH; i++)
			size[i] *= lane_decay(x * k->fade[i]);
	return 1;
}

static void coherent(const struct goa_packet *k, size_t n, double x, const struct goa_cap *cap, double s[4][GOA_WIDTH])
{
	for (const struct goa_packet *end = k + n; k < end; k++) {
		double size[GOA_WIDTH];
		if (!spreads(k, x, cap, size))
			continue;
#pragma omp simd
		for (int i = 0; i < GOA_WIDTH; i++) {
			double sine, cosine;
			lane_sincos(x * k->path[i] + k->quarters[i], &sine, &cosine);
			double c = size[i] * cosine, d = size[i] * sine;
			s[0][i] += k->f[0][i] * c - k->f[1][i] * d;
			s[1][i] += k->f[0][i] * d + k->f[1][i] * c;
			s[2][i] += k->f[2][i] * c - k->f[3][i] * d;
			s[3][i] += k->f[2][i] * d + k->f[3][i] * c;
		}
	}
}

static void incoherent(const struct goa_packet *k, size_t n, double x, const struct goa_cap *cap, double s[2][GOA_WIDTH])
{
	for (const struct goa_packet *end = k + n; k < end; k++) {
		double size[GOA_WIDTH];
		if (!spreads(k, x, cap, size))
			continue;
#pragma omp simd
		for (int i = 0; i < GOA_WIDTH; i++) {
			double power = size[i] * size[i];
			s[0][i] += power * (k->f[0][i] * k->f[0][i] + k->f[1][i] * k->f[1][i]);
			s[1][i] += power * (k->f[2][i] * k->f[2][i] + k->f[3][i] * k->f[3][i]);
		}
	}
}

#define ABSENT 1e300     /* rate of what an angle does not have */

/* share of a pair's interference, by how fast its phases part; returns 0 where no angle has any. */
static int shares(double fastest, const double rate[GOA_WIDTH], double share[GOA_WIDTH])
{
	int64_t slow = 0;
#pragma omp simd reduction(| : slow)
	for (int i = 0; i < GOA_WIDTH; i++)
		slow |= rate[i] < fastest;
#pragma omp simd
	for (int i = 0; i < GOA_WIDTH; i++) {
		double first, second;
		share[i] = smoothstep(fastest, -2 / fastest, rate[i], &first, &second);
	}
	return slow != 0;
}

static void with_diffraction(const struct goa_packet *k, const struct goa_angles *angles, const double d[GOA_WIDTH], double x,
                             double fastest, const double size[GOA_WIDTH], double s[2][GOA_WIDTH])
{
	double rate[GOA_WIDTH], share[GOA_WIDTH];
#pragma omp simd
	for (int i = 0; i < GOA_WIDTH; i++) {
		double edge = angles->sine[i] * M_2_PI, one = fabs(k->path[i] - edge), other = fabs(k->path[i] + edge);
		rate[i] = lane_select(0, k->spread[i] * angles->root[i], lane_select(one, other, one, other), ABSENT);
	}
	if (!shares(fastest, rate, share))
		return;
#pragma omp simd
	for (int i = 0; i < GOA_WIDTH; i++) {
		double sine, cosine, twice = 2 * share[i] * size[i] * d[i];
		lane_sincos(x * k->path[i] + k->quarters[i], &sine, &cosine);
		s[0][i] += twice * (k->f[0][i] * cosine - k->f[1][i] * sine);
		s[1][i] += twice * (k->f[2][i] * cosine - k->f[3][i] * sine);
	}
}

static void of_pair(const struct goa_packet *k, const struct goa_packet *l, double x, double fastest,
                    const double k_size[GOA_WIDTH], const double l_size[GOA_WIDTH], double s[2][GOA_WIDTH])
{
	double rate[GOA_WIDTH], share[GOA_WIDTH];
#pragma omp simd
	for (int i = 0; i < GOA_WIDTH; i++)
		rate[i] = lane_select(0, k->spread[i] * l->spread[i], fabs(k->path[i] - l->path[i]), ABSENT);
	if (!shares(fastest, rate, share))
		return;
#pragma omp simd
	for (int i = 0; i < GOA_WIDTH; i++) {
		double sine, cosine, twice = 2 * share[i] * k_size[i] * l_size[i];
		lane_sincos(x * (k->path[i] - l->path[i]) + (k->quarters[i] - l->quarters[i]), &sine, &cosine);
		s[0][i] += twice * ((k->f[0][i] * l->f[0][i] + k->f[1][i] * l->f[1][i]) * cosine -
		                    (k->f[1][i] * l->f[0][i] - k->f[0][i] * l->f[1][i]) * sine);
		s[1][i] += twice * ((k->f[2][i] * l->f[2][i] + k->f[3][i] * l->f[3][i]) * cosine -
		                    (k->f[3][i] * l->f[2][i] - k->f[2][i] * l->f[3][i]) * sine);
	}
}

static void blurred(const struct goa_packet *k, size_t n, const struct goa_angles *angles, const double d[GOA_WIDTH], double x,
                    const struct goa_cap *cap, double fastest, double (*room)[GOA_WIDTH], double s[2][GOA_WIDTH])
{
	for (int i = 0; i < GOA_WIDTH; i++)
		s[0][i] = s[1][i] = d[i] * d[i];
	for (size_t a = 0; a < n; a++) {
		if (!spreads(&k[a], x, cap, room[a]))
			memset(room[a], 0, sizeof room[a]);
		for (int i = 0; i < GOA_WIDTH; i++) {
			double power = room[a][i] * room[a][i];
			s[0][i] += power * (k[a].f[0][i] * k[a].f[0][i] + k[a].f[1][i] * k[a].f[1][i]);
			s[1][i] += power * (k[a].f[2][i] * k[a].f[2][i] + k[a].f[3][i] * k[a].f[3][i]);
		}
		with_diffraction(&k[a], angles, d, x, fastest, room[a], s);
		for (size_t b = 0; b < a; b++)
			of_pair(&k[a], &k[b], x, fastest, room[a], room[b], s);
	}
}

/* Argument from which on Bessel functions are taken from Hankel's asymptotics, Abramowitz and Stegun 9.2.5 to 9.2.10. */
#define HANKEL 14

static void diffraction(const struct goa_angles *k, double x, double d[GOA_WIDTH])
{
	int64_t small = 0;
#pragma omp simd reduction(| : small)
	for (int i = 0; i < GOA_WIDTH; i++) {
		double z = x * k->sine[i], w = 1 / lane_select(z, HANKEL, HANKEL, z), w2 = w * w, sine, cosine;
		lane_sincos(z * M_2_PI - 0.5, &sine, &cosine);
		double p = 1 + w2 * (0.1171875 + w2 * (-0.144195556640625 + 0.6765925884246826 * w2));
		double q = w * (0.375 + w2 * (-0.1025390625 + w2 * (0.277576446533203125 - 1.993531733751297 * w2)));
		d[i] = sqrt(x) * k->root[i] * (p * sine + q * cosine);
		small |= z < HANKEL;
	}
	for (int i = 0; small && i < GOA_WIDTH; i++) {
		double z = x * k->sine[i];
		if (k->root[i] != 0 && z < HANKEL)
			d[i] = z < 1e-4 ? x * x * (0.5 - z * z / 16) : x * x * j1(z) / z;
	}
}

const struct goa_lanes BUILD = { .coherent = coherent, .incoherent = incoherent, .blurred = blurred, .diffraction = diffraction };

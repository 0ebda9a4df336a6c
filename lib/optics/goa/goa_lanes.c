/* The loops of GOA: compiled for each processor, BUILD the name of what comes out. */
#include "optics/goa/goa_lanes.h"

#include "optics/numerics/lane_math.h"

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

const struct goa_lanes BUILD = { .coherent = coherent, .incoherent = incoherent, .diffraction = diffraction };

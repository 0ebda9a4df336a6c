/* What GOA+ is made of: Airy functions, sums of exponentials, windows, rays to second order. */
#include "optics/numerics/airy.h"
#include "optics/goa/goa_plus_windows.h"
#include "optics/goa/debye_order.h"
#include "optics/goa/rays.h"
#include "optics/numerics/nufft.h"

#include "support/sphere.h"
#include "support/tap.h"

#include <stdint.h>

static void airy(void)
{
	/* Ai, Ai', Bi, Bi' (Abramowitz and Stegun, table 10.11; at 0 their closed forms) */
	static const double value[][5] = {
		{ 0, 0.35502805, -0.25881940, 0.61492663, 0.44828836 }, { 1, 0.13529242, -0.15914744, 1.20742359, 0.93243593 },
		{ -1, 0.53556088, -0.01016057, 0.10399739, 0.59237563 }, { -5, 0.35076101, 0.32719282, -0.13836913, 0.77841177 },
		{ -10, 0.04024124, 0.99626504, -0.31467983, 0.11941411 },
	};
	double worst = 0, wronskian = 0, ratio = 0;
	for (unsigned k = 0; k < sizeof value / sizeof *value; k++) {
		struct airy a = airy_real(value[k][0]);
		const double got[4] = { a.ai, a.aip, a.bi, a.bip };
		for (int i = 0; i < 4; i++)
			worst = fmax(worst, fabs(got[i] - value[k][i + 1]));
	}
	ok(worst < 1e-8, "Airy functions as tabulated, within %.1e", worst);
	for (double z = -40; z < 20; z += 0.0173) {
		struct airy a = airy_real(z);
		wronskian = fmax(wronskian, fabs((a.ai * a.bip - a.aip * a.bi) * M_PI - 1));
		if (fabs(a.ai) > 0.1 * fabs(a.bi))
			ratio = fmax(ratio, fabs(creal(airy_ratio(z)) - a.aip / a.ai) / (1 + fabs(a.aip / a.ai)));
	}
	ok(wronskian < 2e-7, "their Wronskian is 1/pi within %.1e", wronskian);
	ok(ratio < 1e-6, "Ai'/Ai for complex arguments agrees with that for real ones within %.1e", ratio);
	/* (Ai'/Ai)' = z - (Ai'/Ai)^2 all over the plane; a seam between forms counts as its step of 1e-7 over h */
	double off = 0;
	for (double r = 0.5; r < 30; r *= 1.07)
		for (double arg = 0.05; arg < 3; arg += 0.1) {
			double complex z = r * cexp(I * arg), h = 1e-4 * cexp(I * arg), v = airy_ratio(z);
			double complex slope = (airy_ratio(z + h) - airy_ratio(z - h)) / (2 * h);
			off = fmax(off, cabs(slope - z + v * v) / (1 + cabs(v * v)));
		}
	ok(off < 1e-3, "and keeps to Riccati's equation within %.1e", off);
}

static void exponentials(void)
{
	static const int count[] = { 1, 2, 37, 345, 680 };
	double worst = 0;
	struct nufft s = { 0 };
	for (unsigned i = 0; i < sizeof count / sizeof *count; i++) {
		int n = count[i];
		double *c = malloc(2 * (size_t)n * sizeof *c);
		uint64_t state = 1;
		for (int k = 0; k < 2 * n; k++) {
			state = state * 6364136223846793005u + 1442695040888963407u;
			c[k] = (double)(state >> 11) * 0x1p-53 - 0.5;
		}
		if (nufft_set(&s, n, (const double *[4]){ NULL, c, NULL, NULL }))
			worst = INFINITY;
		for (double phi = 0.01; phi < 2 * M_PI; phi += 0.37) {
			double complex want = 0, got = 0;
			double at = phi * s.size / (2 * M_PI);
			for (int k = 0; k < n; k++)
				want += (c[2 * k] + I * c[2 * k + 1]) * cexp(I * (k - n / 2) * phi);
			for (int t = -3; t <= 4; t++) {
				double z = ((int)at + t - at) / 4, *row = s.row + 8 * ((int)at + t);
				if (fabs(z) < 1)
					got += exp(NUFFT_SHAPE * (sqrt(1 - z * z) - 1)) * (row[1] + I * row[5]);
			}
			worst = fmax(worst, cabs(got - want) / sqrt(n));
		}
		free(c);
	}
	nufft_free(&s);
	ok(worst < 1e-5, "sums of exponentials by a nonuniform Fourier transform, within %.1e", worst);
}

/* Rays of one order with their second-order terms against the Debye series, where nothing else is needed; errors rms over rms. */
static void second_order(double complex m, int p, double lo, double hi, double wanted)
{
	enum { N = 101 };
	double x = 1000.49, first = 0, second = 0, mean = 0;
	int terms = sphere_terms(x);
	double complex *a = calloc((size_t)terms + 1, sizeof *a), *b = calloc((size_t)terms + 1, sizeof *b);
	struct caustic c = rays_caustic(creal(m), p);
	sphere_debye(x, m, p, terms, a, b);
	for (int k = 0; k < N; k++) {
		double theta = lo + (hi - lo) * k / (N - 1), t = theta * (M_PI / 180);
		double complex want[2], plain[2] = { 0 }, better[2] = { 0 };
		struct ray ray[RAYS_MAX(8)];
		int rays = rays_find(creal(m), p, &c, theta, ray);
		sphere_sum(terms, a, b, t, &want[0], &want[1]);
		for (int i = 0; i < rays; i++) {
			const struct ray *r = &ray[i];
			struct debye_order_terms o;
			debye_order_terms(p, m, r->sin_i, t, r->sigma, r->axial, &o);
			double spread = p ? sqrt(r->ratio * r->cos_i / r->slope) : 0.5;
			double complex wave = -x * spread * cexp(I * (x * o.path + r->eighths * M_PI_4));
			for (int j = 0; j < 2; j++) {
				plain[j] += wave * o.f[j];
				better[j] += wave * (o.f[j] + I / x * o.g[j]);
			}
		}
		for (int j = 0; j < 2; j++) {
			mean += creal(want[j] * conj(want[j]));
			first += creal((plain[j] - want[j]) * conj(plain[j] - want[j]));
			second += creal((better[j] - want[j]) * conj(better[j] - want[j]));
		}
	}
	free(a);
	free(b);
	first = sqrt(first / mean);
	second = sqrt(second / mean);
	ok(second < wanted && second < first / 2,
	   "m = %g%+gi, p = %d, %g to %g degrees: rays within %.1e, to second order %.1e, wanted %.1e", creal(m), cimag(m), p, lo,
	   hi, first, second, wanted);
}

static void windows(void)
{
	struct goa_plus_window w = { 2, { 0, 0.7 }, { 0.3, 0.9 }, { 5, -10 } };     /* rises from 0.3 to 0.5, falls from 0.8 to 0.9 */
	ok(goa_plus_window_at(&w, 0.2) == 0 && goa_plus_window_at(&w, 0.6) == 1 && goa_plus_window_at(&w, 0.75) == 1 && goa_plus_window_at(&w, 0.95) == 0 &&
	   fabs(goa_plus_window_at(&w, 0.4) - 0.5) < 1e-15 && fabs(goa_plus_window_at(&w, 0.85) - 0.5) < 1e-12, "a window rises and falls");
	ok(goa_plus_window_constant(&w, 0, 0.29) == 0 && goa_plus_window_constant(&w, 0.55, 0.79) == 1 && goa_plus_window_constant(&w, 0.2, 0.4) == -1 &&
	   goa_plus_window_constant(&w, 0.1, 0.95) == -1 && goa_plus_window_constant(&w, 0.92, 2) == 0, "and says where it is constant");
	double worst = 0;
	for (double u = 0.31; u < 0.5; u += 0.01) {
		double f1, f2, g1, g2, h = 1e-5, up = smoothstep(0.3, 5, u + h, &g1, &g2);
		double down = smoothstep(0.3, 5, u - h, &f1, &f2), d1, d2;
		smoothstep(0.3, 5, u, &d1, &d2);
		worst = fmax(worst, fmax(fabs((up - down) / (2 * h) - d1), fabs((g1 - f1) / (2 * h) - d2) / 100));
	}
	ok(worst < 1e-5, "its derivatives are those of it: %.1e", worst);
}

int main(void)
{
	static const struct { double complex m; int p; double lo, hi, wanted; } part[] = {
		{ 1.33, 0, 100, 180, 5e-6 }, { 1.33, 0, 60, 100, 1e-4 }, { 1.33, 1, 0, 45, 1e-4 },
		{ 1.33, 3, 20, 60, 3e-4 }, { 1.33, 4, 60, 80, 2e-4 }, { 1.5, 1, 0, 60, 2e-4 }, { 2.5, 1, 0, 90, 1e-4 },
		{ 2.5, 2, 135, 180, 2e-4 }, { 0.75, 0, 120, 180, 3e-4 }, { 0.75, 1, 0, 45, 2e-4 },
		{ 1.33 + 0.001 * I, 1, 0, 45, 2e-4 },
	};
	enum { PARTS = sizeof part / sizeof *part };
	airy();
	exponentials();
	windows();
	for (int k = 0; k < PARTS; k++)
		second_order(part[k].m, part[k].p, part[k].lo, part[k].hi, part[k].wanted);
	return done_testing();
}

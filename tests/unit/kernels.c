/* The kernels' elementary functions keep their stated errors; the film adds exactly. */
#include "render/kern/film.h"
#include "support/tap.h"

#include <math.h>

static int64 one_value(float v)
{
	l8 n = film_integers((f8){ v });
	return n[0];
}

int main(void)
{
	double worst_log = 0, worst_exp = 0, worst_sin = 0, worst_atan = 0, worst_angle = 0, worst_turn = 0;
	for (int i = 1; i < 2000000; i++) {
		float x = (float)i * 0x1p-21f, y = (float)i * 86.9f / 2000000, z = (float)i * 6.2831853f / 2000000, s, c;
		worst_log = fmax(worst_log, fabs(neglog(x) + log(x)) / fmax(1, fabs(log(x))));
		worst_exp = fmax(worst_exp, fabs(expneg(y) / exp(-(double)y) - 1) / (1 + y));
		fv_sincos(z, &s, &c);
		worst_sin = fmax(worst_sin, fmax(fabs(s - sin(z)), fabs(c - cos(z))));
		worst_atan = fmax(worst_atan, fabs(fv_atan_octant(x < 1 ? x : 1, 1) / atan(x < 1 ? x : 1) - 1));
	}
	ok(worst_log < 1.5e-7, "neglog: %.2g of max(1, |log x|)", worst_log);
	ok(worst_exp < 1e-7, "expneg: %.2g (1 + x), relative", worst_exp);
	ok(worst_sin < 2e-7, "sin, cos: %.2g", worst_sin);
	ok(worst_atan < 5e-7, "atan: %.2g, relative", worst_atan);
	float small_s, small_c;
	fv_sincos(1e-5f, &small_s, &small_c);
	ok(fabs(small_s / sin((double)1e-5f) - 1) < 1e-7, "sin is relative near 0");

	/* angles between unit vectors, near both ends as in the middle, in units of the rounding of the vectors */
	for (int i = -60; i <= 60; i++)
		for (int end = 0; end < 2; end++) {
			double t = pow(10, i / 10.0);
			if (t > 3.1)
				continue;
			t = end ? M_PI - t : t;
			struct vec a = { 1, 0, 0 }, b = { (float)cos(t), (float)sin(t), 0 };
			worst_angle = fmax(worst_angle, fabs(angle_between(a, b) - t));
		}
	ok(worst_angle < 1e-6, "angle_between: %.2g rad", worst_angle);

	for (int i = -1000000; i <= 1000000; i++) {
		float t = (float)i * 3.1415925e-6f, r = bits_float(0x3f800000u + ((uint32)i * 0x9e3779b9u >> 4) % 0x4000000u);
		float y = r * (float)sin(t), x = r * (float)cos(t);
		worst_turn = fmax(worst_turn, fabs(fv_atan2(y, x) - atan2(y, x)));
	}
	ok(worst_turn < 8e-7 && fv_atan2(0.f, 0.f) == 0.f && fv_atan2(0.f, -1.f) == PI, "fv_atan2: %.2g rad", worst_turn);

	ok(one_value(1.f) == 1 << 30 && one_value(-0.25f) == -(1 << 28) && one_value(0x1p-31f) == 1 && one_value(0.f) == 0,
	   "the film's unit is 2^-30, rounded to the nearest");
	float bad[] = { NAN, INFINITY, -INFINITY, FILM_MOST };
	for (int i = 0; i < 4; i++)
		ok(any(film_clamp(ALL_LANES, &bad[i])) && bad[i] == FILM_MOST, "what is too large or no number is told: %d", i);
	ok(one_value(3.14159274f) == (int64)llrint(3.14159274f * FILM_UNIT), "a float's own bits survive");
	long wrong = 0;
	for (int k = -(1 << 23); k < 1 << 24; k += 7) {
		float v = (float)k * 0x1p-30f * 1.5f;
		wrong += one_value(v) != llround((double)v * FILM_UNIT);
	}
	ok(!wrong, "the film rounds to the nearest: %ld differ", wrong);
	double worst_path = 0;
	for (uint32 b = 1; b < 4000000000u; b += b / 64 + 1) {
		double want = -log1p(-(b / 2 + 0.5) * 0x1p-31);
		worst_path = fmax(worst_path, fabs(free_path(b) / want - 1));
	}
	ok(worst_path < 1e-6, "free_path: %.2g, relative", worst_path);
	return done_testing();
}

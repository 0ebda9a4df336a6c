/* lane_math - elementary functions without branches, so that loops over them become vector code. Only + - * / and sqrt of
 * doubles and operations on their bits: the same bits at every width of vector. */
#ifndef OPTICS_LANE_MATH_H
#define OPTICS_LANE_MATH_H

#include <stdint.h>
#include <string.h>

static inline int64_t lane_bits(double x)
{
	int64_t i;
	memcpy(&i, &x, sizeof i);
	return i;
}

static inline double lane_double(int64_t i)
{
	double x;
	memcpy(&x, &i, sizeof x);
	return x;
}

/* a where less < than, else b; both are computed. */
static inline double lane_select(double less, double than, double a, double b)
{
	int64_t m = -(int64_t)(less < than);
	return lane_double((m & lane_bits(a)) | (~m & lane_bits(b)));
}

/* Cube root of a normal a > 0 within 1e-4 of itself: a third of the exponent, and a step of Halley's rule. */
static inline double lane_cbrt(double a)
{
	double r = lane_double(lane_bits(a) / 3 + 0x2a9f7893782da1ce), c = r * r * r;
	return r * (c + 2 * a) / (2 * c + a);
}

#define LANE_ROUND 0x1.8p52    /* added and taken away, rounds to an integer; which then stands in the low bits */

/* sin and cos of t quarter turns, |t| < 2^50: the reduction is exact, and a phase x a as good as the product. Error 2e-14. */
static inline void lane_sincos(double t, double *s, double *c)
{
	double k = t + LANE_ROUND;
	int64_t q = lane_bits(k), odd = -(q & 1);
	double f = t - (k - LANE_ROUND), w = f * f;
	double sine = f * (1.5707963267948966 + w * (-0.6459640975062463 + w * (0.07969262624616704 + w * (-0.004681754135318688 +
		w * (0.00016044118478735982 + w * (-3.598843235212085e-06 + w * 5.692172921967926e-08))))));
	double cosine = 1 + w * (-1.2337005501361697 + w * (0.253669507901048 + w * (-0.020863480763352961 +
		w * (0.00091926027483942659 + w * (-2.5202042373060605e-05 +
		w * (4.7108747788181716e-07 + w * -6.3866030837918522e-09))))));
	int64_t si = lane_bits(sine), ci = lane_bits(cosine);
	*s = lane_double(((odd & ci) | (~odd & si)) ^ (int64_t)((uint64_t)(q & 2) << 62));
	*c = lane_double(((odd & si) | (~odd & ci)) ^ (int64_t)((uint64_t)((q + 1) & 2) << 62));
}

/* atan(y/x) for y >= 0, x > 0. Error 1e-12. */
static inline double lane_atan2(double y, double x)
{
	double low = lane_select(y, x, y, x), high = lane_select(y, x, x, y), t = low / high;
	double far = lane_select(0.41421356237309503, t, 1, 0);      /* beyond tan(pi/8), from pi/4 */
	t = lane_select(0.41421356237309503, t, (low - high) / (low + high), t);
	double w = t * t;
	double a = t * (1 - w * (1.0 / 3 - w * (1.0 / 5 - w * (1.0 / 7 - w * (1.0 / 9 - w * (1.0 / 11 - w * (1.0 / 13 -
		w * (1.0 / 15 - w * (1.0 / 17 - w * (1.0 / 19 - w * (1.0 / 21 -
		w * (1.0 / 23 - w * (1.0 / 25 - w / 27)))))))))))));
	a += far * 0.7853981633974483;
	return lane_select(y, x, a, 1.5707963267948966 - a);
}

/* e^-a, a >= 0; 0 is as small as 1e-300. Relative error 1e-13. */
static inline double lane_decay(double a)
{
	double t = a * -1.4426950408889634;
	t = lane_select(t, -1000, -1000, t);
	double k = t + LANE_ROUND;
	int64_t q = lane_bits(k);
	double f = (t - (k - LANE_ROUND)) * 0.6931471805599453;
	double e = 1 + f * (1 + f * (1.0 / 2 + f * (1.0 / 6 + f * (1.0 / 24 + f * (1.0 / 120 + f * (1.0 / 720 + f * (1.0 / 5040 +
		f * (1.0 / 40320 + f * (1.0 / 362880 + f * (1.0 / 3628800 + f / 39916800))))))))));
	return lane_double(lane_bits(e) + (int64_t)((uint64_t)q << 52));
}

#endif

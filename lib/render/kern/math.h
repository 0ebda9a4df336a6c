/* math - elementary functions from + - * / and integers, and vectors in space. Each states its largest error. */
#ifndef KERN_MATH_H
#define KERN_MATH_H

#include "render/kern/lane.h"

#define PI 3.14159265f

/* x without its fraction, and without its sign. */
FN fv fv_trunc(fv x) { return to_float(to_int(x)); }
FN fv fv_abs(fv x) { return bits_float(float_bits(x) & 0x7fffffffu); }

/* log(1 + m) for 1 + m in [sqrt(1/2), sqrt 2); relative error below 2e-7. */
FN fv log_near(fv m)
{
	fv p = m * -0.0784109103f + 0.129894573f;
	p = p * m - 0.131933337f;
	p = p * m + 0.141654505f;
	p = p * m - 0.166134895f;
	p = p * m + 0.200029488f;
	p = p * m - 0.25001404f;
	p = p * m + 0.333333089f;
	p = p * m - 0.499999909f;
	return p * m * m + m;
}

/* -log x for 2^-126 <= x <= 2^126; absolute error below 1.5e-7 max(1, |log x|). */
FN fv neglog(fv x)
{
	iv e = signed_of(float_bits(x) - 0x3f3504f3u) >> 23;    /* x = 2^e (1 + m) */
	fv m = bits_float(float_bits(x) - (unsigned_of(e) << 23)) - 1.f;
	return -(to_float(e) * 0.693147181f + log_near(m));
}

/* -log(1 - u) for u = (the upper 31 bits + 1/2) 2^-31: optical depths down to 2e-10 and up to 22.2, without the steps of a
 * 24-bit u; relative error below 1e-6. */
FN fv free_path(uv bits)
{
	iv n = signed_of(bits >> 1);
	fv u = (to_float(n) + 0.5f) * 0x1p-31f, x = (to_float(0x7fffffff - n) + 0.5f) * 0x1p-31f;    /* x = 1 - u */
	iv e = signed_of(float_bits(x) - 0x3f3504f3u) >> 23;
	fv m = bits_float(float_bits(x) - (unsigned_of(e) << 23)) - 1.f;
	return -(to_float(e) * 0.693147181f + log_near(SEL(ilt(n, IV(0x20000000)), -u, m)));    /* u < 1/4: e is 0 */
}

/* 1 - exp(-x) for 0 <= x <= 1/8; relative error below 1e-7. */
FN fv one_less_exp(fv x)
{
	return x * (1.f - x * (0.5f - x * (0.166666667f - x * (0.0416666667f - x * 0.00833333333f))));
}

/* The optical depth of a flight that ends before depth x <= 1/8, by the same bits. */
FN fv forced_path(uv bits, fv x)
{
	fv u = (to_float(signed_of(bits >> 1)) + 0.5f) * 0x1p-31f;
	return -log_near(-u * one_less_exp(x));
}

/* exp(-x) for x >= 0, 0 beyond 87; relative error below 1e-7 (1 + x). */
FN fv expneg(fv x)
{
	mv small = lt(x, FV(87.f));
	fv y = SEL(small, x, FV(0.f)) * 1.44269504f;
	iv n = to_int(y + 0.5f);
	fv g = to_float(n) - y;
	fv p = g * 0.000154697343f + 0.00133908669f;
	p = p * g + 0.00961803077f;
	p = p * g + 0.0555035711f;
	p = p * g + 0.240226511f;
	p = p * g + 0.693147188f;
	return SEL(small, (p * g + 1.f) * bits_float(unsigned_of(127 - n) << 23), FV(0.f));
}

/* sin and cos of x in [0, 2 pi]; absolute error below 2e-7, that of sin relative near 0. */
FN void fv_sincos(fv x, fv *s, fv *c)
{
	iv q = to_int(x * 0.636619772f + 0.5f);
	fv turns = to_float(q), t = (x - turns * 1.57079637f) + turns * 4.37113883e-8f;    /* pi/2 in two parts */
	fv t2 = t * t;
	fv sn = t + t * t2 * (-0.166666647f + t2 * (0.00833274899f - t2 * 0.000195880074f));
	fv cs = 1.f - 0.5f * t2 + t2 * t2 * (0.0416666647f + t2 * (-0.00138883036f + t2 * 2.45480405e-5f));
	mv even = ieq(q & 1, IV(0));
	*s = bits_float(float_bits(SEL(even, sn, cs)) ^ unsigned_of(q & 2) << 30);
	*c = bits_float(float_bits(SEL(even, cs, sn)) ^ unsigned_of((q + 1) & 2) << 30);
}

/* atan(y / x) for 0 <= y <= x, x > 0; relative error below 5e-7. */
FN fv fv_atan_octant(fv y, fv x)
{
	mv steep = lt(x * 0.414213562f, y);
	fv z = SEL(steep, y - x, y) / SEL(steep, y + x, x), q = z * z;
	return SEL(steep, FV(0.785398163f), FV(0.f))
	    + (z + z * q * (-0.333332896f + q * (0.199915483f + q * (-0.140289458f + q * 0.0853909995f))));
}

/* Where the share v of int_0^1 q[0] + q[1] f + .. + q[4] f^4 df is reached, a density not below 0 on [0, 1]: Newton kept in a
 * bracket, from where a density linear between its ends would have it. */
FN fv invert_density(const fv *q, fv v, int steps)
{
	fv g1 = 0.5f * q[1], g2 = 0.333333333f * q[2], g3 = 0.25f * q[3], g4 = 0.2f * q[4];
	fv end = q[0] + q[1] + q[2] + q[3] + q[4], spread = q[0] + fv_sqrt(fv_max(FV(0.f), q[0] * q[0] + v * (end * end - q[0] * q[0])));
	fv target = v * (q[0] + g1 + g2 + g3 + g4), lo = FV(0.f), hi = FV(1.f);
	fv f = SEL(lt(FV(0.f), spread), fv_min(FV(1.f), v * (q[0] + end) / spread), v);
	for (int i = 0; i < steps; i++) {
		fv excess = f * (q[0] + f * (g1 + f * (g2 + f * (g3 + f * g4)))) - target;
		fv slope = q[0] + f * (q[1] + f * (q[2] + f * (q[3] + f * q[4])));
		mv over = lt(FV(0.f), excess);
		hi = SEL(over, f, hi);
		lo = SEL(over, lo, f);
		fv next = f - excess / slope;
		f = SEL(le(lo, next) & le(next, hi), next, 0.5f * (lo + hi));
	}
	return f;
}

/* The angle of the point (x, y) from the x axis towards y, in [-pi, pi], 0 at the origin; absolute error below 8e-7. */
FN fv fv_atan2(fv y, fv x)
{
	fv a = fv_abs(x), b = fv_abs(y);
	mv flat = lt(b, a), up = lt(FV(0.f), b);
	fv t = fv_atan_octant(SEL(flat, b, a), SEL(flat, a, SEL(up, b, FV(1.f))));
	t = SEL(flat, t, SEL(up, 0.5f * PI - t, FV(0.f)));
	t = SEL(lt(x, FV(0.f)), PI - t, t);
	return SEL(lt(y, FV(0.f)), -t, t);
}

struct vec {
	fv x, y, z;
};

FN struct vec vec3(fv x, fv y, fv z) { struct vec v = { x, y, z }; return v; }
FN struct vec load3(const float *a) { return vec3(FV(a[0]), FV(a[1]), FV(a[2])); }
FN struct vec add(struct vec a, struct vec b) { return vec3(a.x + b.x, a.y + b.y, a.z + b.z); }
FN struct vec sub(struct vec a, struct vec b) { return vec3(a.x - b.x, a.y - b.y, a.z - b.z); }
FN struct vec scale(struct vec a, fv k) { return vec3(a.x * k, a.y * k, a.z * k); }
FN fv dot3(struct vec a, struct vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
FN struct vec unit3(struct vec a) { return scale(a, 1.f / fv_sqrt(dot3(a, a))); }
FN struct vec sel3(mv m, struct vec a, struct vec b) { return vec3(SEL(m, a.x, b.x), SEL(m, a.y, b.y), SEL(m, a.z, b.z)); }
FN void set3(mv m, struct vec *v, struct vec value) { *v = sel3(m, value, *v); }

/* Angle between unit vectors in [0, pi]: 2 asin(|a - b| / 2), or by |a + b| from pi where that is shorter, accurate at both ends,
 * where a float cosine cannot resolve a peak 3e-4 rad wide. asin is a polynomial of relative error 2e-7. */
FN fv angle_between(struct vec a, struct vec b)
{
	struct vec u = sub(a, b), v = add(a, b);
	fv near = dot3(u, u), far = dot3(v, v), q = 0.25f * fv_min(near, far);
	fv p = q * 0.11357414f - 0.09684852f;
	p = p * q + 0.080140255f;
	p = p * q + 0.015181846f;
	p = p * q + 0.04674823f;
	p = p * q + 0.07485923f;
	p = p * q + 0.16667022f;
	fv t = fv_sqrt(q), angle = 2.f * (t + t * q * p);
	return SEL(le(near, far), angle, PI - angle);
}

/* The unit vector at polar angle theta (by its sine and cosine) and azimuth phi about w.
 * Frame of Duff et al. 2017, "Building an orthonormal basis, revisited". */
FN struct vec to_world(struct vec w, fv sin_theta, fv cos_theta, fv phi)
{
	fv s, c, sign = SEL(lt(w.z, FV(0.f)), FV(-1.f), FV(1.f)), a = -1.f / (sign + w.z), b = w.x * w.y * a;
	fv_sincos(phi, &s, &c);
	s *= sin_theta;
	c *= sin_theta;
	struct vec v = vec3((1.f + sign * w.x * w.x * a) * c + b * s + w.x * cos_theta,
	                    sign * b * c + (sign + w.y * w.y * a) * s + w.y * cos_theta, w.z * cos_theta - sign * w.x * c - w.y * s);
	return scale(v, 1.5f - 0.5f * dot3(v, v));    /* of unit length but for rounding: 1 / sqrt to first order */
}

#endif

/* math - elementary functions from + - * / and integers. Each states its largest error. */
#ifndef KERN_MATH_H
#define KERN_MATH_H

#include "render/kern/compat.h"

#define PI 3.14159265f

FN float least(float a, float b) { return a < b ? a : b; }
FN float most(float a, float b) { return a > b ? a : b; }

/* -log x for 2^-126 <= x <= 2^126; absolute error below 1.5e-7 max(1, |log x|). */
FN float neglog(float x)
{
	int e = (int)(float_bits(x) - 0x3f3504f3u) >> 23;    /* x = 2^e (1 + m), 1 + m in [root(1/2), sqrt 2) */
	float m = bits_float(float_bits(x) - ((uint32)e << 23)) - 1.f;
	float p = -0.0784109103f;
	p = p * m + 0.129894573f;
	p = p * m - 0.131933337f;
	p = p * m + 0.141654505f;
	p = p * m - 0.166134895f;
	p = p * m + 0.200029488f;
	p = p * m - 0.25001404f;
	p = p * m + 0.333333089f;
	p = p * m - 0.499999909f;
	return -((float)e * 0.693147181f + (p * m * m + m));
}

/* exp(-x) for x >= 0, 0 beyond 87; relative error below 1e-7 (1 + x). */
FN float expneg(float x)
{
	if (!(x < 87.f))
		return 0.f;
	float y = x * 1.44269504f;
	int n = (int)(y + 0.5f);
	float g = (float)n - y, p = 0.000154697343f;
	p = p * g + 0.00133908669f;
	p = p * g + 0.00961803077f;
	p = p * g + 0.0555035711f;
	p = p * g + 0.240226511f;
	p = p * g + 0.693147188f;
	return (p * g + 1.f) * bits_float((uint32)(127 - n) << 23);
}

/* sin and cos of x in [0, 2 pi]; absolute error below 2e-7, that of sin relative near 0. */
FN void sincos_of(float x, float *s, float *c)
{
	int q = (int)(x * 0.636619772f + 0.5f);
	float t = (x - (float)q * 1.57079637f) + (float)q * 4.37113883e-8f;    /* pi/2 in two parts */
	float t2 = t * t;
	float sn = t + t * t2 * (-0.166666647f + t2 * (0.00833274899f - t2 * 0.000195880074f));
	float cs = 1.f - 0.5f * t2 + t2 * t2 * (0.0416666647f + t2 * (-0.00138883036f + t2 * 2.45480405e-5f));
	*s = q & 1 ? cs : sn;
	*c = q & 1 ? sn : cs;
	*s = q & 2 ? -*s : *s;
	*c = (q + 1) & 2 ? -*c : *c;
}

/* atan z for 0 <= z <= 1; relative error below 5e-7. */
FN float atan_unit(float z)
{
	float shift = 0.f;
	if (z > 0.414213562f) {
		shift = 0.785398163f;
		z = (z - 1.f) / (z + 1.f);
	}
	float q = z * z;
	return shift + (z + z * q * (-0.333332896f + q * (0.199915483f + q * (-0.140289458f + q * 0.0853909995f))));
}

/* Where the share v of int_0^1 q0 + q1 f + .. + q4 f^4 df is reached, a density not below 0 on [0, 1]: Newton kept in a bracket,
 * from where a density linear between its ends would have it. */
FN float invert_density(float q0, float q1, float q2, float q3, float q4, float v)
{
	float g1 = 0.5f * q1, g2 = 0.333333333f * q2, g3 = 0.25f * q3, g4 = 0.2f * q4;
	float end = q0 + q1 + q2 + q3 + q4, spread = q0 + root(most(0.f, q0 * q0 + v * (end * end - q0 * q0)));
	float target = v * (q0 + g1 + g2 + g3 + g4), f = spread > 0.f ? least(1.f, v * (q0 + end) / spread) : v, lo = 0.f, hi = 1.f;
	for (int i = 0; i < 4; i++) {
		float excess = f * (q0 + f * (g1 + f * (g2 + f * (g3 + f * g4)))) - target;
		float slope = q0 + f * (q1 + f * (q2 + f * (q3 + f * q4)));
		if (excess > 0.f)
			hi = f;
		else
			lo = f;
		float next = f - excess / slope;
		f = next >= lo && next <= hi ? next : 0.5f * (lo + hi);
	}
	return f;
}

/* The angle of the point (x, y) from the x axis towards y, in [-pi, pi], 0 at the origin; absolute error below 8e-7. */
FN float turn_of(float y, float x)
{
	float a = x < 0.f ? -x : x, b = y < 0.f ? -y : y;
	float t = a > b ? atan_unit(b / a) : b > 0.f ? 0.5f * PI - atan_unit(a / b) : 0.f;
	t = x < 0.f ? PI - t : t;
	return y < 0.f ? -t : t;
}

struct vec {
	float x, y, z;
};

FN struct vec vec3(float x, float y, float z) { struct vec v = { x, y, z }; return v; }
FN struct vec load3(const float *a) { return vec3(a[0], a[1], a[2]); }
FN struct vec add(struct vec a, struct vec b) { return vec3(a.x + b.x, a.y + b.y, a.z + b.z); }
FN struct vec sub(struct vec a, struct vec b) { return vec3(a.x - b.x, a.y - b.y, a.z - b.z); }
FN struct vec scale(struct vec a, float k) { return vec3(a.x * k, a.y * k, a.z * k); }
FN float dot3(struct vec a, struct vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
FN struct vec unit3(struct vec a) { return scale(a, 1.f / root(dot3(a, a))); }

/* Angle between unit vectors in [0, pi]: 2 atan(|a - b| / |a + b|), accurate at both ends, where a float cosine
 * cannot resolve a peak 3e-4 rad wide. */
FN float angle_between(struct vec a, struct vec b)
{
	struct vec u = sub(a, b), v = add(a, b);
	float near = root(dot3(u, u)), far = root(dot3(v, v));
	return near <= far ? 2.f * atan_unit(near / far) : PI - 2.f * atan_unit(far / near);
}

/* The unit vector at polar angle theta (by its sine and cosine) and azimuth phi about w.
 * Frame of Duff et al. 2017, "Building an orthonormal basis, revisited". */
FN struct vec around(struct vec w, float sin_theta, float cos_theta, float phi)
{
	float s, c, sign = w.z < 0.f ? -1.f : 1.f, a = -1.f / (sign + w.z), b = w.x * w.y * a;
	sincos_of(phi, &s, &c);
	s *= sin_theta;
	c *= sin_theta;
	return unit3(vec3((1.f + sign * w.x * w.x * a) * c + b * s + w.x * cos_theta,
	                  sign * b * c + (sign + w.y * w.y * a) * s + w.y * cos_theta,
	                  w.z * cos_theta - sign * w.x * c - w.y * s));
}

#endif

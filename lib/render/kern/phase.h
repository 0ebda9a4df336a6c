/* phase - tabulated phase functions: values, and directions drawn exactly by them. */
#ifndef KERN_PHASE_H
#define KERN_PHASE_H

#include "render/kern/math.h"
#include "render/kern/scene.h"

/* A scattering angle in the table of a class: between node and node + 1, fraction f. */
struct at_angle {
	int node;
	float f;
};

FN struct at_angle phase_locate(const struct tables *t, int class, float theta)
{
	struct at_angle a;
	int low = t->node[2 * class], high = low + t->node[2 * class + 1] - 1;
	while (high - low > 1) {
		int middle = (low + high) / 2;
		if (t->theta[middle] <= theta)
			low = middle;
		else
			high = middle;
	}
	a.node = low;
	a.f = least(1.f, most(0.f, (theta - t->theta[low]) / (t->theta[low + 1] - t->theta[low])));
	return a;
}

/* p in sr^-1. */
FN float phase_value(const struct tables *t, int n_waves, struct at_angle a, int wave)
{
	float p0 = t->p[a.node * n_waves + wave], p1 = t->p[(a.node + 1) * n_waves + wave];
	return p0 + (p1 - p0) * a.f;
}

/* An angle with the density p(theta) sin(theta) of a wavelength: the interval by its tabulated probability, the place in it by
 * inverting the integral of (linear p) x sin, sin being a cubic over an interval (at most 1 degree: relative error 4e-9). */
FN struct at_angle phase_sample(const struct tables *t, int n_waves, int class, int wave, uint32 u, float *theta)
{
	int low = t->node[2 * class], last = low + t->node[2 * class + 1] - 1, high = last;
	while (high - low > 1) {
		int middle = (low + high) / 2;
		if (t->cdf[middle * n_waves + wave] <= u)
			low = middle;
		else
			high = middle;
	}
	uint32 begin = t->cdf[low * n_waves + wave], width = t->cdf[high * n_waves + wave] - begin;
	float v = ((float)(u - begin) + 0.5f) / (float)width;
	float angle = t->theta[low], h = t->theta[high] - angle, s, c;
	float p0 = t->p[low * n_waves + wave], d = t->p[high * n_waves + wave] - p0;
	sincos_of(angle, &s, &c);
	/* density (p0 + d f) (s + c1 f + c2 f^2 + c3 f^3) = q0 + q1 f + .. + q4 f^4 */
	float c1 = c * h, c2 = -0.5f * s * h * h, c3 = -0.166666667f * c * h * h * h;
	float q0 = p0 * s, q1 = p0 * c1 + d * s, q2 = p0 * c2 + d * c1, q3 = p0 * c3 + d * c2, q4 = d * c3;
	float f = invert_density(q0, q1, q2, q3, q4, least(v, 1.f));
	struct at_angle a;
	a.node = low;
	a.f = f;
	*theta = angle + h * f;
	return a;
}

#endif

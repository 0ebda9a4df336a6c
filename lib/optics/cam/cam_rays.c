#include "optics/cam/cam_rays.h"

#include "optics/cam/cam_waves.h"
#include "optics/goa/rays.h"
#include "optics/goa/debye_order.h"

#include <math.h>

#define FAINT 1e-4     /* amplitudes below this are left out */

static void find_pencils(double complex m, struct cam_rays *c)
{
	c->pencils = impact_quadrature(m, CAM_PANELS, c->impact);
	for (int k = 0; k < c->pencils; k++) {
		const struct impact *e = &c->impact[k];
		double i = e->incidence, t = e->enters ? asin(sin(i) / creal(m)) : 0;
		c->pencil[k] = (struct cam_pencil){ .out = cexp(2 * I * (t - i)), .turn = -cexp(2 * I * t), .off = -cos(2 * i) };
	}
}

static void find_glories(double complex m, struct cam_rays *c)
{
	double n = creal(m);
	for (int p = 2; p <= CAM_ORDER; p++) {
		struct caustic caustic = rays_caustic(n, p);
		struct ray ray[RAYS_MAX(CAM_ORDER)];
		for (int k = 0, found = rays_find(n, p, &caustic, 0, ray); k < found && c->glories < CAM_GLORIES; k++) {
			const struct ray *r = &ray[k];
			double complex f[2];
			if (r->axial || r->sigma < 0)     /* one of each pair; the axis itself is no glory */
				continue;
			double u = r->sin_i, q3 = r->q * r->q * r->q;
			debye_order_amplitude(p, m, u, 0, f);
			if (cabs(f[0] + f[1]) < FAINT)
				continue;
			c->glory[c->glories++] = (struct cam_glory){
				.amplitude = -2 * u * (f[0] + f[1]) * sqrt(2 * M_PI * r->cos_i) * cexp(I * M_PI_4 * (r->eighths + 1)),
				.path = debye_order_path(p, m, u), .u = u, .slope = r->slope, .bend = 2 * p * u * (n * n - 1) / q3 };
		}
	}
}

/* k chords that turn M times round the centre: the angle of refraction is pi/2 - pi M/k. Stationary phase of the terms S_(p+k) S_p* in
 * sum (1 - |S_l|^2) and sum (1 - Re S_l S*_(l+1)), by Poisson's formula. */
static void find_polygons(double complex m, struct cam_rays *c)
{
	double n = creal(m);
	for (int k = 3; k <= CAM_ORDER; k++)
		for (int turns = 1; 2 * turns < k; turns++) {
			double t = M_PI_2 - M_PI * turns / k, u = n * sin(t), q = n * cos(t);
			double angle = M_PI - 2 * t, out = M_PI - 2 * asin(fmin(u, 1));
			double common = -2 * u * sqrt(M_PI * q / k) * (turns % 2 ? -1 : 1);
			double complex f0[2], f1[2], f2[2], turned = cexp(I * M_PI_4 * (1 - 2 * k));
			struct cam_polygon g = { .u = u, .phase = 2 * k * q };
			if (u >= 1)
				continue;
			debye_order_amplitude(0, m, u, 0, f0);
			debye_order_amplitude(1, m, u, 0, f1);
			debye_order_amplitude(2, m, u, 0, f2);
			g.chord = 2 * cimag(debye_order_chord(m, u));
			g.fade = k * g.chord / 2;
			for (int j = 0; j < 2; j++) {
				double complex inside = f2[j] / f1[j], power = 1;
				double order = 1;
				for (int i = 1; i < k; i++)
					power *= inside;
				g.kept[j] = norm2(inside);
				g.first[j] = common * turned * conj(f0[j]) * f1[j] * power;
				g.later[j] = common * turned * norm2(f1[j]) * power * inside;
				g.pressure[0] += g.first[j] * cos(out);
				for (int p = 1; p < 200 && order > 1e-6; p++, order *= g.kept[j])
					g.pressure[1] += g.later[j] * order * cos(out - p * angle);
			}
			if (cabs(g.pressure[0] + g.pressure[1]) + cabs(g.first[0] + g.first[1]) > FAINT && c->polygons < CAM_POLYGONS)
				c->polygon[c->polygons++] = g;
		}
}

void cam_rays_find(double complex m, struct cam_rays *out)
{
	*out = (struct cam_rays){ .pencils = 0 };
	find_pencils(m, out);
	find_glories(m, out);
	find_polygons(m, out);
}

/* Absorption and radiation pressure of rays: at each impact parameter of the light that enters, (1 - |R|^2), so much is lost along all
 * chords, and so much leaves along each direction. */
void cam_rays_mean(const struct cam_rays *c, double x, double *abs, double *pr)
{
	*abs = *pr = 0;
	for (int k = 0; k < c->pencils; k++) {
		const struct impact *e = &c->impact[k];
		const struct cam_pencil *p = &c->pencil[k];
		double kept = e->chord == 0 ? 1 : exp(-2 * x * e->chord);
		for (int j = 0; j < 2; j++) {
			double r = e->reflected[j], enters = 1 - r;
			double complex left = 1 - r * kept * p->turn;
			double forward = kept * enters * enters * (creal(p->out) * creal(left) + cimag(p->out) * cimag(left)) / norm2(left);
			*pr += e->weight / 2 * (1 - r * p->off - forward);
			if (enters > 0)
				*abs += e->weight / 2 * enters * (1 - kept) / (1 - r * kept);
		}
	}
}

void cam_rays_waves(const struct cam_rays *c, double x, int ripple, double *ext, double *abs, double *pr)
{
	double root = 1 / sqrt(x);
	*ext = *abs = *pr = 0;
	for (int k = 0; k < c->glories; k++) {
		const struct cam_glory *g = &c->glory[k];
		double share = ripple ? 1 - cam_share(x, x * g->u) : 1, phase = x * creal(g->path);
		if (share > 0)
			*ext += share * root / sqrt(fmax(g->slope, cbrt(g->bend * g->bend / x))) * exp(-x * cimag(g->path)) *
				(creal(g->amplitude) * cos(phase) - cimag(g->amplitude) * sin(phase));
	}
	for (int k = 0; k < c->polygons; k++) {
		const struct cam_polygon *g = &c->polygon[k];
		double share = ripple ? 1 - cam_share(x, x * g->u) : 1;
		if (share == 0)
			continue;
		double size = share * root * exp(-x * g->fade), left = g->chord == 0 ? 1 : exp(-x * g->chord);
		double co = size * cos(x * g->phase), si = size * sin(x * g->phase);
		double complex b = g->pressure[0] + g->pressure[1] * left;
		*pr += creal(b) * co - cimag(b) * si;
		for (int j = 0; j < 2 && g->chord > 0; j++) {
			double complex a = g->first[j] + g->later[j] * (left / (1 - g->kept[j] * left));
			*abs += creal(a) * co - cimag(a) * si;
		}
	}
}

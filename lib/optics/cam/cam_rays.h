/* cam_rays - what rays do for the efficiencies of a large sphere: the mean over all of them, and the waves of those that meet again. They
 * depend on m alone; a size costs little. */
#ifndef OPTICS_CAM_RAYS_H
#define OPTICS_CAM_RAYS_H

#include "optics/goa/impact_quadrature.h"

#include "base/cmplx.h"

#define CAM_PANELS 6       /* of the quadrature over the impact parameter, for the mean */
#define CAM_ORDER 30       /* highest order of glories, most sides of polygons */
#define CAM_GLORIES 64
#define CAM_POLYGONS 128

/* Rays of one impact parameter: where they go. */
struct cam_pencil {
	double complex out, turn;       /* e^(i Theta_1); e^(i turn) of another chord */
	double off;                     /* cos Theta_0 */
};

/* A ray that leaves forward, but off the axis. */
struct cam_glory {
	double complex amplitude, path; /* of Q_ext, over x^(-1/2); over x */
	double u, slope, bend;          /* Theta', Theta'': a caustic where the first is small */
};

/* A ray that closes on itself after some chords: the orders that differ by so many leave together, whatever their direction. */
struct cam_polygon {
	double u, phase, fade;          /* over x: the way round, Im of the way round */
	double complex pressure[2];     /* of Q_pr, over x^(-1/2), of order 0 and of those after it */
	double complex first[2], later[2]; /* of Q_abs: the same, by polarisation, later ones before they are damped */
	double kept[2], chord;          /* |I_j|^2; attenuation along a chord over x */
};

struct cam_rays {
	int pencils, glories, polygons;
	struct impact impact[IMPACT_NODES(CAM_PANELS)];
	struct cam_pencil pencil[IMPACT_NODES(CAM_PANELS)];
	struct cam_glory glory[CAM_GLORIES];
	struct cam_polygon polygon[CAM_POLYGONS];
};

void cam_rays_find(double complex m, struct cam_rays *out);

/* cam_rays_mean - absorption and radiation pressure, without any interference. */
void cam_rays_mean(const struct cam_rays *c, double x, double *abs, double *pr);

/* cam_rays_waves - what interference adds to extinction and to these, each ~ x^(-1/2). ripple: less the share of the waves that are summed
 * one by one (cam_share). */
void cam_rays_waves(const struct cam_rays *c, double x, int ripple, double *ext, double *abs, double *pr);

#endif

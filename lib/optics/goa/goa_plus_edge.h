/* goa_plus_edge - the partial waves near the edge of a large sphere (and near the critical angle of a bubble), where rays fail, as a sum.
 *
 * The windows of goa_plus_windows.h say how much of each wave; there may be two strips of waves, with rays alone between. Near an axis
 * waves are added one by one, farther away by a nonuniform Fourier transform. The coefficients are those of debye_waves.h.
 * Source: Nussenzveig 1992, Diffraction Effects in Semiclassical Scattering; Hilb's forms of angular functions, Szego, Orthogonal
 * Polynomials, 8.21. */
#ifndef OPTICS_GOA_PLUS_EDGE_H
#define OPTICS_GOA_PLUS_EDGE_H

#include "optics/goa/goa_plus_windows.h"
#include "optics/goa/rays.h"
#include "optics/numerics/nufft.h"

#include <stddef.h>

struct goa_plus_edge_strip {
	size_t room;               /* waves that there is memory for */
	int first, n;              /* waves l = first .. first + n - 1 */
	double about;              /* l + 1/2 where most of the light is */
	/* coefficients of S1 + S2 (the disc's wave removed; not removed) and S1 - S2, re, im */
	double *sum, *sum_behind, *difference;
	/* of the same over sqrt(l + 1/2); size 0: no angle is far from both axes for such long waves */
	struct nufft nufft;
};

struct goa_plus_edge {
	double x;
	double complex m;
	int disc;                  /* the disc diffracts waves 1 .. disc */
	double lost;               /* of all waves in the strips, sum (2l + 1)(1 - |S|^2)/2 */
	struct goa_plus_windows windows;
	int n;
	struct goa_plus_edge_strip strip[2];
};

#define GOA_PLUS_EDGE_FAR 16        /* (l + 1/2) sin theta from which on angular functions are cosines */

struct goa_plus_lanes;

/* goa_plus_edge_set - windows and waves for a size. e is zero-initialised, or from a size before, whose memory is used again.
 * Returns 0, or -1 when memory ran out. */
int goa_plus_edge_set(const struct goa_plus_lanes *lanes, struct goa_plus_edge *e, double x, double complex m);
void goa_plus_edge_free(struct goa_plus_edge *e);

/* What waves need to know about GOA_WIDTH neighbouring angles. */
struct goa_plus_edge_packet {
	double theta[GOA_WIDTH], folded[GOA_WIDTH];     /* rad; from the nearer axis */
	double behind[GOA_WIDTH];                        /* 1 beyond 90 degrees, else 0 */
	double root[GOA_WIDTH];                          /* sqrt(2/(pi sin theta)) */
	double plus[GOA_WIDTH], minus[GOA_WIDTH];       /* c of debye_order.h, of S1 + S2 and S1 - S2 */
	double bend[GOA_WIDTH], slope[GOA_WIDTH], slant[GOA_WIDTH]; /* of the disc: 1/theta - cot theta, 1/sin, 1/(1 + cos) */
	double sine;                                      /* the least */
};

/* goa_plus_edge_aim - packets for theta[n], degrees in [0, 180]; the last is filled up with its last angle. out has room for
 * (n + GOA_WIDTH - 1)/GOA_WIDTH. */
void goa_plus_edge_aim(int n, const double *theta, struct goa_plus_edge_packet *out);

/* goa_plus_edge_start - pi_l and pi_l - pi_(l-1) at an angle in [0, pi/2] by uniform Bessel forms, from where recurrences go on
 * upward. */
void goa_plus_edge_start(int l, double theta, double *p, double *v);

/* goa_plus_edge_disc - sum of (2l+1)/(l(l+1)) (pi_l + tau_l), l = 1 .. n, the amplitude S1 + S2 of a disc, at theta (rad), by Hilb's
 * forms. */
double goa_plus_edge_disc(int n, double theta);

#endif

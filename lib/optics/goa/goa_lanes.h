/* goa_lanes - the loops of GOA and GOA+ that take the time, each over GOA_WIDTH angles side by side; one source, compiled for
 * each processor. All builds give the same bits. */
#ifndef OPTICS_GOA_LANES_H
#define OPTICS_GOA_LANES_H

#include "base/cpu.h"
#include "optics/goa/goa_rays.h"
#include "optics/goa/goa_plus_rays.h"

struct goa_lanes {
	/* rays of GOA: s += S1 re, im, S2 re, im of n packets at size x, cap[p] for each order */
	void (*coherent)(const struct goa_packet *k, size_t n, double x, const struct goa_cap *cap, double s[4][GOA_WIDTH]);
	/* the same without interference: s += |S1|^2, |S2|^2 */
	void (*incoherent)(const struct goa_packet *k, size_t n, double x, const struct goa_cap *cap, double s[2][GOA_WIDTH]);
	/* amplitude of diffraction, x^2 J1(x sin theta)/(x sin theta) */
	void (*diffraction)(const struct goa_angles *k, double x, double d[GOA_WIDTH]);
	/* rays of GOA+: s += S1 re, im, S2 re, im of n packets */
	void (*plus)(const struct goa_plus_packet *k, size_t n, const struct goa_plus_edge *e, double s[4][GOA_WIDTH]);
	/* waves of GOA+ and the disc they leave: s += the same at the angles of a packet */
	void (*waves)(const struct goa_plus_edge *e, const struct goa_plus_edge_packet *k, double s[4][GOA_WIDTH]);
	/* coefficients of the waves of a strip, whose number and room are set; W_p is only, or without that, the edge's. Returns
	 * what these waves lose by absorption, sum (2l + 1) (1 - |S|^2)/2, where all of each is in the strip. */
	double (*coefficients)(const struct goa_plus_edge *e, const struct window *only, struct goa_plus_edge_strip *strip);
	/* efficiency of absorption: u (1 - |S|^2) over all impact parameters, ripple averaged where S is not summed */
	double (*absorption)(const struct goa_plus_edge *e);
};

CPU_DECLARE(const struct goa_lanes, goa_lanes);

/* goa_lanes - the build for this processor, by cpu_level. */
const struct goa_lanes *goa_lanes(void);

#endif

/* goa_plus_lanes - the loops of GOA+ that take the time, as goa_lanes.h those of GOA. */
#ifndef OPTICS_GOA_PLUS_LANES_H
#define OPTICS_GOA_PLUS_LANES_H

#include "base/cpu.h"
#include "optics/goa/goa_plus_rays.h"

struct goa_plus_lanes {
	/* rays: s += S1 re, im, S2 re, im of n packets */
	void (*rays)(const struct goa_plus_packet *k, size_t n, const struct goa_plus_edge *e, double s[4][GOA_WIDTH]);
	/* waves near the edge and the disc they leave: s += the same at the angles of a packet */
	void (*waves)(const struct goa_plus_edge *e, const struct goa_plus_edge_packet *k, double s[4][GOA_WIDTH]);
	/* coefficients of the waves of a strip, whose number and room are set; W_p is only, or without that, the edge's. Returns
	 * what these waves lose by absorption, sum (2l + 1) (1 - |S|^2)/2, where all of each is in the strip. */
	double (*coefficients)(const struct goa_plus_edge *e, const struct goa_plus_window *only, struct goa_plus_edge_strip *strip);
	/* efficiency of absorption: u (1 - |S|^2) over all impact parameters, ripple averaged where S is not summed */
	double (*absorption)(const struct goa_plus_edge *e);
};

CPU_DECLARE(const struct goa_plus_lanes, goa_plus_lanes);

/* goa_plus_lanes - the build for this processor, by cpu_level. */
const struct goa_plus_lanes *goa_plus_lanes(void);

#endif

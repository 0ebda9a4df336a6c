/* goa_lanes - the loops of GOA that take the time, each over GOA_WIDTH angles side by side; one source, compiled for each processor. All
 * builds give the same bits. */
#ifndef OPTICS_GOA_LANES_H
#define OPTICS_GOA_LANES_H

#include "base/cpu.h"
#include "optics/goa/goa_rays.h"

struct goa_lanes {
	/* rays of GOA: s += S1 re, im, S2 re, im of n packets at size x, cap[p] for each order */
	void (*coherent)(const struct goa_packet *k, size_t n, double x, const struct goa_cap *cap, double s[4][GOA_WIDTH]);
	/* the same without interference: s += |S1|^2, |S2|^2 */
	void (*incoherent)(const struct goa_packet *k, size_t n, double x, const struct goa_cap *cap, double s[2][GOA_WIDTH]);
	/* the same of rays and diffraction d, s =, and with the interference of what is slow: with x the phases of such a pair part
	 * by less than fastest, in pi/2; from half of that on less and less of it counts. room[n] */
	void (*blurred)(const struct goa_packet *k, size_t n, const struct goa_angles *angles, const double d[GOA_WIDTH], double x,
	                const struct goa_cap *cap, double fastest, double (*room)[GOA_WIDTH], double s[2][GOA_WIDTH]);
	/* amplitude of diffraction, x^2 J1(x sin theta)/(x sin theta) */
	void (*diffraction)(const struct goa_angles *k, double x, double d[GOA_WIDTH]);
};

CPU_DECLARE(const struct goa_lanes, goa_lanes);

/* goa_lanes - the build for this processor, by cpu_level. */
const struct goa_lanes *goa_lanes(void);

#endif

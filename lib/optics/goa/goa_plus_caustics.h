/* goa_plus_caustics - rainbows and glories of goa_plus: two rays that meet, as one uniform form.
 *
 * Near a rainbow two rays of one order make an Airy pair (Chester, Friedman and Ursell 1957, Proc. Camb. Phil. Soc. 53, 599), near a
 * glory, an axis reached off-centre, a Bessel pair (Berry 1969, J. Phys. B 2, 381). Rays alone serve from a size on that each pair says (`below'); pairs that serve no size above that where all is
 * waves (goa_plus_windows.h) are left out. */
#ifndef OPTICS_GOA_PLUS_CAUSTICS_H
#define OPTICS_GOA_PLUS_CAUSTICS_H

#include "optics/goa/goa_plus_edge.h"
#include "optics/goa/rays.h"

#define GOA_PLUS_ABSORBED 25    /* e^-25 of a ray is nothing */

/* The uniform (Airy) form of a rainbow: A and B the rays inside and outside of the rainbow's, complex on its dark side. */
struct goa_plus_rainbow {
	int angle, p;
	double below, sine, u;                 /* sine of the angle, u of the rainbow's ray */
	double path, zeta;                     /* in x and x^(2/3) */
	double ua, ub;                         /* of A and B; on the dark side, of the rainbow's ray */
	double complex a[2], b[2], over_rho;   /* amplitudes without 1/sqrt(sine), in x^(7/6); i/rho in x^(-1/3) */
	double complex fade_a, fade_b;         /* i times the path that absorption adds */
};

/* The uniform (Bessel) form of a glory. */
struct goa_plus_glory {
	int angle, p, back;
	double below, path, z, u;
	/* of (S1+S2)/2 and (S1-S2)/2, in x^(3/2): rays turned one way and the other, added and subtracted */
	double complex even[2], odd[2];
	double fade;
};

struct goa_plus_caustics {
	int rainbows, glories;
	struct goa_plus_rainbow *rainbow;
	struct goa_plus_glory *glory;
};

/* One order in one direction. */
struct goa_plus_direction {
	double complex m;
	double theta, sine;        /* degrees */
	int angle, p;
	struct caustic caustic;
};

/* goa_plus_caustics_reach - how far from a rainbow, in tau, its pair may count at any size. */
double goa_plus_caustics_reach(const struct caustic *c);

/* goa_plus_caustics_rainbow - the pair of a rainbow in a direction with tau, on either side of it.
 * Given: eighths  of the ray inside the rainbow's, whose Theta' < 0, without its sgn term (rays.h)
 *        *from    into it the size from which on rays do without, 0 where none needs the pair
 * Returns 0, or -1 when memory ran out. */
int goa_plus_caustics_rainbow(struct goa_plus_caustics *c, const struct goa_plus_direction *d, double tau, int eighths, double *from);

/* goa_plus_caustics_glory - the same for a ray with tau = side from_axis + 2 pi turns on branch b; *from is 0 also where the direction is
 * far from an axis, or there is no other ray. A pair is found for either of its rays, and kept once. */
int goa_plus_caustics_glory(struct goa_plus_caustics *c, const struct goa_plus_direction *d, const struct branch *b, int side, int turns,
                            const struct ray *r, double *from);

/* goa_plus_caustics_add - S1, S2 (+=) of the pairs, for the size and windows of an edge. */
void goa_plus_caustics_add(const struct goa_plus_caustics *c, const struct goa_plus_edge *e, double complex *s1, double complex *s2);

void goa_plus_caustics_free(struct goa_plus_caustics *c);

#endif

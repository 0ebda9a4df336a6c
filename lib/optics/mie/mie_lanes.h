/* mie_lanes - partial waves of many spheres side by side: a block of spheres, the sums over their coefficients, and a build of the
 * loop for each processor. Each sphere's result depends on itself alone, and is the same in every build. */
#ifndef OPTICS_MIE_LANES_H
#define OPTICS_MIE_LANES_H

#define MIE_BLOCK 32           /* spheres side by side */
#define MIE_BLOCK_TERMS 10000  /* of these, so that a block's room stays within 16 MB */

#include "base/cpu.h"
#include "optics/mie/mie.h"

#include <stddef.h>

#define CHI_MAX 1e120          /* beyond, a_l and b_l are below 1e-240 and chi^2 would overflow: they count as 0 */
#define MIE_NEAR 0.005         /* |m - 1| below which coefficients are taken from differences */

static inline int mie_near(double complex m)
{
	return (creal(m) - 1) * (creal(m) - 1) + cimag(m) * cimag(m) < MIE_NEAR * MIE_NEAR;
}

/* Sums over l = 1 .. terms. */
struct mie_sums {
	double ext, sca;           /* sum (2l+1) Re(a + b), (2l+1) (|a|^2 + |b|^2) */
	double asym;               /* sum l(l+2)/(l+1) Re(a_l a*_(l+1) + b_l b*_(l+1)) + (2l+1)/(l(l+1)) Re(a_l b*_l) */
	double back_re, back_im;   /* sum (-1)^l (2l+1) (a - b), but for the sign */
	double moved;              /* how far rounding may move these on narrow resonances */
	double broad;              /* what it does on broad ones, as an error relative to ext in units of 2 DBL_EPSILON */
};

/* Of coefficients a[n+1], b[n+1]; lossless: sca is not taken. */
void mie_sums_of(int lossless, int n, const double complex *a, const double complex *b, struct mie_sums *sums);

/* Efficiencies, and the estimate of their error, of sums at size parameter x. */
struct efficiencies mie_sums_efficiencies(double x, int lossless, const struct mie_sums *s);
double mie_sums_error(double x, int lossless, const struct mie_sums *s);

struct mie_block {
	int absorbs, near;         /* some Im m > 0, else m_im is not looked at; all |m - 1| < MIE_NEAR */
	double x[MIE_BLOCK], m_re[MIE_BLOCK], m_im[MIE_BLOCK];
	int terms[MIE_BLOCK];      /* of each, mie_terms */
	double *room;              /* mie_block_room(largest of terms) doubles, aligned to 64 bytes */
	struct mie_sums sums[MIE_BLOCK];
};

#define mie_block_room(terms) ((6 * MIE_BLOCK + 8) * ((size_t)(terms) + 16))    /* x 8 bytes: a multiple of 64 */

/* Orders first .. first + count - 1 of one sphere side by side: arrays begin with the first. They are read and written up to MIE_SPARE
 * beyond the last. */
#define MIE_CHUNK 512          /* at most count of these */
#define MIE_SPARE 8

struct mie_row {
	int absorbs, near, first, count;
	int weighted;                         /* coefficients times 2l+1, as the sums take them */
	double x, m_re, m_im, beyond;
	const double *psi, *chi, *p;          /* these from first - 1; and what follows as in mie_downward.h, struct downward_orders */
	const double *ex, *er, *ei, *size, *re, *im;
	double *a_re, *a_im, *b_re, *b_im;    /* before them stand those of first - 1, or 0 */
	double *sca;                          /* (|a|^2 + |b|^2) times as much, absorbing spheres only */
};

#define MIE_ANGLES 32

/* What the sums at an angle need of order l. */
struct mie_factors {
	double rise, twice;        /* (l+1)/l, 2/l */
	double side[2][4];         /* Re s, Im s, Re d, Im d in front, behind: with the factor (2l+1)/(l+1) */
};
enum { MIE_FRONT = 1, MIE_BEHIND = 2, MIE_PAIR = 3 };

/* Sums at MIE_ANGLES angles over the orders so far, and pi_l of the next with its difference from the one before. */
struct mie_angles {
	double pi[MIE_ANGLES], rise[MIE_ANGLES];
	double sum[8][MIE_ANGLES];
};

struct mie_lanes {
	void (*block)(struct mie_block *b);
	/* coefficients of a row, from psi .. im */
	void (*waves)(const struct mie_row *r);
	/* sums += those of a row, from its weighted coefficients, in order: the same bits as in a block. For moved and broad from x
	 * .. beyond and chi, too; x = 0: without these */
	void (*sums)(const struct mie_row *r, struct mie_sums *sums);
	/* Sums over l of s_l (pi_l + tau_l)/l and d_l (pi_l - tau_l)/l at MIE_ANGLES angles in [0, 90] deg given by c = 1 - cos theta.
	 * Given:    k[n], the next orders; sides: with the factors for angles in front, for those behind, or first with these, then with those;
	 *           a, before the first order pi and rise are 1, sums 0
	 * Returned: a->sum[4, or 8 of a pair]: real and imaginary part of the one, then of the other sum */
	void (*angles)(int n, const struct mie_factors *k, int sides, const double *c, struct mie_angles *a);
};

CPU_DECLARE(const struct mie_lanes, mie_lanes);

/* mie_lanes - the build for this processor, by cpu_level. */
const struct mie_lanes *mie_lanes(void);

/* mie_one - a sphere of n terms by itself, its orders side by side: *q and *error as of mie_many, to the last bit; 0, or -1 when
 * memory ran out. */
int mie_one(const struct mie_lanes *lanes, double x, double complex m, int n, struct efficiencies *q, double *error);

#endif

/* nufft - sums of exponentials sum_k c_k e^(i k phi) over a strip of waves at any angle phi, in time independent of their
 * number: a Fourier transform on a grid finer than needed by half at least, once, and interpolation by a smooth kernel at each
 * angle.
 *
 * Source: nonuniform fast Fourier transform of type 2, kernel exp(b (sqrt(1 - z^2) - 1)) of Barnett, Magland and af Klinteberg
 * 2019; 8 points wide, error below 1e-5 of the coefficients' root sum of squares. */
#ifndef OPTICS_NUFFT_H
#define OPTICS_NUFFT_H

#define NUFFT_TAPS 8
#define NUFFT_SHAPE 16.3        /* b */
#define NUFFT_SUMS 4            /* different sums side by side */

/* Values of the sums on a grid of size angles (a power of 2), over one turn; in each row the real parts of all, then the
 * imaginary ones. NUFFT_TAPS - 1 rows are repeated at the end, and before the beginning. */
struct nufft {
	int size;
	double *row;                   /* row[8 j + ..] belongs to 2 pi j/size; j may be -7 .. size + 6 */
	double *memory, *room;         /* kept from one transform to the next */
	int most;
};

/* nufft_set - from c[n] of each sum: coefficient[sum][2 k], [2 k + 1], where k stands for the frequency k - n/2. NULL sums are
 * 0. s is zero-initialised, or from a transform before. Returns 0, or -1 when memory ran out. */
int nufft_set(struct nufft *s, int n, const double *const coefficient[NUFFT_SUMS]);
void nufft_free(struct nufft *s);

#endif

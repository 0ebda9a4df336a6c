/* legendre - from Legendre polynomials to cosines.
 *
 *     P_n(cos theta) = (2/pi) sum' L((n-k)/2) L((n+k)/2) cos k theta,   k = n, n-2, .., >= 0, half the term at k = 0,
 *     L(z) = Gamma(z + 1/2) / Gamma(z + 1)
 *
 * so the coefficients are products with a triangular matrix, whose element is smooth away from the diagonal. Blocks of it there
 * are replaced by interpolation in NODES Chebyshev points of rows and columns, blocks of twice the size at every level (Alpert
 * and Rokhlin 1991; nested, as in the fast multipole method): O(n). A block's distance to its partner is at least its size,
 * which makes the interpolation converge as 5.8^-NODES.
 *
 * Even and odd orders do not mix: order n = 2i + p stands at i, and a row of 8 holds 4 series for p = 0 and 1. */
#ifndef OPTICS_KERN_LEGENDRE_H
#define OPTICS_KERN_LEGENDRE_H

#include "optics/numerics/kern/wide.h"

#include <math.h>
#include <stdlib.h>

#define NODES 20      /* 5.8^-20 = 5e-16 */
#define LEAF 32       /* rows of the smallest block */
#define PI_L 3.14159265358979323846264338327950288L

/* L(z) for z >= 16: the ratio of Gamma functions about z + 1/4 (Tricomi and Erdelyi 1951; errors below 1e-16). */
static inline double gamma_ratio(double z)
{
	double w = 1 / (z + 0.25), q = w * w;
	double more = 671.0 / 524288 - q * (180323.0 / 134217728 - q * 20898423.0 / 8589934592);
	return sqrt(w) * (1 - q * (1.0 / 64 - q * (21.0 / 8192 - q * more)));
}

struct fmm {
	int rows, levels;
	double *ratio;                            /* L(0 .. 2 rows) */
	double node[NODES];                       /* on [0, 1] */
	double leaf[LEAF][NODES][2];              /* cardinal functions at i/LEAF and (i + 1/2)/LEAF */
	double half[2][NODES][NODES];             /* [side][child's node][parent's]: those of a block at the nodes of its halves */
	double *moment, *local;                   /* [block][NODES][8], leaves first, then the coarser levels */
	size_t first[32];                         /* block where a level begins */
	int blocks[32];
};

/* Cardinal functions of the Chebyshev nodes on [0, 1], barycentric. In long double: what the tables are off by comes again in
 * every block, and the sum of these errors would show far from the forward peak where nothing else is. */
struct nodes {
	long double at[NODES], weight[NODES];
};

static void cardinals(const struct nodes *n, double t, double value[NODES])
{
	long double part[NODES], sum = 0;
	for (int m = 0; m < NODES; m++)
		sum += part[m] = n->weight[m] / (t - n->at[m]);
	for (int m = 0; m < NODES; m++)
		value[m] = (double)(part[m] / sum);
}

static void fmm_tables(struct fmm *f)
{
	struct nodes n;
	double value[NODES];
	for (int m = 0; m < NODES; m++) {
		long double a = PI_L * (m + 0.5L) / NODES;
		n.at[m] = 0.5L - 0.5L * cosl(a);
		n.weight[m] = (m % 2 ? -1 : 1) * sinl(a);
		f->node[m] = (double)n.at[m];
	}
	for (int i = 0; i < LEAF; i++)
		for (int p = 0; p < 2; p++) {
			cardinals(&n, (i + 0.5 * p) / LEAF, value);
			for (int m = 0; m < NODES; m++)
				f->leaf[i][m][p] = value[m];
		}
	for (int side = 0; side < 2; side++)
		for (int m = 0; m < NODES; m++)
			cardinals(&n, (f->node[m] + side) / 2, f->half[side][m]);
	f->ratio[0] = sqrt(M_PI);
	for (int i = 1; i < 2 * f->rows + 2; i++)
		f->ratio[i] = i < 32 ? f->ratio[i - 1] * (i - 0.5) / i : gamma_ratio(i);
}

static double *of_block(const struct fmm *f, double *all, int level, int b)
{
	return all + (f->first[level] + (size_t)b) * NODES * 8;
}

static void upward(const struct fmm *f, const double *x)
{
	for (int b = 0; b < f->blocks[0]; b++) {
		int end = f->rows - b * LEAF < LEAF ? f->rows - b * LEAF : LEAF;
		double *moment = f->moment + (size_t)b * NODES * 8;
		for (int m = 0; m < NODES; m++) {
			wide sum = { 0 };
			for (int i = 0; i < end; i++)
				sum += wide_pair(f->leaf[i][m][0], f->leaf[i][m][1]) * wide_load(x + (size_t)(b * LEAF + i) * 8);
			wide_store(moment + 8 * m, sum);
		}
	}
	for (int l = 1; l < f->levels; l++)
		for (int b = 0; b < f->blocks[l]; b++)
			for (int m = 0; m < NODES; m++) {
				const double *child = of_block(f, f->moment, l - 1, 2 * b);
				wide sum = { 0 };
				for (int side = 0; side < 2 && 2 * b + side < f->blocks[l - 1]; side++, child += NODES * 8)
					for (int k = 0; k < NODES; k++)
						sum += f->half[side][k][m] * wide_load(child + 8 * k);
				wide_store(of_block(f, f->moment, l, b) + 8 * m, sum);
			}
}

/* Block b takes from blocks b+2 and, if b is even, b+3: nearer ones are left to the finer level, farther
 * ones are the coarser's. */
static void across(const struct fmm *f, int l)
{
	double size = LEAF * ldexp(1, l), toeplitz[2][NODES][NODES], hankel[NODES];
	for (int d = 0; d < 2; d++)
		for (int t = 0; t < NODES; t++)
			for (int s = 0; s < NODES; s++)
				toeplitz[d][t][s] = gamma_ratio(size * (d + 2 + f->node[s] - f->node[t]));
	for (int b = 0; b < f->blocks[l]; b++)
		for (int d = 0; d < (b % 2 ? 1 : 2) && b + d + 2 < f->blocks[l]; d++) {
			const double *moment = of_block(f, f->moment, l, b + d + 2);
			double *local = of_block(f, f->local, l, b);
			for (int t = 0; t < NODES; t++) {
				wide sum = wide_load(local + 8 * t);
				for (int s = 0; s < NODES; s++)
					hankel[s] = gamma_ratio(size * (2 * b + d + 2 + f->node[s] + f->node[t])) * toeplitz[d][t][s];
				for (int s = 0; s < NODES; s++)
					sum += hankel[s] * wide_load(moment + 8 * s);
				wide_store(local + 8 * t, sum);
			}
		}
}

static void downward(const struct fmm *f, const double *x, double *y)
{
	for (int l = f->levels - 1; l >= 0; l--) {
		across(f, l);
		for (int b = 0; l + 1 < f->levels && b < f->blocks[l]; b++)
			for (int m = 0; m < NODES; m++) {
				const double *parent = of_block(f, f->local, l + 1, b / 2);
				double *local = of_block(f, f->local, l, b) + 8 * m;
				wide sum = wide_load(local);
				for (int k = 0; k < NODES; k++)
					sum += f->half[b % 2][m][k] * wide_load(parent + 8 * k);
				wide_store(local, sum);
			}
	}
	for (int j = 0; j < f->rows; j++) {
		int b = j / LEAF, end = (b + 2) * LEAF < f->rows ? (b + 2) * LEAF : f->rows;
		const double *local = of_block(f, f->local, 0, b);
		wide sum = { 0 };
		for (int m = 0; m < NODES; m++)
			sum += wide_pair(f->leaf[j % LEAF][m][0], f->leaf[j % LEAF][m][1]) * wide_load(local + 8 * m);
		for (int i = j; i < end; i++)
			sum += f->ratio[i - j] * wide_pair(f->ratio[i + j], f->ratio[i + j + 1]) * wide_load(x + (size_t)i * 8);
		wide_store(y + (size_t)j * 8, sum * (2 / M_PI));
	}
	wide_store(y, wide_load(y) * wide_pair(0.5, 1));
}

/* legendre_cosines - cosine coefficients y[rows][8] of x[rows][8], orders 0 .. 2 rows - 1; 0, or -1 when memory ran out. */
static int legendre_cosines(int rows, const double *x, double *y)
{
	struct fmm f = { .rows = rows };
	size_t blocks = 0;
	for (int n = (rows + LEAF - 1) / LEAF; ; n = (n + 1) / 2) {
		f.first[f.levels] = blocks;
		f.blocks[f.levels++] = n;
		blocks += (size_t)n;
		if (n <= 2)
			break;
	}
	f.ratio = malloc((2 * (size_t)rows + 2) * sizeof *f.ratio);
	f.moment = calloc(2 * blocks * NODES * 8, sizeof *f.moment);
	int failed = !f.ratio || !f.moment;
	if (!failed) {
		f.local = f.moment + blocks * NODES * 8;
		fmm_tables(&f);
		upward(&f, x);
		downward(&f, x, y);
	}
	free(f.ratio);
	free(f.moment);
	return failed ? -1 : 0;
}

#endif

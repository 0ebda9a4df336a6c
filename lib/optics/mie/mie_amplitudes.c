#include "optics/mie/mie.h"
#include "optics/mie/mie_lanes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An angle folded into the front half: its distance from the nearer axis, and where it comes from, -1 where from none. */
struct folded {
	double t;
	int front, behind;
};

static int side(const struct folded *f) { return (f->front >= 0 ? MIE_FRONT : 0) | (f->behind >= 0 ? MIE_BEHIND : 0); }

static int by_angle(const void *a, const void *b)
{
	const struct folded *p = a, *q = b;
	return (p->t > q->t) - (p->t < q->t);
}

/* Those of n angles that lie in front, or behind, from their axis on; sorted only where they do not come so. Returns how many. */
static int half(int n, const double *theta, int behind, struct folded *f)
{
	int count = 0, sorted = 1;
	for (int k = 0; k < n; k++) {
		int i = behind ? n - 1 - k : k;
		if ((theta[i] > 90) != behind)
			continue;
		f[count] = behind ? (struct folded){ 180 - theta[i], -1, i } : (struct folded){ theta[i], i, -1 };
		sorted &= count == 0 || f[count - 1].t <= f[count].t;
		count++;
	}
	if (!sorted)
		qsort(f, (size_t)count, sizeof *f, by_angle);
	return count;
}

/* Fold n angles; where one lies behind as far as another in front, both are one. First these pairs, then what is only behind, then only
 * in front. f[2 n]; returns how many are left. */
static int fold(int n, const double *theta, struct folded *f)
{
	struct folded *all = f + n;
	int front = half(n, theta, 0, all), left = 0;
	half(n, theta, 1, all + front);
	for (int i = 0, j = front; i < front && j < n;) {
		if (all[i].t == all[j].t) {
			all[i++].behind = all[j].behind;
			all[j++].behind = -1;
		} else if (all[i].t < all[j].t) {
			i++;
		} else {
			j++;
		}
	}
	for (int which = MIE_PAIR; which >= MIE_FRONT; which--)
		for (int i = 0; i < n; i++)
			if (side(&all[i]) == which)
				f[left++] = all[i];
	return left;
}

/* Where blocks of up to MIE_ANGLES angles of one side begin, and the end; returns how many blocks. */
static int divide(int n, const struct folded *f, int *begin)
{
	int blocks = 0;
	for (int i = 0; i < n; i++)
		if (i == 0 || i - begin[blocks - 1] == MIE_ANGLES || side(&f[i]) != side(&f[i - 1]))
			begin[blocks++] = i;
	begin[blocks] = n;
	return blocks;
}

/* S1 + S2 = sum s (pi + tau), S1 - S2 = sum d (pi - tau) with s = a + b, d = a - b in front. Behind 90 deg, with theta' = 180 - theta,
 * pi + tau becomes (-1)^(l-1) (pi - tau): s becomes (-1)^(l-1) d, d the like of s, and the two sums change places. Of n orders. */
static void factors(int first, int n, const double complex *a, const double complex *b, struct mie_factors *k)
{
	for (int l = first; l < first + n; l++) {
		double w = (2.0 * l + 1) / (l + 1.0), sign = l % 2 ? w : -w;
		double complex s = a[l] + b[l], d = a[l] - b[l];
		k[l - first] = (struct mie_factors){ 1 + 1.0 / l, 2.0 / l, { { w * creal(s), w * cimag(s), w * creal(d), w * cimag(d) },
			{ sign * creal(d), sign * cimag(d), sign * creal(s), sign * cimag(s) } } };
	}
}

static void amplitude(double (*sum)[MIE_ANGLES], int i, int behind, double complex *s1, double complex *s2)
{
	double complex u = CMPLX(sum[0][i], sum[1][i]), w = CMPLX(sum[2][i], sum[3][i]);
	*s1 = (u + w) / 2;
	*s2 = (behind ? w - u : u - w) / 2;
}

/* One block of angles and what is known of it. */
struct block {
	const struct folded *own;
	int n, which;
	double c[MIE_ANGLES];
	struct mie_angles at;
};

static void begin_block(struct block *b, const struct folded *own, int n)
{
	memset(b, 0, sizeof *b);
	b->own = own;
	b->n = n;
	b->which = side(own);
	for (int i = 0; i < MIE_ANGLES; i++)
		b->at.pi[i] = b->at.rise[i] = 1;
	for (int i = 0; i < n; i++) {
		double h = sin(own[i].t * (M_PI / 360));
		b->c[i] = 2 * h * h;
	}
}

static void end_block(struct block *b, double complex *s1, double complex *s2)
{
	for (int i = 0; i < b->n; i++) {
		const struct folded *own = &b->own[i];
		if (b->which & MIE_FRONT)
			amplitude(b->at.sum, i, 0, &s1[own->front], &s2[own->front]);
		if (b->which & MIE_BEHIND)
			amplitude(b->which == MIE_PAIR ? b->at.sum + 4 : b->at.sum, i, 1, &s1[own->behind], &s2[own->behind]);
	}
}

/* Factors of some orders at a time serve some blocks at a time: memory follows neither the orders nor the angles. */
#define ORDERS 8192
#define BLOCKS 1024

int mie_amplitudes(int n, const double complex *a, const double complex *b, int ntheta, const double *theta,
                   double complex *s1, double complex *s2)
{
	struct mie_factors *k = malloc(ORDERS * sizeof *k);
	struct folded *f = malloc((2 * (size_t)ntheta + 1) * sizeof *f);
	int *begin = malloc(((size_t)ntheta + 1) * sizeof *begin);    /* a block an angle at most */
	const struct mie_lanes *lanes = mie_lanes();
	int blocks = f && begin ? divide(fold(ntheta, theta, f), f, begin) : 0, most = blocks < BLOCKS ? blocks : BLOCKS;
	struct block *block = malloc(((size_t)most + 1) * sizeof *block);
	int bad = !k || !f || !begin || !block;
	for (int from = 0; !bad && from < blocks; from += BLOCKS) {
		int some = blocks - from < BLOCKS ? blocks - from : BLOCKS;
		for (int i = 0; i < some; i++)
			begin_block(&block[i], f + begin[from + i], begin[from + i + 1] - begin[from + i]);
		for (int l = 1; l <= n; l += ORDERS) {
			int orders = n - l < ORDERS ? n - l + 1 : ORDERS;
			factors(l, orders, a, b, k);
#pragma omp parallel for schedule(dynamic) if ((double)orders * some * MIE_ANGLES > 1e6)
			for (int i = 0; i < some; i++)
				lanes->angles(orders, k, block[i].which, block[i].c, &block[i].at);
		}
		for (int i = 0; i < some; i++)
			end_block(&block[i], s1, s2);
	}
	free(block);
	free(begin);
	free(k);
	free(f);
	return bad ? -1 : 0;
}

int mie_terms_enough(int n, const double complex *a, const double complex *b, double tolerance)
{
	double all = 0, rest = 0;
	if (tolerance <= 0)
		return n;
	for (int l = n; l >= 1; l--)
		all += (2.0 * l + 1) * (norm2(a[l]) + norm2(b[l]));
	for (; n > 1; n--) {
		rest += (2.0 * n + 1) * (norm2(a[n]) + norm2(b[n]));
		if (rest > tolerance * tolerance * all)
			break;
	}
	return n;
}

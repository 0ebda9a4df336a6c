#include "optics/mie/mie.h"
#include "optics/mie/mie_lanes.h"

#include <math.h>
#include <stdlib.h>

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
 * pi + tau becomes (-1)^(l-1) (pi - tau): s becomes (-1)^(l-1) d, d the like of s, and the two sums change places. */
static void factors(int n, const double complex *a, const double complex *b, struct mie_factors *k)
{
	for (int l = 1; l <= n; l++) {
		double w = (2.0 * l + 1) / (l + 1.0), sign = l % 2 ? w : -w;
		double complex s = a[l] + b[l], d = a[l] - b[l];
		k[l] = (struct mie_factors){ 1 + 1.0 / l, 2.0 / l, { { w * creal(s), w * cimag(s), w * creal(d), w * cimag(d) },
			{ sign * creal(d), sign * cimag(d), sign * creal(s), sign * cimag(s) } } };
	}
}

static void amplitude(double (*sum)[MIE_ANGLES], int i, int behind, double complex *s1, double complex *s2)
{
	double complex u = CMPLX(sum[0][i], sum[1][i]), w = CMPLX(sum[2][i], sum[3][i]);
	*s1 = (u + w) / 2;
	*s2 = (behind ? w - u : u - w) / 2;
}

int mie_amplitudes(int n, const double complex *a, const double complex *b, int ntheta, const double *theta,
                   double complex *s1, double complex *s2)
{
	struct mie_factors *k = malloc(((size_t)n + 1) * sizeof *k);
	struct folded *f = malloc((2 * (size_t)ntheta + 1) * sizeof *f);
	int *begin = malloc(((size_t)ntheta + 1) * sizeof *begin);    /* a block an angle at most */
	const struct mie_lanes *lanes = mie_lanes();
	if (!k || !f || !begin) {
		free(k);
		free(f);
		free(begin);
		return -1;
	}
	factors(n, a, b, k);
	int blocks = divide(fold(ntheta, theta, f), f, begin);
#pragma omp parallel for schedule(dynamic) if ((double)n * ntheta > 1e6)
	for (int block = 0; block < blocks; block++) {
		const struct folded *own = f + begin[block];
		int angles = begin[block + 1] - begin[block], which = side(own);
		double c[MIE_ANGLES] = { 0 }, sum[8][MIE_ANGLES];
		for (int i = 0; i < angles; i++) {
			double h = sin(own[i].t * (M_PI / 360));
			c[i] = 2 * h * h;
		}
		lanes->angles(n, k, which, c, sum);
		for (int i = 0; i < angles; i++) {
			if (which & MIE_FRONT)
				amplitude(sum, i, 0, &s1[own[i].front], &s2[own[i].front]);
			if (which & MIE_BEHIND)
				amplitude(which == MIE_PAIR ? sum + 4 : sum, i, 1, &s1[own[i].behind], &s2[own[i].behind]);
		}
	}
	free(begin);
	free(k);
	free(f);
	return 0;
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

#include "optics/mie/mie_resonances.h"

#include "optics/mie/mie_lanes.h"

#include <math.h>

/* |m^2 - 1| about */
static double contrast_of(double complex m)
{
	double re = creal(m), im = cimag(m);
	return fabs((re - 1) * (re + 1) - im * im) + 2 * re * im;
}

/* By how much a wave c, which has its weight, moves the sums as t moves by up to so much: by itself, and with the wave before it
 * in the one for g. */
static double moved(double weight, const double c[2], const double before[2], double move)
{
	double unit = 1 / weight, re = c[0] * unit, im = fabs(c[1]) * unit, size2 = re * re + im * im, share, turned;
	if (!(size2 > 0))
		return 0;
	if (move * move * size2 < 0.01) {    /* |c|^2 changes by less than a quarter */
		share = 1.25 * move * re * (2 * im + move * size2);
		turned = 1.25 * move * size2;
	} else {
		double u = re / size2, t = im / size2, low = t > move ? t - move : 0, near = u * u + low * low, peak = 1 / u;
		share = fmin(u * move * (2 * t + move) / (near * (u * u + t * t)), peak);
		turned = fmin(move / near, peak);
	}
	return weight * share + 2 * sqrt(before[0] * before[0] + before[1] * before[1]) * turned;
}

double mie_resonance(double x, double complex m, const struct mie_wave *w)
{
	double l = w->l, chi = w->chi, slope = (w->chi_old * x - l * chi) / (chi * x), move = MIE_OFF * x * contrast_of(m) * chi * chi;
	return moved(2 * l + 1, w->a, w->old_a, move * (slope * slope + l * (l + 1) / (x * x * norm2(m)))) +
	       moved(2 * l + 1, w->b, w->old_b, move);
}

double mie_resonances_rough(double x, int n, const double complex *a, const double complex *b)
{
	double old = -sin(x), chi = cos(x), sum = 0, ext = 0;
	for (int l = 1; l <= n && fabs(chi) < CHI_MAX; l++) {
		double next = (2.0 * l - 1) / x * chi - old;
		old = chi;
		chi = next;
		/* of whatever m, a factor of about m^2 - 1, or some times l^2/x^2 */
		double weight = 2.0 * l + 1, before = weight - 2, contrast = 3 * (l / x) * (l / x), move = MIE_OFF * x * contrast * chi * chi;
		ext += weight * (creal(a[l]) + creal(b[l]));
		if (l < x || weight * (norm2(a[l]) + norm2(b[l])) * move < MIE_RESONANCES_FROM * DBL_EPSILON * (10 + x) * ext)
			continue;
		sum += moved(weight, (double[]){ weight * creal(a[l]), weight * cimag(a[l]) },
		             (double[]){ before * creal(a[l - 1]), before * cimag(a[l - 1]) }, move) +
		       moved(weight, (double[]){ weight * creal(b[l]), weight * cimag(b[l]) },
		             (double[]){ before * creal(b[l - 1]), before * cimag(b[l - 1]) }, move);
	}
	return sum;
}

/* The loops of legendre_series, compiled for each processor: BUILD names what comes out. */
#include "optics/numerics/legendre_series_lanes.h"

#include "optics/numerics/kern/fourier.h"
#include "optics/numerics/kern/legendre.h"
#include "optics/numerics/kern/window.h"

/* Cosines, each divided by the window's transform, to values on the grid. A sum of cosines at half-steps is a complex transform
 * of the same length of V_k = exp(i pi k/2M) (c_k - i c_{M-k})/2, whose first half are the even points and whose second the odd
 * ones, from the end (Makhoul 1980). re[0] and im[0] are zero. */
static void cosines_to_grid(struct legendre_series *s, int n, const double *c, double b, double *wave, double *re[2],
                            double *im[2])
{
	int steps = s->steps;
	fourier_waves(steps, wave);
	for (int k = 0; k <= n; k++) {
		double a = M_PI * k / (2.0 * steps), h = (k ? 0.5 : 1) / window_transform(b, k / (2.0 * steps));
		double u = h * cos(a), v = h * sin(a);
		for (int i = 0; i < 2; i++) {
			double x = c[4 * k + 2 * i], y = c[4 * k + 2 * i + 1];
			re[0][2 * k + i] = u * x - v * y;
			im[0][2 * k + i] = u * y + v * x;
			if (k) {       /* -i exp(i pi (M - k)/2M) = exp(-i pi k/2M) */
				re[0][2 * (steps - k) + i] = u * x + v * y;
				im[0][2 * (steps - k) + i] = u * y - v * x;
			}
		}
	}
	int at = fourier(steps, wave, re, im);
	for (int j = -LEGENDRE_SERIES_PAD; j < steps + LEGENDRE_SERIES_PAD; j++) {
		int in = j < 0 ? -1 - j : j < steps ? j : 2 * steps - 1 - j, from = in % 2 ? steps - 1 - in / 2 : in / 2;
		double *g = s->grid + 4 * (j + LEGENDRE_SERIES_PAD);
		for (int i = 0; i < 2; i++) {
			g[2 * i] = re[at][2 * from + i];
			g[2 * i + 1] = im[at][2 * from + i];
		}
	}
}

static int cosines(struct legendre_series *s, int n, const double (*c)[LEGENDRE_SERIES_SUMS])
{
	double b = M_PI * TAPS * (1 - n / (2.0 * s->steps));
	size_t room = 2 * (size_t)s->steps;
	double *fft = calloc(5 * room, sizeof *fft);
	if (!fft)
		return -1;
	double *re[2] = { fft, fft + room }, *im[2] = { fft + 2 * room, fft + 3 * room };
	window_weights(b, s->poly);
	cosines_to_grid(s, n, c[0], b, fft + 4 * room, re, im);
	free(fft);
	return 0;
}

static int prepare(struct legendre_series *s, int n, double (*c)[LEGENDRE_SERIES_SUMS])
{
	int rows = n / 2 + 1;
	double *x = calloc(16 * (size_t)rows, sizeof *x);
	int failed = !x;
	if (!failed) {
		memcpy(x, c, ((size_t)n + 1) * sizeof *c);
		failed = legendre_cosines(rows, x, x + 8 * (size_t)rows) || cosines(s, n, (const double (*)[LEGENDRE_SERIES_SUMS])(x + 8 * (size_t)rows));
	}
	free(x);
	return failed ? -1 : 0;
}

static void at(const struct legendre_series *s, int count, const double *theta, double (*values)[LEGENDRE_SERIES_SUMS])
{
	double poly[DEGREE + 1][TAPS];
	memcpy(poly, s->poly, sizeof poly);
	for (int i = 0; i < count; i++) {
		int j = (int)floor(theta[i] * s->steps / 180 - 0.5);
		double f = fma(theta[i], s->steps, -180 * (j + 0.5)) / 180;    /* exact but for the last rounding */
		window_sum(poly, f, s->grid + 4 * (j + LEGENDRE_SERIES_PAD - (TAPS / 2 - 1)), values[i]);
	}
}

const struct legendre_series_lanes BUILD = { prepare, cosines, at, fourier_waves, fourier };

#include "optics/goa/goa_plus_edge.h"

#include "optics/goa/debye_bounds.h"
#include "optics/goa/goa_plus_lanes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Room for waves l of u from .. to; their coefficients, and the transform. */
static int strip_set(const struct goa_plus_lanes *lanes, struct goa_plus_edge *e, struct goa_plus_edge_strip *strip, double from,
                     double to, double about, const struct goa_plus_window *only)
{
	int first = (int)fmax(floor(from * e->x - 0.5), 1), last = (int)fmax(ceil(to * e->x), 2);
	size_t n = (size_t)(last - first) + 1;
	strip->first = first;
	strip->n = (int)n;
	strip->about = about * e->x;
	if (n > strip->room) {
		free(strip->sum);
		strip->room = n + n / 8;
		strip->sum = malloc(12 * strip->room * sizeof *strip->sum);
		if (!strip->sum) {
			strip->room = 0;
			return -1;
		}
	}
	strip->sum_behind = strip->sum + 2 * n;
	strip->difference = strip->sum + 4 * n;
	e->lost += lanes->coefficients(e, only, strip);
	strip->nufft.size = 0;
	if (first < GOA_PLUS_EDGE_FAR)
		return 0;
	double *scaled = strip->sum + 6 * n;
	for (size_t k = 0; k < 3 * n; k++) {
		double scale = 1 / sqrt(first + (double)(k % n) + 0.5);
		scaled[2 * k] = strip->sum[2 * k] * scale;
		scaled[2 * k + 1] = strip->sum[2 * k + 1] * scale;
	}
	return nufft_set(&strip->nufft, (int)n, (const double *[4]){ scaled, scaled + 2 * n, scaled + 4 * n, NULL });
}

int goa_plus_edge_set(const struct goa_plus_lanes *lanes, struct goa_plus_edge *e, double x, double complex m)
{
	double top = 1 + DEBYE_TOP * cbrt(x / 2) / x, begin = 1, focus = 0;
	e->x = x;
	e->m = m;
	e->disc = (int)x;
	e->lost = 0;
	goa_plus_windows_set(&e->windows, x, m);
	e->n = e->windows.strips;
	if (e->windows.whole)
		e->disc = 0;           /* Hilb's forms are not for so few waves, and are not needed */
	for (int p = 0; p <= GOA_PLUS_ORDERS + 1; p++) {
		const struct goa_plus_window *w = &e->windows.order[p];
		if (w->over[0] > 0)
			begin = fmin(begin, w->zero[0]);
		else
			focus = w->zero[0];
	}
	if (e->n == 2)
		return strip_set(lanes, e, &e->strip[0], begin, e->windows.only[0].zero[1], creal(m), &e->windows.only[0]) ||
		         strip_set(lanes, e, &e->strip[1], e->windows.only[1].zero[0], top, 1, &e->windows.only[1]);
	if (focus > 0 && focus < begin) {
		e->n = 2;
		return strip_set(lanes, e, &e->strip[0], 0, focus, focus / 2, NULL) ||
		       strip_set(lanes, e, &e->strip[1], begin, top, 1, NULL);
	}
	return strip_set(lanes, e, &e->strip[0], focus > 0 ? 0 : begin, top, creal(m) < 1 ? (begin + 1) / 2 : 1, NULL);
}

void goa_plus_edge_free(struct goa_plus_edge *e)
{
	for (int k = 0; k < 2; k++) {
		free(e->strip[k].sum);
		nufft_free(&e->strip[k].nufft);
	}
}

void goa_plus_edge_aim(int n, const double *theta, struct goa_plus_edge_packet *out)
{
	for (int b = 0; b * GOA_WIDTH < n; b++) {
		struct goa_plus_edge_packet *k = &out[b];
		k->sine = 1;
		for (int i = 0; i < GOA_WIDTH; i++) {
			double t = theta[b * GOA_WIDTH + i < n ? b * GOA_WIDTH + i : n - 1];
			double f = fmin(t, 180 - t) * (M_PI / 180);
			double sine = sin(f), cosine = t > 90 ? -cos(f) : cos(f), r = t * (M_PI / 180);
			k->theta[i] = r;
			k->folded[i] = f;
			k->behind[i] = t > 90;
			k->sine = fmin(k->sine, sine);
			sine = fmax(sine, 1e-12);      /* nearer nobody looks at the rest */
			k->root[i] = sqrt(2 / (M_PI * sine));
			k->plus[i] = (1 - cosine) / sine + cosine / (8 * sine);
			k->minus[i] = -(1 + cosine) / sine + cosine / (8 * sine);
			k->bend[i] = r > 1e-3 ? 1 / r - cosine / sine : r / 3;
			k->slope[i] = 1 / sine;
			k->slant[i] = 1 / (1 + cos(f));
		}
	}
}

void goa_plus_edge_start(int l, double theta, double *p, double *v)
{
	double nu = l + 0.5, both = l * (l + 1.0);
	if (l == 1 || theta == 0) {
		*p = both / 2;
		*v = l;
		return;
	}
	double st = sin(theta), half = sin(theta / 2), cot = cos(theta) / st, q = sqrt(theta / st);
	double z1 = nu * theta + 0.375 * (cot - 1 / theta) / nu;
	double z0 = nu * theta - (tan(theta / 2) + 0.125 * (cot - 1 / theta)) / nu;
	*p = sqrt(both) * q * j1(z1) / st;
	*v = (both * q * j0(z0) + l * 2 * half * half * *p) / (l + 1);
}

double goa_plus_edge_disc(int n, double theta)
{
	/* P'_n + P'_(n+1) - (P_n + P_(n+1))/(1 + cos theta) */
	double sum = 0, st = sin(theta), bend = theta > 1e-3 ? 1 / theta - cos(theta) / st : theta / 3;
	double q = theta > 0 ? sqrt(theta / st) : 1;
	for (int l = n; l <= n + 1; l++) {
		double nu = l + 0.5, z = nu * theta + bend / (8 * nu), v = j0(z);
		double slope = theta > 1e-9 ? (nu * j1(z) - bend * v / 2) / st : (nu * nu - 1.0 / 3) / 2;
		sum += q * (slope - v / (1 + cos(theta)));
	}
	return sum;
}

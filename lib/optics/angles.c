#include "optics/angles.h"

#include <math.h>
#include <stddef.h>

#define PERIOD 8        /* intervals in the shortest period */
#define COARSEST 1.0    /* degrees */
#define FINEST 0.025
#define END 0.1         /* first interval, in units of 1/x */
#define WIDEN 40        /* intervals of the size of 1/WIDEN of the distance from the end */

/* The front half, 0 to 90 deg inclusive: the refined end, then equal intervals over what is left. theta may be NULL. */
static int half(double x, double *theta)
{
	double inside = fmin(COARSEST, fmax(FINEST, 180 / (PERIOD * x))), first = END * (180 / M_PI) / x, t = 0;
	int n = 0;
	for (double h = first; h < inside && t < 90 - inside; h = fmax(first, t / WIDEN)) {
		if (theta)
			theta[n] = t;
		n++;
		t += h;
	}
	int rest = (int)ceil((90 - t) / inside);
	for (int i = 0; i <= rest; i++, n++)
		if (theta)
			theta[n] = i == rest ? 90 : t + (90 - t) * i / rest;
	return n;
}

/* The back half is taken from the front one; the count is odd or the middle pair straddles 90 deg. */
static void mirror(int n, double *theta)
{
	for (int i = n / 2; i < n; i++)
		theta[i] = 180 - theta[n - 1 - i];
}

int angles_count(double x)
{
	return 2 * half(x, NULL) - 1;
}

void angles_grid(double x, double *theta)
{
	mirror(2 * half(x, theta) - 1, theta);
}

void angles_equal(int n, double *theta)
{
	for (int i = 0; i < (n + 1) / 2; i++)
		theta[i] = 180.0 * i / (n - 1);
	mirror(n, theta);
}

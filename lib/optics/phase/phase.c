#include "optics/phase/phase.h"

#include <math.h>

double phase_interval(double theta0, double h, double p0, double p1)
{
	/* sin(theta0 + t) = s cos t + c sin t; the moments of cos t and sin t over [0, h] without cancellation. */
	double s = sin(theta0), c = cos(theta0), slope = h > 0 ? (p1 - p0) / h : 0, h2 = h * h, half = sin(h / 2);
	double cos0 = sin(h), cos1 = h2 * (1.0 / 2 - h2 * (1.0 / 8 - h2 / 144));
	double sin0 = 2 * half * half, sin1 = h2 * h * (1.0 / 3 - h2 * (1.0 / 30 - h2 / 840));
	return 2 * M_PI * (p0 * (s * cos0 + c * sin0) + slope * (s * cos1 + c * sin1));
}

double phase_half_l1(double theta0, double h, double d0, double d1)
{
	double to = d0 * d1 < 0 ? h * d0 / (d0 - d1) : 0;    /* where d changes its sign */
	double part = to > 0 ? fabs(phase_interval(theta0, to, d0, 0)) + fabs(phase_interval(theta0 + to, h - to, 0, d1))
	    : fabs(phase_interval(theta0, h, d0, d1));
	return part / 2;
}

double phase_integral(int n, const double *theta, const double *p)
{
	double sum = 0;
	for (int i = 0; i + 1 < n; i++)
		sum += phase_interval(theta[i], theta[i + 1] - theta[i], p[i], p[i + 1]);
	return sum;
}

double phase_at(int n, const double *theta, const double *p, double angle)
{
	int low = 0, high = n - 1;
	while (high - low > 1) {
		int middle = (low + high) / 2;
		if (theta[middle] <= angle)
			low = middle;
		else
			high = middle;
	}
	double f = (angle - theta[low]) / (theta[low + 1] - theta[low]);
	return p[low] + (p[low + 1] - p[low]) * fmin(fmax(f, 0), 1);
}

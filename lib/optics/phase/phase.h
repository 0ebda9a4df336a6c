/* phase - tabulated phase functions: p(theta) in sr^-1 on nodes theta[n] (rad, ascending, 0 first, pi last), linear in theta
 * between them. */
#ifndef OPTICS_PHASE_H
#define OPTICS_PHASE_H

/* phase_interval - integral over the ring between two nodes, 2 pi int p sin theta dtheta, exact for linear p.
 * h = theta1 - theta0 is at most 0.02 (the series used are then good to 1e-16). */
double phase_interval(double theta0, double h, double p0, double p1);

/* phase_half_l1 - half the integral over the ring of |d|, for d linear from d0 to d1: what it adds to the half-L1 distance of two phase
 * functions, of which d is the difference. Intervals as above. */
double phase_half_l1(double theta0, double h, double d0, double d1);

/* phase_integral - integral over the sphere, int p dOmega; 1 for a normalised phase function. Intervals as above. */
double phase_integral(int n, const double *theta, const double *p);

/* phase_at - p at an angle. */
double phase_at(int n, const double *theta, const double *p, double angle);

#endif

/* angle_grid - grids of scattering angles: degrees, ascending, 0 and 180 included. */
#ifndef OPTICS_ANGLE_GRID_H
#define OPTICS_ANGLE_GRID_H

/* angle_grid_count - number of angles of the grid that depends on size parameter x > 0 alone. It and angle_grid_equal are symmetric:
 * 180 - theta[i] is theta[n-1-i] as a double. */
int angle_grid_count(double x);

/* angle_grid - that grid, theta[angle_grid_count(x)], fit for a phase function linear between its angles.
 *
 * The intensity of one sphere has no finer detail than the period pi/x. The grid has 8 intervals in it, at least 1 a degree and
 * at most 40 a degree (so from x = 900 on the finest detail is met less well, from 3600 on not at all: there a single size's
 * interference is sampled, not resolved). At both ends the spacing starts with 1/10 of 1/x and widens with the distance, to
 * 1/40 of it, until it reaches the interior's: diffraction lobe and glory are resolved at every x.
 *
 * Measured on Lorenz-Mie at x = 0.1 to 1e5, m = 1.33, 1.5, 0.75, 1.33+0.001i: 181 to 7695 angles; the linear interpolant
 * integrates to 1 within 4e-4 (x <= 3000) and 4e-3; it differs from p in L1 by at most 4e-3 (x <= 1000), 3e-2 (3000), 0.13
 * (1e4). */
void angle_grid(double x, double *theta);

/* angle_grid_equal - n >= 2 equally spaced angles. */
void angle_grid_equal(int n, double *theta);

/* angle_grid_fine - number of angles of a fine grid, from 0 to 180 degrees, of which angle_grid_thin may choose for spheres up to size
 * parameter x: in the shortest period of interference, pi/x, several times the intervals that the tolerance needs there, four a
 * degree at least, and finer towards the forward peak. theta[] may be NULL. -1, at no cost, where that is more than
 * ANGLE_GRID_MOST. */
#define ANGLE_GRID_MOST 0x1p27
long angle_grid_fine(double x, double tolerance, double *theta);

/* angle_grid_thin - as few angles of a fine grid as serve p[0 .. nwaves), phase functions on theta[n] (degrees) in sr^-1: between
 * neighbours among those kept each p, taken as linear, is off in L1, half the integral of |p - linear| over the sphere, by no
 * more than tolerance in all. The error is shared out equally among the intervals; none is longer than a degree. keep[] gets the
 * indices, 0 and n-1 among them; returns how many, or -1 when memory ran out. Where the fine grid itself is too coarse it is
 * kept whole. */
long angle_grid_thin(long n, const double *theta, int nwaves, double *const *p, double tolerance, long *keep);

#endif

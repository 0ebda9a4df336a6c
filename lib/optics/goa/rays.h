/* rays - the paths by which geometrical optics sends light from a sphere into a given direction.
 *
 * Everything here depends on the real refractive index n and the angle alone, not on size or absorption. A ray of order p runs
 * along p chords (p = 0: reflected outside); it enters at the angle of incidence i, sin i = n sin t, and is turned by
 *     Theta_p(i) = 2 i - 2 p t + (p-1) pi = sigma theta + 2 pi M,    sigma = +-1, M integer (Guo et al. 2022, section 3).
 * Inside we count from the central ray, tau = Theta_p - (p-1) pi = 2 i - 2 p t, and from its axis (forward for odd p, backward for
 * even p), so that nothing cancels near either axis. */
#ifndef OPTICS_RAYS_H
#define OPTICS_RAYS_H

#define GOA_WIDTH 8        /* neighbouring angles side by side, wherever rays are packed for loops */

/* Most rays of order p that can share a direction. */
#define RAYS_MAX(p) (2 * (p) + 8)

struct ray {
	int p;
	int sigma;            /* its angle is sigma theta + 2 pi M */
	int axial;            /* belongs to the family that holds the central ray (i = 0) of the nearer axis */
	int eighths;          /* the phase that does not grow with size, -(p-1) pi/2 + M pi - sigma pi/4 - (pi/4) sgn Theta'_p, in pi/4 */
	double sin_i, cos_i;
	double q;             /* n cos t */
	double slope;         /* |Theta'_p|, Theta'_p = 2 - 2 p cos i / q */
	double ratio;         /* sin i / sin theta; on the axis its limit, infinite for rays that are not axial */
	double gap;           /* |Theta_p - Theta_p(rainbow)|, infinite without a rainbow */
};

/* rays_spread - sqrt(D), D = sin i cos i / (sin theta |Theta'|) the divergence factor; infinite on caustics. */
double rays_spread(const struct ray *r);

/* Where D of order p diverges, for n. */
struct caustic {
	double incidence;     /* i_R of the rainbow, rad: cos^2 i_R = (n^2 - 1)/(p^2 - 1); NaN if there is none */
	double tau;           /* tau there */
	double bend;          /* Theta''_p there */
	double third;         /* |Theta'''_p| of the central ray, where Theta''_p is 0 */
};

/* rays_caustic - the caustics of order p >= 0 for n > 0. */
struct caustic rays_caustic(double n, int p);

/* rays_find - every ray of order p that leaves at theta (degrees, [0, 180]).
 * Given: c    rays_caustic(n, p)
 *        out  room for RAYS_MAX(p)
 * Returns how many. On an axis, the central ray comes once, others as the pair that they are beside it. */
int rays_find(double n, int p, const struct caustic *c, double theta, struct ray *out);

/* A stretch of incidence on which tau runs monotonically: the only one, or one on either side of the rainbow. */
struct branch {
	double lo, hi;        /* angle of incidence, of refraction for n < 1 */
	double from, to;      /* tau at either end */
	int sign;             /* of Theta' */
	int central;          /* begins with the central ray */
};

/* rays_branches - those of order p >= 2; returns how many. */
int rays_branches(double n, int p, const struct caustic *c, struct branch out[2]);

/* rays_at - the ray of a branch with tau = side from_axis + 2 pi turns, from_axis the angle between theta (degrees) and the axis
 * of the central ray; returns whether there is one. On the axis the central ray has but one side. */
int rays_at(double n, int p, const struct caustic *c, const struct branch *b, double theta, int side, int turns, struct ray *r);

#endif

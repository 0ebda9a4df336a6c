#include "optics/cam/cam.h"

#include "optics/cam/cam_rays.h"
#include "optics/cam/cam_waves.h"

#include <math.h>
#include <stdlib.h>

#define OCTAVE 4       /* steps of the table an octave of x */
#define STEPS (26 * OCTAVE)
#define LEAST 2.0      /* smaller sizes are taken as this one's: far from where anything holds */

struct node {
	double abs, pr;
	int there;
};

struct cam {
	double complex m;
	double still[2];                /* abs, pr of rays where nothing absorbs */
	struct cam_rays rays;
	struct node node[STEPS];        /* what cam_mean has more than the rays, at x = 2^(k/OCTAVE) */
};

struct cam *cam_new(double complex m)
{
	struct cam *c = calloc(1, sizeof *c);
	if (!c)
		return NULL;
	c->m = m;
	cam_rays_find(m, &c->rays);
	if (cimag(m) == 0)
		cam_rays_mean(&c->rays, 1, &c->still[0], &c->still[1]);
	return c;
}

void cam_free(struct cam *c)
{
	free(c);
}

/* First of the four nodes that x lies between. */
static int place(double x, double *part)
{
	double at = OCTAVE * log2(x);
	int k = (int)fmin(fmax(floor(at) - 1, OCTAVE * log2(LEAST)), STEPS - 4);
	*part = at - k;
	return k;
}

static void rays(const struct cam *c, double x, double *abs, double *pr)
{
	*abs = c->still[0];
	*pr = c->still[1];
	if (cimag(c->m) > 0)
		cam_rays_mean(&c->rays, x, abs, pr);
}

void cam_reach(struct cam *c, double x)
{
	double part;
	for (int k = place(fmax(x, LEAST), &part), end = k + 4; k < end; k++) {
		struct node *n = &c->node[k];
		double at = exp2((double)k / OCTAVE), abs, pr;
		if (n->there)
			continue;
		rays(c, at, &abs, &pr);
		cam_mean(at, c->m, &n->abs, &n->pr);
		n->abs -= abs;
		n->pr -= pr;
		n->there = 1;
	}
}

static void mean(const struct cam *c, double x, double *abs, double *pr)
{
	double t, w[4];
	const struct node *n = &c->node[place(x, &t)];
	rays(c, x, abs, pr);
	w[0] = -(t - 1) * (t - 2) * (t - 3) / 6;
	w[1] = t * (t - 2) * (t - 3) / 2;
	w[2] = -t * (t - 1) * (t - 3) / 2;
	w[3] = t * (t - 1) * (t - 2) / 6;
	for (int i = 0; i < 4; i++) {
		*abs += w[i] * n[i].abs;
		*pr += w[i] * n[i].pr;
	}
}

/* Diffraction, the edge, and the ray through the centre with its orders p = 1, 3, ..; with the root of Im >= 0 for n < 1 as well. */
static double extinction(const struct cam *c, double x)
{
	static const double c1 = 1.2551245556, c2 = 0.5322906033, c3 = 0.0677180533;
	double complex m = cabs(c->m - 1) < 1e-9 ? 1 + 1e-9 : c->m, m2 = m * m, root = csqrt((m - 1) * (m + 1)), half = (m - 1) / 2;
	double g = cbrt(2 / x), g2 = g * g, g3 = 2 / x;
	if (cimag(root) < 0)
		root = -root;
	double complex t = 1 + I / (2 * x) * (1 / (m - 1) - (m - 1) / m);
	double turns = 4 * x * creal(m), r2 = exp(-4 * x * cimag(m));
	double complex reflected = (m - 1) / (m + 1), z = reflected * reflected * r2 * CMPLX(cos(turns), sin(turns)), power = z;
	for (int j = 1; j < 40 && norm2(power) > 1e-20; j++, power *= z) {
		double complex focus = j - half;
		if (norm2(focus) < 1 / x)     /* the focus of a central ray, n near 2j + 1 */
			focus = focus == 0 ? 1 / sqrt(x) : focus / (cabs(focus) * sqrt(x));
		t -= half * power / focus;
	}
	double complex axial = m2 / ((m + 1) * (m - 1) * (m + 1)) * t, wave = 2 * x * (m - 1);
	double q = 2 + c1 * g2 + g3 * cimag((m2 + 1) / root) -
		   8 / x * exp(-cimag(wave)) * (creal(axial) * sin(creal(wave)) + cimag(axial) * cos(creal(wave)));
	double complex root3 = root * root * root, turned = CMPLX(0.5, sqrt(0.75));
	return q - 8.0 / 15 * c2 * g2 * g2 - g2 * g3 / 6 * cimag(c1 * turned * (m2 + 1) * (3 + m2 * (2 * m2 - 6)) / root3) +
	       g3 * g3 * (8.0 / 175 * c3 - 397.0 / 840 + creal((m2 * (m2 * m2 - 1) - 1) / (root * root)) / 4);
}

/* Rays along the axis backward, of orders 0, 2, 4. */
static double backward(const struct cam *c, double x)
{
	double complex m = c->m, r = (1 - m) / (1 + m), sum = r, order = (1 - r * r) * -r;
	for (int p = 2; p <= 4; p += 2, order *= r * r) {
		double complex focus = 1 - p / m;
		if (norm2(focus) < 1 / x)
			focus = focus == 0 ? 1 / sqrt(x) : focus / (cabs(focus) * sqrt(x));
		sum += order / focus * cexp(2 * I * x * p * m);
	}
	return norm2(sum);
}

double cam_error(double x, double complex m)
{
	double complex step = cabs(m - 1) < 1e-9 ? 1e-9 : m - 1, square = step * (m + 1);
	double n = creal(m), lost = x * cimag(m), g = cbrt(2 / fmax(x, LEAST)), g2 = g * g, g6 = g2 * g2 * g2, n2 = cabs(square);
	/* orders left out: of the edge, whose series fails where its root is small, and of the central ray, where x |m - 1| is */
	double edge = 2 * g6 * (1 + 0.13 / (n2 * n2) + n2 / 4 + n2 * n2 / 8);
	double central = 0.25 * g6 * g2 * g * cabs(m * m / ((m + 1) * square * step * step)) * exp(-2 * lost);
	/* what absorption leaves of resonances, whose peaks are ~ x^(-2/3), in two chords near the edge; or of the critical angle, where
	 * chords are short */
	double ring = n > 1 ? 0.36 * g2 * exp(-4 * lost * fmin(sqrt(n2) / n, 1)) :
	              0.2 * pow(x, -0.7) / (1 + lost * lost / 25) + (lost > 0 ? 0.15 / x : 0);
	/* the focus of a central ray, n near 2j + 1: on it the wave is as large as what is known of it */
	double j = fmax(1, round((n - 1) / 2)), off = cabs(j - step / 2);
	double focus = 6 * norm2(m / (m + 1)) * pow(norm2(step / (m + 1)), j) * exp(-(4 * j + 2) * lost) *
		       fmin(1 / sqrt(x), 1 / (x * x * off * off * off));
	return edge + central + ring + focus + 5e-8;
}

struct efficiencies cam_at(const struct cam *c, double x, int ripple)
{
	struct efficiencies q;
	double abs, pr, more_ext, more_abs, more_pr;
	x = fmax(x, LEAST);
	ripple = ripple && creal(c->m) > 1;
	mean(c, x, &abs, &pr);
	cam_rays_waves(&c->rays, x, ripple, &more_ext, &more_abs, &more_pr);
	q.ext = extinction(c, x) + more_ext;
	abs += more_abs;
	pr += more_pr;
	if (ripple) {
		cam_ripple(x, c->m, &more_ext, &more_abs, &more_pr);
		q.ext += more_ext;
		abs += more_abs;
		pr += more_pr;
	}
	q.ext = fmax(q.ext, 0);
	q.abs = cimag(c->m) == 0 ? 0 : fmin(fmax(abs, 0), q.ext);
	q.sca = q.ext - q.abs;
	q.g = q.sca > 0 ? fmin(fmax((q.ext - pr) / q.sca, -1), 1) : 0;
	q.back = backward(c, x);
	return q;
}

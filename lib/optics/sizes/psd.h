/* psd - particle size distributions by number, divided into classes with one quadrature radius each. */
#ifndef OPTICS_PSD_H
#define OPTICS_PSD_H

enum psd_kind { PSD_MONO, PSD_LOGNORMAL, PSD_GAMMA, PSD_NORMAL, PSD_UNIFORM, PSD_POWER, PSD_KINDS };

#define PSD_RADIUS_MIN 1e-9      /* um: truncations lie in this range */
#define PSD_RADIUS_MAX 1e9
#define PSD_BULK 1e-4            /* of the number below, and of the volume above, the range that is cut into equal panels */
#define PSD_TAIL 1e-8            /* lost by the default truncation */
#define PSD_CLASSES_MAX 100000

/* Lengths in um. a, b by kind: mono radius; lognormal median, gsd > 1; gamma effective radius, effective variance in (0, 1/2)
 * (Hansen 1971: n ~ r^((1-3b)/b) exp(-r/(a b))); normal mean, stddev; uniform (none); power exponent: n(r) ~ r^-a. */
struct psd {
	enum psd_kind kind;
	double a, b;
	double min, max;         /* truncation; NaN: the kind's own default, which psd_limits gives */
};

struct psd_class {
	double radius, weight;   /* um; number fraction */
	double lo, hi;           /* um */
};

/* psd_limits - the truncation in force; returns NULL, or what is wrong with the parameters.
 * By default a share PSD_TAIL of the number lies below min (or more, up to PSD_BULK, where min is PSD_RADIUS_MIN), and PSD_TAIL of the
 * volume above max; uniform and power have none. */
const char *psd_limits(const struct psd *p, double *min, double *max);

/* psd_moment - integral of r^k n(r) dr over [lo, hi], n normalised to 1 over the truncated range; k = 0 .. 6.
 * NaN where psd_limits finds something wrong. Relative error about 1e-14. */
double psd_moment(const struct psd *p, int k, double lo, double hi);

/* psd_classes - n classes; moments 0 to 3 over all classes are those of the truncated distribution (n = 1: moments 0 and 3),
 * every radius lies in its class. A mono distribution has one class, whatever n is. Returns NULL, or what is wrong.
 *
 * The range, or as much of it as lies within the bulk, is cut into panels of two classes (and one of three,
 * if n is odd) of equal width in ln r. A panel's radii and weights are the nodes and weights of the Gauss rule of n(r) over
 * it, so that its moments 0 to 3 are exact; the class edges lie where the cumulated number equals the cumulated weights,
 * which is between the nodes (Chebyshev, Markov, Stieltjes: Szego, Orthogonal Polynomials, 3.41). */
const char *psd_classes(const struct psd *p, int n, struct psd_class *out);

/* psd_fits - whether classes are those of a distribution, as psd_classes makes them, in any order, or any others that divide it: one
 * begins where another ends, from min to max where these are given; radii lie within; a class has its share of the number between
 * the lowest limit and the highest within PSD_FITS, relative (and limits and radii within PSD_TOUCH). A class may stand again, as in
 * a table of several wavelengths. Returns NULL, or what is wrong. c is sorted by its limits, and left with each class once: *n. */
#define PSD_FITS 1e-4
#define PSD_TOUCH 1e-6
const char *psd_fits(const struct psd *p, int *n, struct psd_class *c);

#endif

/* psd - particle size distributions by number, divided into classes with one quadrature radius each. */
#ifndef OPTICS_PSD_H
#define OPTICS_PSD_H

enum psd_kind { PSD_MONO, PSD_LOGNORMAL, PSD_GAMMA, PSD_NORMAL, PSD_UNIFORM, PSD_POWER };

/* Lengths in um. a, b by kind: mono radius; lognormal median, gsd; gamma effective radius, effective variance (Hansen 1971);
 * normal mean, stddev; uniform (none); power exponent: n(r) ~ r^-a. */
struct psd {
	enum psd_kind kind;
	double a, b;
	double min, max;         /* truncation; NaN: the kind's own default, which psd_limits gives */
};

struct psd_class {
	double radius, weight;   /* um; number fraction */
	double lo, hi;           /* um */
};

/* psd_limits - the truncation in force; returns NULL, or what is wrong with the parameters. */
const char *psd_limits(const struct psd *p, double *min, double *max);

/* psd_moment - integral of r^k n(r) dr over [lo, hi], n normalised to 1 over the truncated range; k = 0 .. 6. */
double psd_moment(const struct psd *p, int k, double lo, double hi);

/* psd_classes - n classes; moments 0 to 3 over all classes are those of the truncated distribution (n = 1: moments 0 and 3),
 * every radius lies in its class. Returns NULL, or what is wrong. */
const char *psd_classes(const struct psd *p, int n, struct psd_class *out);

#endif

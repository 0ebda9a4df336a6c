/* psd_law - a size distribution as a smooth law: what psd.h is made of.
 *
 * Everything is done in y = ln(r/ref), with ref near the bulk, so that a narrow distribution keeps its digits; the density in y is
 * exp(psd_law_log(y)), known up to a factor. psd_law_log(y) + k y has one maximum for every k. */
#ifndef OPTICS_PSD_LAW_H
#define OPTICS_PSD_LAW_H

#include "optics/sizes/psd.h"

#define PSD_NODES 20             /* of a Gauss-Legendre piece */
#define PSD_PIECES 96

struct psd_law {
	enum psd_kind kind;
	double ref;              /* um */
	double s;                /* lognormal ln gsd; gamma 1/b - 2; normal (mean/stddev)^2; uniform, power: slope of the logarithm */
	double x[PSD_NODES], w[PSD_NODES];      /* Gauss-Legendre rule on [-1, 1] */
};

/* psd_law_limits - the law, and its truncation in um. Returns NULL, or what is wrong with the parameters. */
const char *psd_law_limits(const struct psd *p, struct psd_law *d, double *min, double *max);

/* psd_law_within - where a share (PSD_BULK or PSD_TAIL) of the number lies below *lo, and of the volume above *hi, in y; infinite for
 * uniform and power. */
void psd_law_within(const struct psd_law *d, double share, double *lo, double *hi);

/* psd_law_log - the density's logarithm. */
double psd_law_log(const struct psd_law *d, double y);

/* psd_law_peak - where the density times e^(k y) is largest within [lo, hi]. */
double psd_law_peak(const struct psd_law *d, int k, double lo, double hi);

/* psd_law_support - where, going from the maximum towards end, that has dropped to nothing; end where it has not. */
double psd_law_support(const struct psd_law *d, int k, double top, double end);

/* The density over a range of y as a sum over points: w_i at y_i, in units of exp(scale). */
struct psd_points {
	int n;
	double y[PSD_NODES * PSD_PIECES], w[PSD_NODES * PSD_PIECES];
};

/* psd_law_points - Gauss-Legendre in pieces over [lo, hi]. */
void psd_law_points(const struct psd_law *d, double scale, double lo, double hi, struct psd_points *out);

/* psd_law_integral - of the density times exp(k y - scale) over [lo, hi]. */
double psd_law_integral(const struct psd_law *d, int k, double scale, double lo, double hi);

#endif

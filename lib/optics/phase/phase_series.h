/* phase_series - a phase function, or a mean of many, from its values at so many angles that it is known at all others: what a series of n
 * partial waves scatters is a sum of cosines up to order 2 n. */
#ifndef OPTICS_PHASE_SERIES_H
#define OPTICS_PHASE_SERIES_H

struct phase_series;

/* phase_series_steps - how many angles it takes for terms partial waves; phase_series_theta - the j-th of them, degrees. */
int phase_series_steps(int terms);
double phase_series_theta(int steps, int j);

/* phase_series_new - 0 everywhere; NULL when memory ran out. phase_series_add - add values at the angles of so many steps, which may
 * differ from call to call; 0, or -1 when memory ran out. */
struct phase_series *phase_series_new(void);
int phase_series_add(struct phase_series *s, int steps, const double *value);
void phase_series_free(struct phase_series *s);

/* phase_series_ready - nothing more will be added; 0, or -1 when memory ran out.
 * phase_series_at - values at theta[n], degrees, at least 0. Rounding leaves some 1e-15 of the largest value, near the forward peak; away
 * from it, of what p sin^4(theta/2) has for its largest, over sin^4(theta/2). */
int phase_series_ready(struct phase_series *s);
void phase_series_at(const struct phase_series *s, long n, const double *theta, double *value);

#endif

#include "toolkit/ranges.h"

#include "toolkit/size.h"

#include <math.h>

#define TAIL 0.001     /* of the tolerance */

double ranges_add(struct size_integral *s, const struct class_table *t, int together, double tolerance)
{
	double scale = 1 / s->integrand.x_of_um, lo = 0, hi = INFINITY;
	int open_lo = t->has_law && isnan(t->law.min), open_hi = t->has_law && isnan(t->law.max);
	if (t->has_law) {
		size_reach(&t->law, scale, cabs(s->integrand.m - 1), TAIL * tolerance, &lo, &hi);
		if (open_lo)
			lo = fmax(lo, SIZE_X_MIN * scale);
		if (open_hi)
			hi = fmin(hi, SIZE_X_MAX * scale * fmin(1, size_y_max(s->integrand.m) / cabs(s->integrand.m) / SIZE_X_MAX));
	}
	double left = TAIL * tolerance * (open_lo + open_hi);
	if (together && t->has_law) {
		size_integral_add(s, (struct size_range){ 0, lo, hi, !open_lo, !open_hi, scale }, 0);
		return left;
	}
	for (int i = 0; i < t->classes; i++) {
		struct size_range r = { i, t->class[i].lo, t->class[i].hi, 1, 1, scale };
		if (!i && open_lo)
			r.lo = fmin(r.lo, lo);
		if (i == t->classes - 1 && open_hi)
			r.hi = fmax(r.hi, hi);
		size_integral_add(s, r, together ? 0 : (size_t)i);
	}
	return left;
}

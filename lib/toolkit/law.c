#include "toolkit/law.h"

#include "base/die.h"
#include "format/columns.h"
#include "optics/sizes/psd_text.h"

#include <stdlib.h>

struct law_check {
	const struct tab *t;
	int radius, weight, lo, hi;    /* columns */
	int n;
	struct psd_class *class;
};

int law_fits(const struct tab *t, struct psd *law, int *n, struct psd_class *c)
{
	if (!tab_law(t))
		return 0;
	const char *bad = psd_parse(tab_law(t), law);
	if (bad)
		die(tab_path(t), "the law '%s' %s", tab_law(t), bad);
	bad = psd_fits(law, n, c);
	if (bad)
		die(tab_path(t), "the law '%s' does not fit the rows: %s", tab_law(t), bad);
	return 1;
}

struct law_check *law_check_begin(const struct tab *t)
{
	struct law_check *c = xalloc(1, sizeof *c);
	*c = (struct law_check){ t, tab_find(t, &column_radius), tab_find(t, &column_weight), tab_find(t, &column_radius_lo),
		tab_find(t, &column_radius_hi), 0, NULL };
	return c;
}

void law_check_row(struct law_check *c, const double *row)
{
	if (!tab_law(c->t) || c->radius < 0 || c->weight < 0 || c->lo < 0 || c->hi < 0)
		return;
	if (!(c->n & (c->n - 1)))
		c->class = xgrow(c->class, c->n ? 2 * (size_t)c->n : 1, sizeof *c->class);
	c->class[c->n++] = (struct psd_class){ row[c->radius], row[c->weight], row[c->lo], row[c->hi] };
}

void law_check_end(struct law_check *c)
{
	struct psd law;
	if (c->n)
		law_fits(c->t, &law, &c->n, c->class);
	free(c->class);
	free(c);
}

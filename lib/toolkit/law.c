#include "toolkit/law.h"

#include "base/die.h"
#include "optics/sizes/psd_text.h"

#include <stddef.h>

int law_of(const struct tab *t, struct psd *law)
{
	if (!tab_law(t))
		return 0;
	const char *bad = psd_parse(tab_law(t), law);
	if (bad)
		die(tab_path(t), "the law '%s' %s", tab_law(t), bad);
	return 1;
}

int law_fits(const struct tab *t, struct psd *law, int *n, struct psd_class *c)
{
	if (!law_of(t, law))
		return 0;
	const char *bad = psd_fits(law, n, c);
	if (bad)
		die(tab_path(t), "the law '%s' does not fit the rows: it %s", tab_law(t), bad);
	return 1;
}

/* law - the size distribution of which a table says that its rows are classes, tab(5). */
#ifndef TOOLKIT_LAW_H
#define TOOLKIT_LAW_H

#include "format/tab.h"
#include "optics/sizes/psd.h"

/* law_of - the law of a table; 0 if it has none. Dies where it is none that there could be. */
int law_of(const struct tab *t, struct psd *law);

/* law_fits - the same, with the table's classes, n of them, which it sorts, each once; dies where they are not the law's (psd_fits). */
int law_fits(const struct tab *t, struct psd *law, int *n, struct psd_class *c);

#endif

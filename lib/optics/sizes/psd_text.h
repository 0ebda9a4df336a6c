/* psd_text - a size distribution in words: its kind, and name=value for each parameter, as in "gamma effective_radius=8
 * effective_variance=0.1 max=40"; radii in um, min and max only where it is cut there. */
#ifndef OPTICS_PSD_TEXT_H
#define OPTICS_PSD_TEXT_H

#include "optics/sizes/psd.h"

/* What a kind and its parameters a, b are called (NULL: it has none), and whether it has min and max. */
struct psd_words {
	const char *kind, *a, *b;
	enum { PSD_WHOLE, PSD_MAY_BE_CUT, PSD_IS_CUT } limits;
};

extern const struct psd_words psd_words[PSD_KINDS];

/* psd_print - write the text, exact to the last bit; returns out. */
#define PSD_TEXT 160
const char *psd_print(const struct psd *p, char out[PSD_TEXT]);

/* psd_parse - read it; NULL, or what is wrong, which may be a parameter that psd_limits refuses. */
const char *psd_parse(const char *text, struct psd *out);

#endif

#include "optics/sizes/psd_text.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct psd_words psd_words[PSD_KINDS] = {
	[PSD_MONO] = { "mono", "radius", NULL, PSD_WHOLE },
	[PSD_LOGNORMAL] = { "lognormal", "median", "gsd", PSD_MAY_BE_CUT },
	[PSD_GAMMA] = { "gamma", "effective_radius", "effective_variance", PSD_MAY_BE_CUT },
	[PSD_NORMAL] = { "normal", "mean", "stddev", PSD_MAY_BE_CUT },
	[PSD_UNIFORM] = { "uniform", NULL, NULL, PSD_IS_CUT },
	[PSD_POWER] = { "power", "exponent", NULL, PSD_IS_CUT },
};

/* The shortest that reads back the same. */
static int print_value(char *out, size_t size, const char *name, double v)
{
	char text[32];
	for (int digits = 15; digits <= 17; digits++) {
		snprintf(text, sizeof text, "%.*g", digits, v);
		if (strtod(text, NULL) == v)
			break;
	}
	return snprintf(out, size, " %s=%s", name, text);
}

const char *psd_print(const struct psd *p, char out[PSD_TEXT])
{
	const struct psd_words *w = &psd_words[p->kind];
	const struct { const char *name; double value; } part[] = {
		{ w->a, p->a }, { w->b, p->b }, { isnan(p->min) ? NULL : "min", p->min }, { isnan(p->max) ? NULL : "max", p->max },
	};
	int n = snprintf(out, PSD_TEXT, "%s", w->kind);
	for (size_t i = 0; i < sizeof part / sizeof *part; i++)
		if (part[i].name)
			n += print_value(out + n, PSD_TEXT - (size_t)n, part[i].name, part[i].value);
	return out;
}

/* The parameter called name, of length n, or NULL. */
static double *place(struct psd *p, const char *name, size_t n)
{
	const struct psd_words *w = &psd_words[p->kind];
	const char *const names[] = { w->a, w->b, w->limits == PSD_WHOLE ? NULL : "min", w->limits == PSD_WHOLE ? NULL : "max" };
	double *const places[] = { &p->a, &p->b, &p->min, &p->max };
	for (int i = 0; i < 4; i++)
		if (names[i] && strlen(names[i]) == n && !strncmp(names[i], name, n))
			return places[i];
	return NULL;
}

const char *psd_parse(const char *text, struct psd *out)
{
	size_t n = strcspn(text, " ");
	int kind = 0;
	while (kind < PSD_KINDS && (strlen(psd_words[kind].kind) != n || strncmp(psd_words[kind].kind, text, n)))
		kind++;
	if (kind == PSD_KINDS)
		return "is no distribution (mono, lognormal, gamma, normal, uniform, power)";
	*out = (struct psd){ (enum psd_kind)kind, NAN, NAN, NAN, NAN };
	for (const char *at = text + n; *at;) {
		size_t name = strcspn(++at, "=");
		double *v = place(out, at, name);
		char *end;
		if (!v || !at[name])
			return "has a parameter that does not belong to it";
		if (!isnan(*v))
			return "has a parameter twice";
		at += name + 1;
		*v = strtod(at, &end);
		if (end == at || (*end && *end != ' ') || !isfinite(*v))
			return "has a parameter that is no number";
		at = end;
	}
	if ((psd_words[kind].a && isnan(out->a)) || (psd_words[kind].b && isnan(out->b)))
		return "lacks a parameter";
	double min, max;
	return psd_limits(out, &min, &max);
}

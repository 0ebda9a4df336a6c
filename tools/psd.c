/* psd - a particle size distribution as a table of classes. */
#include "base/die.h"
#include "base/opt.h"
#include "format/columns.h"
#include "optics/sizes/psd_text.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Whether an option states a parameter of that name. */
static int states(const struct opt *o, const char *name)
{
	const char *c = o->name + 2;
	if (!name)
		return 0;
	for (; *c && *name && (*c == '-' ? '_' : *c) == *name; c++)
		name++;
	return !*c && !*name;
}

/* The value of a shape option: needed by this kind, or not to be given. */
static void shape(const struct opt *o, struct psd *p)
{
	const struct psd_words *w = &psd_words[p->kind];
	double v = *(const double *)o->dst;
	double *place = states(o, w->a) ? &p->a : states(o, w->b) ? &p->b : NULL;
	if (place && isnan(v))
		die(o->name, "%s needs it", w->kind);
	if (!place && !isnan(v))
		die(o->name, "does not belong to %s", w->kind);
	if (place)
		*place = v;
}

int main(int argc, char **argv)
{
	double radius = NAN, median = NAN, gsd = NAN, reff = NAN, veff = NAN, mean = NAN, stddev = NAN, exponent = NAN;
	struct psd p = { .min = NAN, .max = NAN };
	long long classes = 16;
	const char *output = NULL;
	const struct opt opts[] = {
		{ "--radius", OPT_UM, &radius, PSD_RADIUS_MIN, PSD_RADIUS_MAX, "R", "mono: the radius", 0 },
		{ "--median", OPT_UM, &median, PSD_RADIUS_MIN, PSD_RADIUS_MAX, "R", "lognormal: median radius", 0 },
		{ "--gsd", OPT_REAL, &gsd, 0, 0, "S", "lognormal: geometric standard deviation, > 1", 0 },
		{ "--effective-radius", OPT_UM, &reff, PSD_RADIUS_MIN, PSD_RADIUS_MAX, "R", "gamma: effective radius", 0 },
		{ "--effective-variance", OPT_REAL, &veff, 0, 0, "V", "gamma: effective variance, 0 to 0.5", 0 },
		{ "--mean", OPT_UM, &mean, PSD_RADIUS_MIN, PSD_RADIUS_MAX, "R", "normal: mean radius", 0 },
		{ "--stddev", OPT_UM, &stddev, 0, DBL_MAX, "R", "normal: standard deviation", 0 },
		{ "--exponent", OPT_REAL, &exponent, 0, 0, "E", "power: n(r) ~ r^-E", 0 },
		{ "--min", OPT_UM, &p.min, PSD_RADIUS_MIN, PSD_RADIUS_MAX, "R", "smallest radius", 0 },
		{ "--max", OPT_UM, &p.max, PSD_RADIUS_MIN, PSD_RADIUS_MAX, "R", "largest radius", 0 },
		{ "--classes", OPT_INT, &classes, 1, PSD_CLASSES_MAX, "N", "classes", 0 },
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "mono|lognormal|gamma|normal|uniform|power [OPTION]..",
		"Write a particle size distribution as a table of classes.", opts, 1 };
	const size_t nshapes = 8;        /* the options that stand first */
	struct opt_line args = opt_parse(&tool, argc, argv);
	int k = 0;
	if (args.n != 1)
		die(args.n ? args.operand[1] : NULL, args.n ? "one distribution at a time" : "name a distribution: mono, lognormal, gamma, normal, uniform or power");
	const char *word = args.operand[0];
	while (k < PSD_KINDS && strcmp(psd_words[k].kind, word))
		k++;
	if (k == PSD_KINDS)
		die(word, "is no distribution (mono, lognormal, gamma, normal, uniform, power)");
	p.kind = (enum psd_kind)k;
	for (size_t i = 0; i < nshapes; i++)
		shape(&opts[i], &p);
	if (psd_words[k].limits == PSD_WHOLE && !(isnan(p.min) && isnan(p.max)))
		die(isnan(p.min) ? "--max" : "--min", "does not belong to %s", word);
	if (psd_words[k].limits == PSD_IS_CUT && (isnan(p.min) || isnan(p.max)))
		die(isnan(p.min) ? "--min" : "--max", "%s needs it", word);

	int n = p.kind == PSD_MONO ? 1 : (int)classes;
	struct psd_class *c = xalloc((size_t)n, sizeof *c);
	const char *bad = psd_classes(&p, n, c);
	if (bad)
		die(word, "%s", bad);
	const struct tab_col cols[] = { column_radius, column_weight, column_radius_lo, column_radius_hi };
	char law[PSD_TEXT];
	struct tab_out *t = tab_create(output, "", args.history, psd_print(&p, law), 4, cols);
	for (int i = 0; i < n; i++)
		tab_put(t, (double[]){ c[i].radius, c[i].weight, c[i].lo, c[i].hi });
	tab_finish(t);
	free(c);
	return 0;
}

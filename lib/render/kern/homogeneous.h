/* homogeneous - the medium of its mean extinction everywhere: nothing needs steps. */
#ifndef KERN_HOMOGENEOUS_H
#define KERN_HOMOGENEOUS_H

#include "render/kern/traversal.h"

struct homogeneous {
	fv length;                 /* of the ray inside */
};

FN void homogeneous_begin(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g, struct homogeneous *h,
                          mv m, struct ray r, fv t_end, mv flight, struct waves w, const struct random *random)
{
	fv t0, t1;
	(void)t, (void)flight, (void)w, (void)random;
	clip_volume(v, r, &t0, &t1);
	PUT3(m, g->entry, add(r.from, scale(r.along, t0)));
	PUT3(m, g->along, r.along);
	PUT(m, g->t0, t0);
	SET_TRUTH(m, g->forced, NO_LANE);
	PUT(m, h->length, fv_max(fv_min(t1, t_end) - t0, FV(0.f)));
}

/* Camera flights m: forced where they are thin. None has to go again. */
FN mv homogeneous_force(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g, struct homogeneous *h,
                        mv m, struct waves w, const struct random *random, mv *thin)
{
	fv thickest = FV(0.f);
	(void)v, (void)random;
	EACH_WAVE(j)
		thickest = fv_max(thickest, of_wave(s, t->extinction, 0, m, w, j) * h->length);
	*thin = m & lt(FV(0.f), thickest) & lt(thickest, FV(FORCED_DEPTH));
	g->forced |= *thin;
	return NO_LANE;
}

/* The optical depth of all that lies before the end of flights m. */
FN void homogeneous_depth(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g, struct homogeneous *h,
                          mv m, struct waves w, fv *out)
{
	(void)v, (void)g;
	EACH_WAVE(j)
		out[j] = of_wave(s, t->extinction, 0, m, w, j) * h->length;
}

FN void homogeneous_transmittance(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g,
                                  struct homogeneous *h, mv m, struct waves w, fv *out)
{
	(void)v, (void)g;
	EACH_WAVE(j)
		out[j] = expneg(of_wave(s, t->extinction, 0, m, w, j) * h->length);
}

FN struct collision homogeneous_end(const struct scene *s, const struct volume *v, const struct tables *t, struct traversal *g,
                                    struct homogeneous *h, mv m, struct waves w, const struct random *random, fv *flight_pdf)
{
	fv sigma = of_hero(s, t->extinction, m, w), free = free_path(draw_bits(random, DRAW_FLIGHT));
	if (any(m & g->forced))
		SET(g->forced, free, forced_path(draw_bits(random, DRAW_FLIGHT), sigma * h->length));
	mv happened = m & lt(free, sigma * h->length);
	fv length = SEL(happened, free * (1.f / sigma), h->length);
	struct collision c = { happened, add(g->entry, scale(g->along, length)), g->t0 + length, IV(v->n_classes), IV(NONE), IV(0) };
	EACH_WAVE(j) {
		fv own = of_wave(s, t->extinction, 0, m, w, j);
		flight_pdf[j] = expneg(own * length) * SEL(c.happened, own, FV(1.f));
		if (CARRIED > 1 && any(m & g->forced))
			SET(g->forced, flight_pdf[j], flight_pdf[j] / one_less_exp(fv_max(own * h->length, FV(1e-30f))));
	}
	return c;
}

#endif

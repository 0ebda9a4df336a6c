/* surface - what ends a ray: the ground and quads. */
#ifndef KERN_SURFACE_H
#define KERN_SURFACE_H

#include "render/kern/ray.h"

#define GROUND (-2)

/* Distance along a ray to a quad, FAR if it passes by. */
FN fv quad_distance(const struct surface *q, struct ray r)
{
	struct vec n = load3(q->normal), from = sub(r.from, load3(q->corner));
	fv t = -dot3(n, from) * inverse(dot3(n, r.along));
	struct vec at = add(from, scale(r.along, t));
	fv u = dot3(load3(q->dual[0]), at), v = dot3(load3(q->dual[1]), at);
	mv met = lt(FV(0.f), t) & lt(t, FV(FAR)) & le(FV(0.f), u) & le(u, FV(1.f)) & le(FV(0.f), v) & le(v, FV(1.f));
	return SEL(met, t, FV(FAR));
}

#define TIE 0.999998f    /* distances nearer to each other than this ratio are one: a few steps of a float */

/* Distance to the first surface, and which it is: the index of a quad, GROUND, or NONE at FAR. A quad that lies on the ground is
 * before it. */
FN fv surface_distance(const struct scene *s, struct ray r, iv *which)
{
	fv t = FV(FAR);
	*which = IV(NONE);
	if (HAS_GROUND) {
		t = (s->surfaces.ground_height - r.from.y) * inverse(r.along.y);
		mv met = lt(FV(0.f), t) & lt(t, FV(FAR));
		*which = SEL(met, IV(GROUND), *which);
		t = SEL(met, t, FV(FAR));
	}
	for (int i = 0; i < s->surfaces.n; i++) {
		fv own = quad_distance(&s->surfaces.surface[i], r);
		mv met = lt(own, t) | (ieq(*which, IV(GROUND)) & lt(own * TIE, t));
		SET(met, t, own);
		SET(met, *which, IV(i));
	}
	return t;
}

#endif

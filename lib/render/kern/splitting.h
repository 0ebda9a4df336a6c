/* splitting - a camera ray goes on in several branches from where the medium first scatters it. What a branch adds is divided among all
 * of them. Each is, from there on, a sample with random numbers of its own, so that any number of branches is unbiased; it saves what
 * the camera ray cost. */
#ifndef KERN_SPLITTING_H
#define KERN_SPLITTING_H

#include "render/kern/path_state.h"

/* Camera rays m have been scattered by the medium for the first time: keep that. Lanes split.again return to it for the next branch. */
FN void split_path(const struct scene *s, struct path *p, mv m)
{
	mv again = p->split.again, often = ilt(IV(1), p->order);
	struct split *split = &p->split;
	EACH_WAVE(j) {
		SET(m, p->weight[j], p->weight[j] * s->branch_share);
		SET(m, split->weight[j], p->weight[j]);
		SET(m, split->path_pdf[j], p->path_pdf[j]);
		SET(m, split->peak_share[j], p->peak_share[j]);
		SET(again, p->weight[j], split->weight[j]);
		SET(again, p->path_pdf[j], split->path_pdf[j]);
		SET(again, p->peak_share[j], split->peak_share[j]);
	}
	set3(m, &split->along, p->ray.along);
	set_vertex(m, &split->vertex, p->vertex);
	SET(m, split->counter, p->random.counter);
	set3(again, &p->ray.along, split->along);
	set_vertex(again, &p->vertex, split->vertex);
	SET(again, p->random.counter, split->counter);
	for (int i = 0; i < CHANNELS; i++) {    /* what the branch before saw */
		SET(again, p->aside[0][i], p->aside[0][i] + SEL(often, p->before[1][i], p->rgb[i]));
		SET(again, p->aside[1][i], p->aside[1][i] + SEL(often, p->rgb[i], FV(0.f)));
		SET(again, p->rgb[i], FV(0.f));
	}
	SET(again, p->order, IV(1));
	SET(m, split->left, IV(s->branches - 1));
	SET(again, split->left, split->left - 1);
	SET(again, split->branch, split->branch + 1u);
	another_sample(m | again, &p->random, split->branch);
	if (LANES_WAIT)
		set_random(m | again, &p->walk_random, p->random);
}

/* Paths m are over. Returns those that are with all their branches; the others are split.again. */
FN mv split_over(struct path *p, mv m)
{
	p->split.again = m & ilt(IV(0), p->split.left);
	return m & NOT(p->split.again);
}

#endif

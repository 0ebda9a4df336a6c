/* gather - the particles around a ray: each is met with the probability C / A, where C is its extinction cross section at a
 * wavelength and A the area of the cylinder around the ray that must hold its centre. A = C is the explicit model (a disc that the
 * ray meets or not), a larger A the fat ray, whose transmittance prod(1 - C/A) has the same mean. */
#ifndef KERN_GATHER_H
#define KERN_GATHER_H

#include "render/kern/random.h"
#include "render/kern/ray.h"

enum { GATHER_FIRST, GATHER_ALL };

/* Where the particle is first, or what is left after all. */
struct gathered {
	float depth[MAX_WAVES];    /* of the first particle met, counted from entry */
	int id[MAX_WAVES];         /* the particle, or NONE */
	float through[MAX_WAVES];  /* transmittance */
	struct vec entry;          /* where the ray comes to the particles: from afar, floats would be too coarse */
};

/* Probability that a particle at squared distance d2 from the ray is met at a wavelength. */
FN float meeting(const struct scene *s, const struct tables *tab, int class, int wave, float d2, float area)
{
	float disc = tab->disc[class * s->n_waves + wave];    /* C / pi */
	if (s->transport == TRANSPORT_EXPLICIT)
		return d2 < disc ? 1.f : 0.f;
	float share = PI * disc / area;
	return s->attenuation == ATTENUATION_EXPONENTIAL ? 1.f - expneg(share) : least(share, 1.f);
}

/* A number in [0, 1) of a particle and a vertex; for all wavelengths the same, so that they meet the same particles. */
FN float coin(const struct random *random, int id)
{
	uint32 bits = mix((uint32)id * 0x9e3779b1u + random->counter, random->key ^ 0x5bd1e995u);
	return least((float)bits * 0x1p-32f, 0x1.fffffep-1f);
}

/* Take one particle into account. */
FN void gather_one(const struct scene *s, const struct tables *tab, struct ray r, float ahead, float limit, struct waves w,
                   const struct random *random, int mode, int n, float reach2, struct gathered *g)
{
	GLOBAL const float *q = tab->particle + 4 * (long)n;
	struct vec v = vec3(q[0] - g->entry.x, q[1] - g->entry.y, q[2] - g->entry.z);
	float depth = dot3(v, r.along);
	struct vec off = sub(v, scale(r.along, depth));    /* no cancellation of squares */
	float d2 = dot3(off, off);
	if (!(d2 < reach2) || !(depth > ahead) || !(depth < limit) || n == r.skip)
		return;
	int class = (int)float_bits(q[3]);
	float toss = mode == GATHER_FIRST && s->transport == TRANSPORT_FAT_RAY ? coin(random, n) : 0.f;
	for (int j = 0; j < w.n; j++) {
		float p = meeting(s, tab, class, wave_of(w, j), d2, r.area);
		if (mode == GATHER_ALL)
			g->through[j] *= 1.f - p;
		else if (toss < p && depth < g->depth[j]) {
			g->depth[j] = depth;
			g->id[j] = n;
		}
	}
}

/* The indices of cells [*from, *to] along an axis that [low, high] touches; 0 if none. */
FN int cell_range(float low, float high, float origin, float cell, int n, int *from, int *to)
{
	float a = (low - origin) / cell, b = (high - origin) / cell;
	if (!(b >= 0.f) || !(a < (float)n))
		return 0;
	*from = (int)most(a, 0.f);
	*to = (int)least(b, (float)(n - 1));
	return 1;
}

/* All particles whose centre lies within the query's radius of the ray before t_end: layer by layer of cells along the ray's
 * main axis, in each layer the cells that the cylinder cuts. Every particle lies in one cell and is looked at once.
 * GATHER_FIRST finds for each wavelength the first particle met, GATHER_ALL the transmittance. */
FN void gather(const struct scene *s, const struct tables *tab, struct ray r, float t_end, struct waves w,
               const struct random *random, int mode, struct gathered *g)
{
	float reach2 = s->transport == TRANSPORT_EXPLICIT ? s->largest : r.area / PI, reach = root(reach2) * 1.00001f, t0, t1;
	clip_box(r, s->grid_low, s->grid_high, reach, &t0, &t1);
	g->entry = add(r.from, scale(r.along, t0));
	t1 = least(t1, t_end) - t0;
	float limit = t_end - t0, ahead = -t0;
	for (int j = 0; j < w.n; j++) {
		g->depth[j] = limit;
		g->id[j] = NONE;
		g->through[j] = 1.f;
	}
	if (!(t1 > 0.f))
		return;
	const float at[3] = { g->entry.x, g->entry.y, g->entry.z }, d[3] = { r.along.x, r.along.y, r.along.z };
	float size[3] = { d[0] < 0.f ? -d[0] : d[0], d[1] < 0.f ? -d[1] : d[1], d[2] < 0.f ? -d[2] : d[2] };
	int a = size[0] > size[1] ? (size[0] > size[2] ? 0 : 2) : (size[1] > size[2] ? 1 : 2), b = (a + 1) % 3, c = (a + 2) % 3;
	float inv = 1.f / d[a], slope_b = d[b] * inv, slope_c = d[c] * inv;
	/* how far a centre can be from the ray along each axis: in a plane across axis a, and along a */
	float wide_b = reach * root(1.f + slope_b * slope_b), wide_c = reach * root(1.f + slope_c * slope_c);
	float wide_a = reach * root(most(0.f, 1.f - d[a] * d[a]));
	float start = at[a], end = at[a] + d[a] * t1;
	int low[3], high[3], first, last;
	if (!cell_range(least(start, end) - wide_a, most(start, end) + wide_a, s->grid_low[a], s->cell[a], s->cells[a], &first, &last))
		return;
	int step = d[a] > 0.f ? 1 : -1;
	for (int i = step > 0 ? first : last; i >= first && i <= last; i += step) {
		float face = s->grid_low[a] + (float)i * s->cell[a] - at[a];
		float b0 = at[b] + face * slope_b, b1 = b0 + s->cell[a] * slope_b;
		float c0 = at[c] + face * slope_c, c1 = c0 + s->cell[a] * slope_c;
		low[a] = high[a] = i;
		if (cell_range(least(b0, b1) - wide_b, most(b0, b1) + wide_b, s->grid_low[b], s->cell[b], s->cells[b], &low[b], &high[b])
		    && cell_range(least(c0, c1) - wide_c, most(c0, c1) + wide_c, s->grid_low[c], s->cell[c], s->cells[c], &low[c], &high[c]))
			for (int z = low[2]; z <= high[2]; z++)
				for (int y = low[1]; y <= high[1]; y++) {
					int row = (z * s->cells[1] + y) * s->cells[0];
					uint32 to = tab->first[row + high[0] + 1];
					for (uint32 n = tab->first[row + low[0]]; n < to; n++)
						gather_one(s, tab, r, ahead, limit, w, random, mode, (int)n, reach2, g);
				}
		/* what further layers can still change */
		float next = (step > 0 ? face + s->cell[a] : face) * inv - wide_a * (inv < 0.f ? -inv : inv), furthest = 0.f, brightest = 0.f;
		for (int j = 0; j < w.n; j++) {
			furthest = most(furthest, g->depth[j]);
			brightest = most(brightest, g->through[j]);
		}
		if (mode == GATHER_FIRST ? furthest <= next : !(brightest > 0.f))
			return;
	}
}

#endif

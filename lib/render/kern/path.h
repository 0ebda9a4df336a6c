/* path - light paths from the camera, one a lane: flights, scattering, next-event estimation, all wavelengths of a path at once.
 *
 * A path is sampled for one of its wavelengths, the hero, each equally probable. weight[j] is the throughput of wavelength j
 * (albedos, roulette), density[j] the probability density of the path had j been the hero, divided by its mean over j.
 * By the balance heuristic over heroes wavelength j then contributes weight[j] density[j] times what it sees: no wavelength is
 * favoured, and one whose own disc would not have been met has density 0 from there on.
 *
 * Next-event estimation under a high forward peak gives spikes: p towards a sun is huge in the rare case that the path travels that
 * way. So p is taken as what is below a cap and the peak above it. Of the scatterings of any path to a sun, one is the last below
 * the cap, and those after it are peaks. At each vertex, what is below the cap is estimated as that last one: by a detour of n further
 * scatterings by the peak, n being geometric, whose directions are drawn backwards from the sun and whose flights go forward.
 * What is evaluated is then at most cap / (1 - peak). Paths that may have been scattered by peaks alone, from the camera or the ground on, are
 * weighed by the share of their density that was: for them the sun is estimated by the peak at the vertex, and met by chance. A sun so
 * large that multiple importance sampling bounds its spikes lower is left to that.
 *
 * A vertex has two parts, since the paths of different lanes take marches of different lengths: path_arrive, when its flight has
 * ended, which scatters and sends out the shadow ray; path_depart, when that has ended, which takes the light in and sets out for
 * the next vertex. Between the parts a lane may wait for others; what it computes does not depend on that. */
#ifndef KERN_PATH_H
#define KERN_PATH_H

#include "render/kern/light.h"
#include "render/kern/phase.h"

/* A camera ray where the medium first scatters it, kept for the branches that go on from there. */
struct stem {
	struct vec along, point;
	iv class, id;
	fv weight[CARRIED], density[CARRIED], peaked[CARRIED];
	uv counter;                /* of its random numbers */
};

struct path {
	struct ray ray;
	struct waves waves;
	iv hero;
	fv weight[CARRIED], density[CARRIED];
	fv chance;                 /* density of the ray's direction, sr^-1; 0 from the camera, where no light is drawn */
	struct random random;
	fv rgb[3];                 /* seen since the medium last scattered the path */
	iv order;                  /* times that it did, from 2 on 2; reflections by surfaces do not count */
	fv before[2][3];           /* what was seen unscattered, and scattered once, of an order that is over */
	fv aside[2][3];            /* what came by detours, or by branches that are over, scattered once and more often on the whole */
	fv depth;                  /* along the camera's ray to where the medium scattered it, -1 if it did not */
	fv spectrum[CARRIED];      /* all that was seen, by wavelength; kept for spectral images */
	/* on the way: in flight to a surface or beyond, or from a vertex to a light */
	struct march march;
	mv flying;
	fv t_end;
	iv surface;
	/* from a vertex to a light by a detour */
	mv detour;                 /* in flight on one */
	iv turns, left;            /* its scatterings by the peak, in all and still to come */
	struct vec sun;            /* to the light */
	fv by_detour[CARRIED];     /* the path's density and the detour's, as density[] */
	fv peaked[CARRIED];        /* the share of the path's density, from the camera or the ground on, that peaks alone have */
	struct random random_there;    /* of the march: the vertex's, or the detour's own */
	/* branches, see path_branch */
	uv branch;                 /* counts all samples' branches of a pixel */
	iv branches;               /* still to come */
	mv again;                  /* back at the stem's end, for the next one */
	struct stem stem;
	/* the vertex */
	struct vec point;
	iv class, id;              /* class NONE is the ground */
	fv lit[CARRIED], lamp[3];  /* what the light drawn adds through a clear medium: wavelength j sees lit[j] lamp[] */
};

#define ISOTROPIC 0.0795774715f    /* sr^-1 */

enum { DRAW_PIXEL_X, DRAW_PIXEL_Y, DRAW_HERO };

/* Of one wavelength the density is its own mean. */
#define DENSITY(p, j) (CARRIED == 1 ? FV(1.f) : (p)->density[j])

/* Wavelengths of lanes m see k rgb[], which is added to into[]. A light's colour multiplies the film's channels, so that it is seen as
 * it is, whatever the wavelengths; the wavelength itself sees the mean of the light's channels that its own colour gives. */
FN void see_into(const struct scene *s, const struct tables *t, struct path *p, mv m, int j, fv k, const fv *rgb, fv *into)
{
	fv seen = p->weight[j] * k;
	for (int i = 0; i < CHANNELS; i++) {
#ifdef WAVES
		fv c = FV(float_at(t->colour, 6 * j + i)), share = FV(float_at(t->colour, 6 * j + 3 + i));
#else
		iv row = 6 * wave_of(s, p->waves, j) + i;
		fv c = gather(m, t->colour, row), share = gather(m, t->colour, row + 3);
#endif
		fv add = SEL(m, seen * rgb[i], FV(0.f));
		into[i] += c * add;
		if (SPECTRAL)       /* all three shares, of one channel */
			p->spectrum[j] += CHANNELS == 1 ? add : share * add;
	}
}

FN void see(const struct scene *s, const struct tables *t, struct path *p, mv m, int j, fv k, const fv *rgb)
{
	see_into(s, t, p, m, j, k, rgb, p->rgb);
}

/* The medium scatters paths m at distance t: what they see from here on belongs to the next order. */
FN void scattered(const struct scene *s, struct path *p, mv m, fv t)
{
	m &= ilt(p->order, IV(2));
	if (!any(m))
		return;
	SET(m & ieq(p->order, IV(0)) & le(p->chance, FV(0.f)), p->depth, t);
	EACH(k, 2) {
		mv over = m & ieq(p->order, IV(k));
		for (int i = 0; i < CHANNELS; i++)
			SET(over, p->before[k][i], p->rgb[i]);
	}
	for (int i = 0; i < CHANNELS; i++)
		SET(m, p->rgb[i], FV(0.f));
	SET(m, p->order, p->order + 1);
}

/* Take event[j] into densities; returns their mean over the wavelengths, 0 if the path cannot be (it then ends). */
FN fv take_event(const struct scene *s, struct waves w, fv *density, mv m, const fv *event)
{
	fv mean = FV(0.f), own[CARRIED];
	if (CARRIED == 1)
		return event[0];
	EACH_WAVE(j) {
		own[j] = density[j] * event[j];
		mean += own[j];
	}
	mean /= to_float(w.n);
	EACH_WAVE(j)
		SET(m, density[j], SEL(lt(FV(0.f), mean), own[j] / mean, FV(0.f)));
	return mean;
}

/* New paths in lanes m: a sample of a pixel. */
FN void path_begin(const struct scene *s, struct path *p, mv m, iv pixel, iv column, iv row, iv sample)
{
	struct random random = random_of(s->seed, unsigned_of(pixel), unsigned_of(sample));
	set_random(m, &p->random, random);
	fv x = (to_float(column) + draw(&p->random, DRAW_PIXEL_X)) * (2.f / (float)s->width) - 1.f;
	fv y = 1.f - (to_float(row) + draw(&p->random, DRAW_PIXEL_Y)) * (2.f / (float)s->height);
	struct vec along = unit3(add(load3(s->forward), add(scale(load3(s->right), x), scale(load3(s->up), y))));
	set3(m, &p->ray.from, load3(s->eye));
	set3(m, &p->ray.along, along);
	set3(m, &p->ray.inverse, inverse3(along));
	SET(m, p->ray.skip, IV(NONE));
	/* groups of wavelengths take turns, each pixel from another one on: any share of samples is unbiased, full turns are even */
	if (s->n_groups > 1) {
		uv turn = unsigned_of(sample) + mix(unsigned_of(pixel), UV(s->seed));
		SET(m, p->waves.first, signed_of(turn % (uint32)s->n_groups));
	}
	SET(m, p->waves.n, s->carried - SEL(ilt(p->waves.first + s->n_groups * (s->carried - 1), IV(s->n_waves)), IV(0), IV(1)));
	SET(m, p->hero, CARRIED > 1 ? to_int(draw(&p->random, DRAW_HERO) * to_float(p->waves.n)) : IV(0));
	EACH_WAVE(j) {
		SET(m, p->weight[j], FV((float)s->n_groups));
		SET(m, p->density[j], SEL(ilt(IV(j), p->waves.n), FV(1.f), FV(0.f)));
		SET(m, p->spectrum[j], FV(0.f));
		SET(m, p->peaked[j], FV(1.f));
	}
	SET(m, p->chance, FV(0.f));
	SET(m, p->depth, FV(-1.f));
	SET(m, p->order, IV(0));
	for (int i = 0; i < CHANNELS; i++) {
		SET(m, p->rgb[i], FV(0.f));
		SET(m, p->before[0][i], FV(0.f));
		SET(m, p->before[1][i], FV(0.f));
		SET(m, p->aside[0][i], FV(0.f));
		SET(m, p->aside[1][i], FV(0.f));
	}
	SET(m, p->branch, unsigned_of(sample) * (uint32)s->branches);
	SET(m, p->branches, IV(0));
	next_vertex(&p->random, m);
}

/* Paths m set out on a flight from where they are. */
FN void path_fly(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	iv surface;
	fv t_end = surface_distance(s, p->ray, &surface);
	PUT(m, p->t_end, t_end);
	PUT(m, p->surface, surface);
	p->flying |= m;
	if (LANES_WAIT)
		set_random(m, &p->random_there, p->random);
	march_begin(s, t, &p->march, m, p->ray, t_end, ALL_LANES, p->waves, p->hero, &p->random);
}

/* What ends paths m, which did not scatter: a quad, or what lies behind everything. */
FN void see_end(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	fv rgb[3], suns[3];
	sky_radiance(s, t, m, p->ray.along, p->chance, rgb, suns);
	for (int i = 0; i < s->n_lights; i++) {
		mv own = m & ieq(p->surface, IV(i));
		if (any(own)) {
			fv quad[3];
			quad_radiance(s, i, p->ray, p->t_end, p->chance, quad);
			EACH(c, 3) {
				SET(own, rgb[c], quad[c]);
				SET(own, suns[c], FV(0.f));
			}
		}
	}
	EACH_WAVE(j) {
		see(s, t, p, m, j, DENSITY(p, j), rgb);
		see(s, t, p, m, j, PEAK ? DENSITY(p, j) * p->peaked[j] : DENSITY(p, j), suns);
	}
}

/* ------------------------------------------------------------------ detours */

#define PEAK_CLASS (s->n_classes + 1)    /* its phase function is the peak */

/* Random numbers of the k-th scattering of a detour, counted from the sun. */
FN struct random detour_random(const struct path *p, iv k)
{
	struct random r = p->random;
	r.key = r.shift = mix(unsigned_of(k) * 0x9e3779b1u, p->random.key ^ 0x2c1b3c6du);
	r.lattice = UV(0);
	return r;
}

/* Directions from which n scatterings by the peak turn to a sun; their density is taken into density[j]. */
FN struct vec detour_direction(const struct scene *s, const struct tables *t, struct path *p, mv m, iv n, struct vec sun, fv *density)
{
	for (int k = 1; any(m &= NOT(ilt(n, IV(k)))); k++) {
		struct random r = detour_random(p, IV(k));
		fv sn, cs, value[CARRIED];
		phase_draw(s, t, m, PEAK_CLASS, IV(0), p->waves, p->hero, draw_bits(&r, DRAW_ANGLE), draw_bits(&r, DRAW_PLACE), &sn, &cs, value);
		take_event(s, p->waves, density, m, value);
		set3(m, &sun, to_world(sun, sn, cs, 2.f * PI * draw(&r, DRAW_AZIMUTH)));
	}
	return sun;
}

/* The next march of detours m, from a point: a flight, or at last the shadow ray. */
FN void detour_on(const struct scene *s, const struct tables *t, struct path *p, mv m, struct ray r, fv t_end)
{
	mv flight = NO_LANE;
	if (PEAK) {       /* else random_there is still the flight's that came here, of the same vertex */
		struct random own = detour_random(p, -p->left);
		flight = ilt(IV(0), p->left);
		set_random(m, &p->random_there, p->random);
		set_random(m & flight, &p->random_there, own);
		SET_TRUTH(m, p->detour, flight);
	}
	march_begin(s, t, &p->march, m, r, t_end, flight, p->waves, p->hero, &p->random_there);
}

/* Flights of detours m have ended. */
FN void detour_arrive(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	fv event[CARRIED], none[CARRIED];
	struct collision c = flight_end(s, t, &p->march, m, p->waves, p->hero, &p->random_there, event);
	fv mean = take_event(s, p->waves, p->by_detour, m, event);
	mv hit = m & c.happened & lt(FV(0.f), mean);
	p->detour &= NOT(m);
	EACH_WAVE(j) {
		fv albedo = of_class(s, t->albedo, hit, c.class, p->waves, j);
		SET(m, p->lit[j], SEL(hit, p->lit[j] * albedo, FV(0.f)));
		none[j] = FV(0.f);     /* densities of the directions were taken in at the vertex */
	}
	if (!any(hit))
		return;
	SET(hit, p->left, p->left - 1);
	struct vec along = detour_direction(s, t, p, hit, p->left, p->sun, none);
	struct ray r = { c.point, along, inverse3(along), c.id };
	iv surface;
	fv t_end = surface_distance(s, r, &surface);
	mv blocked = hit & ieq(p->left, IV(0)) & NOT(ieq(surface, IV(NONE)));
	EACH_WAVE(j)
		SET(blocked, p->lit[j], FV(0.f));
	detour_on(s, t, p, hit & NOT(blocked), r, t_end);
}

/* ------------------------------------------------------------------ vertices */

/* Next-event estimation at vertices m, before the march to the light is known: lit, lamp, and that march. */
FN void path_light(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	struct light_sample d;
	light_choose(s, t, m, p->point, &p->random, &d);
	mv ground = ieq(p->class, IV(NONE)), sunny = PEAK ? d.shines & d.small & NOT(ground) : NO_LANE;
	struct vec along = d.along, inverse = d.inverse;
	fv value[CARRIED], by_detour[CARRIED], chance = FV(0.f);
	mv straight = ALL_LANES;
	EACH_WAVE(j)
		by_detour[j] = DENSITY(p, j);
	if (PEAK) {
		SET(m, p->left, IV(0));
		SET(m, p->turns, IV(0));
	}
	if (any(sunny)) {
		fv u = draw(&p->random, DRAW_DETOUR) + 0x1p-25f;
		SET(sunny, p->left, to_int(neglog(u) * s->detours));
		SET(sunny, p->turns, p->left);
		straight = ieq(p->left, IV(0));
		along = detour_direction(s, t, p, sunny, p->left, along, by_detour);
		inverse = inverse3(along);
		set3(sunny, &p->sun, d.along);
	}
	if (ALL_ISOTROPIC)
		EACH_WAVE(j)
			value[j] = FV(ISOTROPIC);
	else
		phase_value(s, t, d.shines & NOT(ground), p->class, angle_between(p->ray.along, along), p->waves, value);
	if (HAS_GROUND) {       /* on the side that the path comes from */
		fv cosine = fv_max(FV(0.f), SEL(lt(p->ray.along.y, FV(0.f)), along.y, -along.y));
		EACH_WAVE(j)
			SET(ground, value[j], cosine / PI);
		d.shines &= NOT(ground) | lt(FV(0.f), cosine);
	}
	/* straight to the light, unless by a detour */
	struct ray r = { p->point, along, inverse, p->id };
	iv surface;
	fv t_end = surface_distance(s, r, &surface);
	d.shines &= NOT(straight) | NOT(light_blocked(&d, surface, t_end));
	EACH_WAVE(j)
		chance += value[j] * DENSITY(p, j);
	if (CARRIED > 1)
		chance /= to_float(p->waves.n);
	fv k = FV((float)s->n_drawn), alone = k;    /* of parallel light */
	mv extended = m & lt(FV(0.f), d.density);
	if (any(extended)) {
		SET(extended, k, 1.f / (d.density + chance));
		SET(extended, alone, 1.f / d.density);
	}
	fv scattered = FV(0.f);
	EACH_WAVE(j) {
		fv lit = value[j] * k, density = DENSITY(p, j);
		if (PEAK) {
			fv low = fv_min(value[j], of_wave(s, t->cap, 0, m, p->waves, j));
			fv high = SEL(straight, (value[j] - low) * p->peaked[j] * k, FV(0.f));
			lit = SEL(sunny, (low * alone + high) * (1.f / (1.f - s->peak)), lit);
			density = by_detour[j];
			SET(m, p->by_detour[j], density);
		}
		PUT(m, p->lit[j], SEL(d.shines, lit, FV(0.f)));
		scattered = fv_max(scattered, lit * density / alone);
	}
	for (int i = 0; i < CHANNELS; i++)
		PUT(m, p->lamp[i], d.rgb[i]);
	if (MARCHES || PEAK) {     /* a march to a sun is long: where less is scattered than evenly, it is made as seldom, and counts the more */
		fv q = SEL(d.sun & NOT(ground), fv_min(FV(1.f), scattered * (1.f / ISOTROPIC)), FV(1.f));
		d.shines &= lt(draw(&p->random, DRAW_SHADOWED), q);
		EACH_WAVE(j)
			SET(m, p->lit[j], SEL(d.shines, p->lit[j] * (1.f / fv_max(q, FV(1e-20f))), FV(0.f)));
	}
	detour_on(s, t, p, d.shines, r, SEL(straight, d.t_end, t_end));
}

/* Camera rays m have been scattered by the medium for the first time. Where they take several ways from there, this is kept, and
 * lanes p->again return to it for the next one. What a branch adds is divided among all of them. Each is, from here on, a sample
 * with random numbers of its own, so that any number of branches is unbiased; it saves what the camera ray cost. */
FN void path_branch(const struct scene *s, struct path *p, mv m)
{
	mv again = p->again, often = ilt(IV(1), p->order);
	struct stem *stem = &p->stem;
	EACH_WAVE(j) {
		SET(m, p->weight[j], p->weight[j] * s->branch_share);
		SET(m, stem->weight[j], p->weight[j]);
		SET(m, stem->density[j], p->density[j]);
		SET(m, stem->peaked[j], p->peaked[j]);
		SET(again, p->weight[j], stem->weight[j]);
		SET(again, p->density[j], stem->density[j]);
		SET(again, p->peaked[j], stem->peaked[j]);
	}
	set3(m, &stem->along, p->ray.along);
	set3(m, &stem->point, p->point);
	SET(m, stem->class, p->class);
	SET(m, stem->id, p->id);
	SET(m, stem->counter, p->random.counter);
	set3(again, &p->ray.along, stem->along);
	set3(again, &p->point, stem->point);
	SET(again, p->class, stem->class);
	SET(again, p->id, stem->id);
	SET(again, p->random.counter, stem->counter);
	for (int i = 0; i < CHANNELS; i++) {    /* what the branch before saw */
		SET(again, p->aside[0][i], p->aside[0][i] + SEL(often, p->before[1][i], p->rgb[i]));
		SET(again, p->aside[1][i], p->aside[1][i] + SEL(often, p->rgb[i], FV(0.f)));
		SET(again, p->rgb[i], FV(0.f));
	}
	SET(again, p->order, IV(1));
	SET(m, p->branches, IV(s->branches - 1));
	SET(again, p->branches, p->branches - 1);
	SET(again, p->branch, p->branch + 1u);
	another_sample(m | again, &p->random, p->branch);
	if (LANES_WAIT)
		set_random(m | again, &p->random_there, p->random);
}

/* Flights of lanes m have ended. Returns the lanes whose path is over. */
FN mv path_arrive(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	fv event[CARRIED];
	struct collision c = flight_end(s, t, &p->march, m, p->waves, p->hero, &p->random, event);
	mv alive = m & lt(FV(0.f), take_event(s, p->waves, p->density, m, event));
	mv hit = alive & c.happened, ground = alive & NOT(c.happened) & ieq(p->surface, IV(GROUND)), out = alive & NOT(hit | ground);
	mv over = m & NOT(hit | ground);
	p->flying &= NOT(m);
	if (any(out))
		see_end(s, t, p, out);
	m = hit | ground;
	PUT3(m, p->point, c.point);
	PUT(m, p->class, c.class);
	PUT(m, p->id, c.id);
	mv first = hit & ieq(p->order, IV(0));
	scattered(s, p, hit, c.t);
	if (HAS_GROUND) {
		struct vec floor = add(p->ray.from, scale(p->ray.along, p->t_end));
		floor.y = FV(s->ground_height);
		set3(ground, &p->point, floor);
		SET(ground, p->class, IV(NONE));
		SET(ground, p->id, IV(NONE));
	}
	EACH_WAVE(j) {
		fv albedo = of_class(s, t->albedo, hit, p->class, p->waves, j);
		PUT(m, p->weight[j], p->weight[j] * (HAS_GROUND ? SEL(hit, albedo, FV(s->ground_albedo)) : albedo));
	}
	if (BRANCHES && any(first | p->again)) {
		path_branch(s, p, first);
		m |= p->again;
	}
	if (s->n_drawn)
		path_light(s, t, p, m);
	return over;
}

/* Roulette on the throughput of a branch: survival is certain above 1/4, and 4 times the throughput below, never less than it. */
FN mv survives(const struct scene *s, struct path *p, mv m)
{
	fv throughput = FV(0.f);
	EACH_WAVE(j)
		throughput = fv_max(throughput, p->weight[j] * DENSITY(p, j));
	fv q = 4.f * (float)s->branches * throughput;
	mv doubtful = m & lt(q, FV(1.f));
	if (!any(doubtful))
		return m;
	EACH_WAVE(j)
		SET(doubtful, p->weight[j], p->weight[j] / q);
	return m & (NOT(doubtful) | lt(draw(&p->random, DRAW_ROULETTE), q));
}

/* Shadow rays of lanes m have ended. Returns the lanes whose path is over. */
FN mv path_depart(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	fv through[CARRIED], value[CARRIED], sn, cs;
	if (s->n_drawn) {
		shadow_end(s, t, &p->march, m, p->waves, through);
		EACH_WAVE(j) {
			fv lit = p->lit[j] * (PEAK ? CARRIED > 1 ? p->by_detour[j] : FV(1.f) : DENSITY(p, j));
			mv lighted = m & lt(FV(0.f), lit), straight = PEAK ? lighted & ieq(p->turns, IV(0)) : lighted, once;
			see(s, t, p, straight, j, lit * through[j], p->lamp);
			if (!PEAK || !any(lighted & NOT(straight)))
				continue;
			once = ieq(p->order + p->turns, IV(1));
			see_into(s, t, p, lighted & NOT(straight) & once, j, lit * through[j], p->lamp, p->aside[0]);
			see_into(s, t, p, lighted & NOT(straight | once), j, lit * through[j], p->lamp, p->aside[1]);
		}
	}
	mv on = survives(s, p, m), ground = HAS_GROUND ? on & ieq(p->class, IV(NONE)) : NO_LANE, hit = on & NOT(ground);
	struct vec axis = p->ray.along, along;
	fv azimuth = 2.f * PI * draw(&p->random, DRAW_AZIMUTH);
	if (ALL_ISOTROPIC) {
		fv u = draw(&p->random, DRAW_COSINE);
		cs = 1.f - 2.f * u;
		sn = 2.f * fv_sqrt(u * (1.f - u));
		EACH_WAVE(j)
			value[j] = FV(ISOTROPIC);
	} else {
		phase_draw(s, t, hit, s->only_class, p->class, p->waves, p->hero, draw_bits(&p->random, DRAW_ANGLE), draw_bits(&p->random, DRAW_PLACE), &sn, &cs,
		           value);
	}
	fv chance = take_event(s, p->waves, p->density, hit, value);
	if (PEAK)
		EACH_WAVE(j) {
			fv high = fv_max(FV(0.f), value[j] - of_wave(s, t->cap, 0, m, p->waves, j));
			SET(on, p->peaked[j], SEL(ground, FV(1.f), SEL(hit & lt(FV(0.f), high), p->peaked[j] * high / value[j], FV(0.f))));
		}
	if (HAS_GROUND) {       /* cosine-distributed */
		fv u = draw(&p->random, DRAW_COSINE);
		SET(ground, sn, fv_sqrt(u));
		SET(ground, cs, fv_sqrt(1.f - u));
		SET(ground, chance, cs / PI);
		set3(ground, &axis, vec3(FV(0.f), SEL(lt(p->ray.along.y, FV(0.f)), FV(1.f), FV(-1.f)), FV(0.f)));
	}
	if (ALL_ISOTROPIC && !HAS_GROUND) {    /* about any axis */
		fv x, y;
		fv_sincos(azimuth, &y, &x);
		along = vec3(sn * x, sn * y, cs);
	} else {
		along = to_world(axis, sn, cs, azimuth);
	}
	PUT(on, p->chance, chance);
	PUT3(on, p->ray.along, along);
	PUT3(on, p->ray.inverse, inverse3(along));
	PUT3(on, p->ray.from, p->point);
	PUT(on, p->ray.skip, p->id);
	next_vertex(&p->random, m);
	return m & NOT(on & lt(FV(0.f), chance));
}

#endif

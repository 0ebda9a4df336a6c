/* path - light paths from the camera, one a lane: flights, scattering, next-event estimation, all wavelengths of a path at once.
 *
 * A vertex has two parts, since the paths of different lanes take walks of different lengths: path_arrive, when its flight has
 * ended, which scatters and sends out the shadow ray; path_depart, when that has ended, which takes the light in and sets out for
 * the next vertex. Between the parts a lane may wait for others; what it computes does not depend on that. */
#ifndef KERN_PATH_H
#define KERN_PATH_H

#include "render/kern/nee.h"

enum { DRAW_PIXEL_X, DRAW_PIXEL_Y, DRAW_HERO };

/* New paths in lanes m: a sample of a pixel. */
FN void path_begin(const struct scene *s, struct path *p, mv m, iv pixel, iv column, iv row, iv sample)
{
	struct random random = random_of(s->seed, unsigned_of(pixel), unsigned_of(sample));
	set_random(m, &p->random, random);
	struct ray r = camera_ray(&s->camera, to_float(column) + draw(&p->random, DRAW_PIXEL_X),
	                          to_float(row) + draw(&p->random, DRAW_PIXEL_Y));
	set3(m, &p->ray.from, r.from);
	set3(m, &p->ray.along, r.along);
	set3(m, &p->ray.inverse, r.inverse);
	SET(m, p->ray.skip, r.skip);
	/* groups of wavelengths take turns, each pixel from another one on: any share of samples is unbiased, full turns are even */
	if (s->n_groups > 1) {
		uv turn = unsigned_of(sample) + mix(unsigned_of(pixel), UV(s->seed));
		SET(m, p->waves.first, signed_of(turn % (uint32)s->n_groups));
	}
	SET(m, p->waves.n, s->carried - SEL(ilt(p->waves.first + s->n_groups * (s->carried - 1), IV(s->n_waves)), IV(0), IV(1)));
	SET(m, p->waves.hero, CARRIED > 1 ? to_int(draw(&p->random, DRAW_HERO) * to_float(p->waves.n)) : IV(0));
	EACH_WAVE(j) {
		SET(m, p->weight[j], FV((float)s->n_groups));
		SET(m, p->path_pdf[j], SEL(ilt(IV(j), p->waves.n), FV(1.f), FV(0.f)));
		SET(m, p->spectrum[j], FV(0.f));
		SET(m, p->spectral_alpha[j], FV(0.f));
		SET(m, p->peak_share[j], FV(1.f));
	}
	SET(m, p->direction_pdf, FV(0.f));
	SET(m, p->depth, FV(-1.f));
	SET(m, p->cover, FV(0.f));
	SET(m, p->rare, FV(1.f));
	SET(m, p->order, IV(0));
	for (int i = 0; i < CHANNELS; i++) {
		SET(m, p->rgb[i], FV(0.f));
		SET(m, p->before[0][i], FV(0.f));
		SET(m, p->before[1][i], FV(0.f));
		SET(m, p->aside[0][i], FV(0.f));
		SET(m, p->aside[1][i], FV(0.f));
		SET(m, p->alpha[i], FV(0.f));
	}
	next_vertex(&p->random, m);
}

/* Flights that may be forced to end in the medium: the camera's, but those to the ground. */
#define MAY_BE_FORCED(p) (ieq((p)->order, IV(0)) & FROM_CAMERA(p) & NOT(ieq((p)->surface, IV(GROUND))))

/* Paths m set out on a flight from where they are. */
FN void path_fly(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	iv surface;
	fv t_end = surface_distance(s, p->ray, &surface);
	PUT(m, p->t_end, t_end);
	PUT(m, p->surface, surface);
	p->flying |= m;
	if (LANES_WAIT)
		set_random(m, &p->walk_random, p->random);
	media_begin(s, t, &p->walk, m, p->ray, t_end, ALL_LANES, ieq(p->order, IV(0)) & FROM_CAMERA(p), p->waves, &p->random);
	if (KNOWS_DEPTH && TAKES_STEPS(&s->volume[0]) && any(m & MAY_BE_FORCED(p)))
		volume_measure(s, &s->volume[0], t, &p->walk.walk, m & MAY_BE_FORCED(p), p->waves);
}

/* What ends paths m, which did not scatter: a quad, or what lies behind everything. */
FN void path_leave(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	fv rgb[3], spikes[3];
	sky_radiance(s, t, m, p->ray.along, p->direction_pdf, rgb, spikes);
	for (int i = 0; i < s->surfaces.n; i++) {
		mv own = m & ieq(p->surface, IV(i));
		if (any(own)) {
			fv quad[3];
			surface_radiance(s, i, p->ray, p->t_end, p->direction_pdf, quad);
			EACH(c, 3) {
				SET(own, rgb[c], quad[c]);
				SET(own, spikes[c], FV(0.f));
			}
		}
	}
	EACH_WAVE(j) {
		add_radiance(s, t, p, m, j, PATH_PDF(p, j), rgb, p->rgb);
		add_radiance(s, t, p, m, j, HAS_PEAK ? PATH_PDF(p, j) * p->peak_share[j] : PATH_PDF(p, j), spikes, p->rgb);
	}
}

/* Camera rays m have come to their first surface, or been scattered before it: at wavelength j the medium took away taken[j] of what is
 * behind. */
FN void path_alpha(const struct scene *s, const struct tables *t, struct path *p, mv m, const fv *taken)
{
	EACH_WAVE(j) {
		fv add = SEL(m & ilt(IV(j), p->waves.n), taken[j] * (float)s->n_groups, FV(0.f));
		for (int i = 0; COLOURED && i < 3; i++) {
#ifdef WAVES
			p->alpha[i] += add * float_at(t->colour, 6 * j + i);
#else
			p->alpha[i] += add * gather(m, t->colour, 6 * wave_of(s, p->waves, j) + i);
#endif
		}
		if (SPECTRAL)
			p->spectral_alpha[j] += add;
	}
}

/* Where almost all of the camera's rays would pass the medium, chance makes black pixels and a few bright ones. There the first
 * scattering is forced: what is seen unscattered is taken in as it is, and the path goes on from a scattering with the weight that one
 * has. Where that weight is below FORCED_LEAST, chance decides once more, so that what is scattered does not vanish between the film's
 * units. A ray that ends at the ground, which lights it, is left to chance. */
#define FORCED_LEAST 0x1p-13f

/* Paths m as they are unscattered: taken[] is what the medium took away from them, flight_pdf[] theirs as they are scattered. */
FN void path_pass(const struct scene *s, const struct tables *t, struct path *p, mv m, fv *taken,
                  fv *flight_pdf)
{
	fv depth[CARRIED];
	volume_depth(s, &s->volume[0], t, &p->walk.walk, m, p->waves, depth);
	EACH_WAVE(j) {
		mv own = ilt(IV(j), p->waves.n);
		taken[j] = SEL(own, one_less_exp(depth[j]), FV(0.f));
		flight_pdf[j] = p->path_pdf[j];
		SET(m, p->path_pdf[j], SEL(own, FV(1.f), FV(0.f)));
		SET(m, p->weight[j], (float)s->n_groups * (1.f - taken[j]));
	}
}

/* They go on as they are scattered. */
FN void path_force(const struct scene *s, const struct tables *t, struct path *p, mv m, const fv *taken, const fv *flight_pdf)
{
	fv most = FV(0.f), mean = FV(0.f);
	EACH_WAVE(j) {
		most = fv_max(most, taken[j]);
		mean += taken[j];
		SET(m, p->path_pdf[j], flight_pdf[j]);
		SET(m, p->weight[j], (float)s->n_groups * taken[j]);
	}
	if (COLOURED || SPECTRAL)
		path_alpha(s, t, p, m, taken);
	SET(m, p->cover, mean / to_float(p->waves.n));
	SET(m, p->rare, 1.f / fv_max(most, FV(1e-30f)));
}

/* They are scattered at distance t. Returns those that chance ends there. */
FN mv path_forced(const struct scene *s, struct path *p, mv m, fv t)
{
	fv weight = FV(0.f), chance = fv_min(FV(1.f), (1.f / FORCED_LEAST) / p->rare);
	EACH_WAVE(j)
		weight += p->weight[j] * PATH_PDF(p, j);
	SET(m, p->depth, camera_distance(&s->camera, p->ray.along, t) * (weight / ((float)s->n_groups * to_float(p->waves.n))));
	mv on = m & lt(draw(&p->random, DRAW_FORCED), chance);
	EACH_WAVE(j)
		SET(on, p->weight[j], p->weight[j] / chance);
	SET(on, p->rare, p->rare * chance);
	return m & NOT(on);
}

/* Flights of lanes m have ended. Returns the lanes whose path is over. */
FN mv path_arrive(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	fv flight_pdf[CARRIED];
	mv forced = NO_LANE, thin = NO_LANE;
	if (KNOWS_DEPTH) {
		mv may = m & MAY_BE_FORCED(p);
		if (any(may)) {
			m &= NOT(volume_force(s, &s->volume[0], t, &p->walk.walk, may, p->waves, &p->random, &thin));
			forced = m & may & p->walk.walk.ray.forced;
		}
	}
	struct collision c = media_end(s, t, &p->walk, m, p->waves, &p->random, flight_pdf);
	mv alive = m & lt(FV(0.f), take_pdf(s, p->waves, p->path_pdf, m, flight_pdf));
	if (N_VOLUMES > 1)
		EACH_WAVE(j)
			SET(m, p->weight[j], p->weight[j] * media_kept(s, &p->walk, j));
	mv ground = alive & NOT(c.happened) & ieq(p->surface, IV(GROUND)), out = alive & NOT(c.happened | ground | forced);
	if (COLOURED || SPECTRAL) {
		mv seen = m & NOT(forced) & ieq(p->order, IV(0)) & FROM_CAMERA(p);
		fv taken[CARRIED];
		EACH_WAVE(j)    /* 1 less what is seen of light behind, so that both are one to the last bit */
			taken[j] = SEL(alive & NOT(c.happened), 1.f - PATH_PDF(p, j), FV(1.f));
		if (any(seen))
			path_alpha(s, t, p, seen, taken);
	}
	fv passed[CARRIED], kept_pdf[CARRIED];
	EACH_WAVE(j)    /* unused where none is thin, which a compiler does not see */
		passed[j] = kept_pdf[j] = FV(0.f);
	if (any(thin))
		path_pass(s, t, p, thin, passed, kept_pdf);
	if (any(out | thin))
		path_leave(s, t, p, out | thin);
	if (any(thin))
		path_force(s, t, p, thin, passed, kept_pdf);
	if (any(forced))
		alive &= NOT(path_forced(s, p, forced & alive & c.happened, c.t));
	mv hit = alive & c.happened, over = m & NOT(hit | ground);
	p->flying &= NOT(m);
	m = hit | ground;
	PUT3(m, p->vertex.point, c.point);
	PUT(m, p->vertex.class, c.class);
	PUT(m, p->vertex.id, c.id);
	if (N_VOLUMES > 1)
		SET(m, p->vertex.volume, c.volume);
	next_order(s, p, hit, c.t);
	if (HAS_GROUND) {
		struct vec floor = add(p->ray.from, scale(p->ray.along, p->t_end));
		floor.y = FV(s->surfaces.ground_height);
		set3(ground, &p->vertex.point, floor);
		PUT(m, p->vertex.kind, SEL(ground, IV(VERTEX_GROUND), IV(VERTEX_MEDIUM)));
		SET(ground, p->vertex.id, IV(NONE));
	}
	EACH_WAVE(j) {
		fv albedo = vertex_albedo(s, t, hit, &p->vertex, p->waves, j);
		PUT(m, p->weight[j], p->weight[j] * (HAS_GROUND ? SEL(hit, albedo, FV(s->surfaces.ground_albedo)) : albedo));
	}
	if (s->lights.n)
		nee_begin(s, t, p, m);
	return over;
}

/* Roulette on the throughput: survival is certain above 1/4, and 4 times the throughput below, never less than it. */
FN mv roulette(const struct scene *s, struct path *p, mv m)
{
	fv throughput = FV(0.f);
	EACH_WAVE(j)
		throughput = fv_max(throughput, p->weight[j] * PATH_PDF(p, j));
	fv q = 4.f * (throughput * p->rare);
	mv doubtful = m & lt(q, FV(1.f));
	if (!any(doubtful))
		return m;
	EACH_WAVE(j)
		SET(doubtful, p->weight[j], p->weight[j] / q);
	return m & (NOT(doubtful) | lt(draw(&p->random, DRAW_ROULETTE), q));
}

/* Paths m leave their vertices in a direction drawn there; returns its pdf, 0 where the path cannot be. */
FN fv path_scatter(const struct scene *s, const struct tables *t, struct path *p, mv m, struct vec *along)
{
	fv value[CARRIED], sn, cs;
	mv ground = m & ON_GROUND(p->vertex), hit = m & NOT(ground);
	struct vec axis = p->ray.along;
	fv azimuth = 2.f * PI * draw(&p->random, DRAW_AZIMUTH);
	if (IS_ISOTROPIC) {
		fv u = draw(&p->random, DRAW_COSINE);
		cs = 1.f - 2.f * u;
		sn = 2.f * fv_sqrt(u * (1.f - u));
		EACH_WAVE(j)
			value[j] = FV(ISOTROPIC);
	} else {
		vertex_draw(s, t, hit, &p->vertex, p->waves, draw_bits(&p->random, DRAW_ANGLE), draw_bits(&p->random, DRAW_PLACE), &sn, &cs,
		            value);
	}
	fv pdf = take_pdf(s, p->waves, p->path_pdf, hit, value);
	if (HAS_PEAK)
		take_peak_share(s, t, p, m, hit, ground, value);
	if (HAS_GROUND) {          /* cosine-distributed */
		fv u = draw(&p->random, DRAW_COSINE);
		SET(ground, sn, fv_sqrt(u));
		SET(ground, cs, fv_sqrt(1.f - u));
		SET(ground, pdf, cs / PI);
		set3(ground, &axis, vec3(FV(0.f), SEL(lt(p->ray.along.y, FV(0.f)), FV(1.f), FV(-1.f)), FV(0.f)));
	}
	if (IS_ISOTROPIC && !HAS_GROUND) {    /* about any axis */
		fv x, y;
		fv_sincos(azimuth, &y, &x);
		*along = vec3(sn * x, sn * y, cs);
	} else {
		*along = to_world(axis, sn, cs, azimuth);
	}
	return pdf;
}

/* Shadow rays of lanes m have ended. Returns the lanes whose path is over. */
FN mv path_depart(const struct scene *s, const struct tables *t, struct path *p, mv m)
{
	if (s->lights.n)
		nee_end(s, t, p, m);
	mv on = roulette(s, p, m);
	struct vec along;
	fv pdf = path_scatter(s, t, p, on, &along);
	PUT(on, p->direction_pdf, pdf);
	PUT3(on, p->ray.along, along);
	PUT3(on, p->ray.inverse, inverse3(along));
	PUT3(on, p->ray.from, p->vertex.point);
	PUT(on, p->ray.skip, p->vertex.id);
	if (N_VOLUMES > 1)
		SET(on, p->ray.volume, p->vertex.volume);
	next_vertex(&p->random, m);
	return m & NOT(on & lt(FV(0.f), pdf));
}

#endif

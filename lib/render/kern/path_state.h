/* path_state - what is kept of a path from the camera, one a lane, and how what it sees is added to it.
 *
 * A path is sampled for one of its wavelengths, the hero, each equally probable. weight[j] is the throughput of wavelength j
 * (albedos, roulette), path_pdf[j] the probability density of the path had j been the hero, divided by its mean over j.
 * By the balance heuristic over heroes wavelength j then contributes weight[j] path_pdf[j] times what it sees: no wavelength is
 * favoured, and one whose own disc would not have been met has pdf 0 from there on. */
#ifndef KERN_PATH_STATE_H
#define KERN_PATH_STATE_H

#include "render/kern/camera.h"
#include "render/kern/media.h"
#include "render/kern/vertex.h"

/* A chain of scatterings by the peak from a vertex to a light, see forward_peak.h. */
struct chain {
	mv flying;                 /* in flight to its next scattering */
	iv length, left;           /* its scatterings, in all and still to come */
	struct vec light;          /* to the light */
	fv pdf[CARRIED];           /* the path's and the chain's, as path_pdf[] */
};

struct path {
	struct ray ray;
	struct waves waves;
	fv weight[CARRIED], path_pdf[CARRIED];
	fv direction_pdf;          /* of the ray's direction, sr^-1; 0 from the camera, where no light is drawn */
	struct random random;
	fv rgb[3];                 /* seen since the medium last scattered the path */
	iv order;                  /* times that it did, from 2 on 2; reflections by surfaces do not count */
	fv before[2][3];           /* what was seen unscattered, and scattered once, of an order that is over */
	fv aside[2][3];            /* what came by chains, scattered once and more often on the whole */
	fv cover;                  /* what the medium takes away from the camera's ray, as a mean over its wavelengths */
	fv depth;                  /* along the camera's ray to where the medium scattered it, -1 if it did not; of a forced flight times cover */
	fv rare;                   /* 1 / the probability that a flight was forced to end in the medium, else 1 */
	fv spectrum[CARRIED];      /* all that was seen, by wavelength; kept for spectral images */
	fv alpha[3];               /* what the medium took away from white light behind it; of one wavelength not kept */
	fv spectral_alpha[CARRIED];     /* the same by wavelength, as spectrum */
	/* on the way: in flight to a surface or beyond, or from a vertex to a light */
	struct media_walk walk;
	struct random walk_random; /* of the walk: the vertex's, or a chain's own */
	mv flying;
	fv t_end;
	iv surface;
	struct vertex vertex;
	fv nee[CARRIED], nee_rgb[3];    /* what the light drawn adds through a clear medium: wavelength j sees nee[j] nee_rgb[] */
	fv peak_share[CARRIED];    /* the share of the path's pdf, from the camera or the ground on, that peaks alone have */
	struct chain chain;
};

/* Of one wavelength the pdf is its own mean. */
#define PATH_PDF(p, j) (CARRIED == 1 ? FV(1.f) : (p)->path_pdf[j])

/* Rays that come from the camera. */
#define FROM_CAMERA(p) le((p)->direction_pdf, FV(0.f))

/* Wavelengths of lanes m see k rgb[], which is added to into[]. A light's colour multiplies the film's channels, so that it is seen as
 * it is, whatever the wavelengths; the wavelength itself sees the mean of the light's channels that its own colour gives. */
FN void add_radiance(const struct scene *s, const struct tables *t, struct path *p, mv m, int j, fv k, const fv *rgb, fv *into)
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

/* The medium scatters paths m at distance t: what they see from here on belongs to the next order. */
FN void next_order(const struct scene *s, struct path *p, mv m, fv t)
{
	m &= ilt(p->order, IV(2));
	if (!any(m))
		return;
	mv first = m & ieq(p->order, IV(0)) & FROM_CAMERA(p);
	SET(first & lt(p->depth, FV(0.f)), p->depth, camera_distance(&s->camera, p->ray.along, t));
	SET(first, p->cover, SEL(lt(FV(0.f), p->cover), p->cover, FV(1.f)));
	EACH(k, 2) {
		mv over = m & ieq(p->order, IV(k));
		for (int i = 0; i < CHANNELS; i++)
			SET(over, p->before[k][i], p->rgb[i]);
	}
	for (int i = 0; i < CHANNELS; i++)
		SET(m, p->rgb[i], FV(0.f));
	SET(m, p->order, p->order + 1);
}

/* Take the pdf of a flight or a direction, for each wavelength, into a path's; returns the mean over the wavelengths, 0 if the path
 * cannot be (it then ends). */
FN fv take_pdf(const struct scene *s, struct waves w, fv *path_pdf, mv m, const fv *pdf)
{
	fv mean = FV(0.f), own[CARRIED];
	if (CARRIED == 1)
		return pdf[0];
	EACH_WAVE(j) {
		own[j] = path_pdf[j] * pdf[j];
		mean += own[j];
	}
	mean /= to_float(w.n);
	EACH_WAVE(j)
		SET(m, path_pdf[j], SEL(lt(FV(0.f), mean), own[j] / mean, FV(0.f)));
	return mean;
}

#endif

#include "render/setup_parts.h"

#include "render/kern/film.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void setup_unit(double *v)
{
	double n = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
	for (int i = 0; i < 3; i++)
		v[i] /= n;
}

void setup_cross(const double *a, const double *b, double *out)
{
	for (int i = 0; i < 3; i++)
		out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

void setup_floats(const double *v, float *out)
{
	for (int i = 0; i < 3; i++)
		out[i] = (float)v[i];
}

void *setup_own(struct setup *u, void *p) { return u->own[u->n_own++] = p; }

static int grey(const float *rgb) { return rgb[0] == rgb[1] && rgb[1] == rgb[2]; }

/* One channel will do where nothing has a colour. */
static int channels(const struct setup *u, const struct scenefile *file)
{
	const struct lights *lights = &u->scene.lights;
	int all = grey(lights->environment) && !file->map.width && u->scene.n_waves == 1 && grey(u->tables[0].colour);
	for (int i = 0; i < lights->n; i++)
		all &= grey(lights->light[i].rgb);
	return all ? 1 : 3;
}

static double volume_reach(const struct volume *v)
{
	double corner = 0, away = 0;
	for (int a = 0; a < 3; a++) {
		double most = fmax(v->extent[v->round ? 0 : a], v->cells[a] ? fabs(v->grid_centre[a]) + v->grid_reached[a] : 0);
		corner += most * most;
		away += (double)v->centre[a] * v->centre[a];
	}
	return sqrt(away) + sqrt(corner);
}

double setup_reach(const struct scene *s)
{
	double most = 0;
	for (int k = 0; k < s->n_volumes; k++)
		most = fmax(most, volume_reach(&s->volume[k]));
	return most;
}

/* Depths are from the eye to anywhere in the volumes. */
static float depth_scale(const struct setup *u, const struct scenefile *f)
{
	double eye = 0;
	int exponent;
	for (int a = 0; a < 3; a++)
		eye += pow((float)(f->position[a] - u->origin[a]), 2);
	frexp(sqrt(eye) + setup_reach(&u->scene), &exponent);
	return (float)ldexp(1, -exponent);
}

/* The origin is the middle of the box around all media; of one that is its centre to the last bit. */
static void place(struct setup *u, const struct scenefile *file, const struct medium *const *medium, const int *which)
{
	for (int a = 0; a < 3; a++) {
		double low = INFINITY, high = -INFINITY, at[MAX_VOLUMES];
		for (int k = 0; k < file->n_media; k++) {
			const struct medium *m = medium[which[k]];
			at[k] = file->medium[which[k]].position[a] + m->centre[a];
			low = fmin(low, at[k] - m->half[a]);
			high = fmax(high, at[k] + m->half[a]);
		}
		u->origin[a] = file->n_media == 1 ? at[0] : (low + high) / 2;
		for (int k = 0; k < file->n_media; k++)
			u->scene.volume[k].centre[a] = (float)(at[k] - u->origin[a]);
	}
}

static int scatters(const struct medium *m)
{
	int some = 0;
	for (int i = 0; i < m->n_classes * m->n_waves; i++)
		some |= m->c_sca[i] > 0;
	return some;
}

void setup_make(struct setup *u, const struct scenefile *file, const struct medium *const *medium, const struct render_options *options)
{
	struct scene *s = &u->scene;
	int suns = 0;
	memset(u, 0, sizeof *u);
	s->seed = options->seed;
	s->n_waves = medium[0]->n_waves;
	s->n_groups = (s->n_waves + MAX_WAVES - 1) / MAX_WAVES;
	s->carried = (s->n_waves + s->n_groups - 1) / s->n_groups;
	s->n_volumes = file->n_media;
	s->isotropic = 1;
	for (int i = 0; i < file->n_lights; i++)
		suns |= file->light[i].kind == LIGHT_SUN;
	int which[MAX_VOLUMES], n = 0;    /* medium of each volume: those that scatter are the first */
	for (int k = 0; k < s->n_volumes; k++)
		if (scatters(medium[k]))
			which[n++] = k;
	const int scattering = n;
	for (int k = 0; k < s->n_volumes; k++)
		if (!scatters(medium[k]))
			which[n++] = k;
	place(u, file, medium, which);
	for (int k = 0; k < s->n_volumes; k++) {
		s->volume[k].transport = options->transport[which[k]];
		s->volume[k].attenuation = options->attenuation;
		s->volume[k].absorbs = k >= scattering;
		volume_setup(u, k, file, file->medium[which[k]].file, medium[which[k]], suns && scattering == 1);
	}
	light_setup(u, file);
	camera_setup(u, file);
	s->channels = channels(u, file);
	s->spectral = options->spectral;
	s->film_sums = FILM_SUMS + (s->spectral ? 2 * s->n_waves : 0);
	s->depth_scale = depth_scale(u, file);
}

void setup_free(struct setup *u)
{
	for (int i = 0; i < u->n_own; i++)
		free(u->own[i]);
	for (int k = 0; k < u->scene.n_volumes; k++) {
		phase_sampler_free(&u->sampler[k]);
		bricks_free(&u->bricks[k]);
	}
}

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
	int all = grey(lights->environment) && !file->map.width && u->scene.n_waves == 1 && grey(u->tables.colour);
	for (int i = 0; i < lights->n; i++)
		all &= grey(lights->light[i].rgb);
	return all ? 1 : 3;
}

double setup_reach(const struct volume *v)
{
	double corner = 0;
	for (int a = 0; a < 3; a++) {
		double most = fmax(v->extent[v->round ? 0 : a], v->cells[a] ? fabs(v->grid_centre[a]) + v->grid_reached[a] : 0);
		corner += most * most;
	}
	return sqrt(corner);
}

/* Depths are from the eye to anywhere in the volume. */
static float depth_scale(const struct setup *u, const struct scenefile *f)
{
	double eye = 0;
	int exponent;
	for (int a = 0; a < 3; a++)
		eye += pow((float)(f->position[a] - u->origin[a]), 2);
	frexp(sqrt(eye) + setup_reach(&u->scene.volume), &exponent);
	return (float)ldexp(1, -exponent);
}

void setup_make(struct setup *u, const struct scenefile *file, const struct medium *medium, const struct render_options *options)
{
	struct scene *s = &u->scene;
	int suns = 0;
	memset(u, 0, sizeof *u);
	s->seed = options->seed;
	s->volume.transport = options->transport;
	s->volume.attenuation = options->attenuation;
	s->n_waves = medium->n_waves;
	s->n_groups = (medium->n_waves + MAX_WAVES - 1) / MAX_WAVES;
	s->carried = (medium->n_waves + s->n_groups - 1) / s->n_groups;
	for (int i = 0; i < file->n_lights; i++)
		suns |= file->light[i].kind == LIGHT_SUN;
	for (int a = 0; a < 3; a++)
		u->origin[a] = file->medium_position[a] + medium->centre[a];
	volume_setup(u, file, medium, suns);
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
	phase_sampler_free(&u->sampler);
	bricks_free(&u->bricks);
}

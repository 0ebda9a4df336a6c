#include "render/job.h"

#include "base/die.h"
#include "render/colour.h"
#include "render/kern/film.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void unit(double *v)
{
	double n = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
	for (int i = 0; i < 3; i++)
		v[i] /= n;
}

static void cross(const double *a, const double *b, double *out)
{
	for (int i = 0; i < 3; i++)
		out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* Image: top row up, right = forward x up; fov along the longer side. */
static void camera(struct scene *s, const struct scenefile *f)
{
	double forward[3], right[3], up[3], longer = fmax(f->width, f->height), half = tan(f->fov * M_PI / 360);
	for (int i = 0; i < 3; i++)
		forward[i] = f->target[i] - f->position[i];
	unit(forward);
	cross(forward, f->up, right);
	unit(right);
	cross(right, forward, up);
	for (int i = 0; i < 3; i++) {
		s->eye[i] = (float)(f->position[i] - f->medium_position[i]);
		s->forward[i] = (float)forward[i];
		s->right[i] = (float)(right[i] * half * f->width / longer);
		s->up[i] = (float)(up[i] * half * f->height / longer);
	}
	s->width = f->width;
	s->height = f->height;
}

static void lights(struct scene *s, const struct scenefile *f)
{
	s->environment = (float)f->environment;
	for (int i = 0; i < f->n_suns; i++) {
		struct light *l = &s->light[s->n_lights];
		double towards[3], half = f->sun[i].angle * M_PI / 360, cap = 2 * pow(sin(half / 2), 2);
		if (!(f->sun[i].irradiance > 0))
			continue;
		for (int k = 0; k < 3; k++)
			towards[k] = -f->sun[i].direction[k];
		unit(towards);
		for (int k = 0; k < 3; k++)
			l->towards[k] = (float)towards[k];
		l->cap = (float)cap;
		l->density = cap > 0 ? (float)(1 / (2 * M_PI * cap)) : 0;
		/* the irradiance of a disc of radiance L, perpendicular to its axis, is pi L sin^2 */
		l->strength = (float)(cap > 0 ? f->sun[i].irradiance / (M_PI * pow(sin(half), 2)) : f->sun[i].irradiance);
		s->n_lights++;
	}
	s->has_ground = f->has_ground;
	s->ground_height = (float)(f->ground_height - f->medium_position[1]);
	s->ground_albedo = (float)f->ground_albedo;
}

/* Optics as the kernels want them: in m, by class and for the whole. */
static void optics(struct job *j, const struct medium *m)
{
	size_t waves = (size_t)m->n_waves, classes = (size_t)m->n_classes;
	float *extinction = xalloc(waves, sizeof(float)), *disc = xalloc(classes * waves, sizeof(float));
	float *most = xalloc(classes, sizeof(float)), *albedo = xalloc((classes + 1) * waves, sizeof(float));
	float (*colour)[3] = xalloc(waves, sizeof *colour);
	for (size_t w = 0; w < waves; w++) {
		double ext = 0, sca = 0;
		for (size_t k = 0; k < classes; k++) {
			double c_ext = m->c_ext[k * waves + w], c_sca = m->c_sca[k * waves + w];
			disc[k * waves + w] = (float)(c_ext * 1e-12 / M_PI);
			most[k] = fmaxf(most[k], disc[k * waves + w]);
			albedo[k * waves + w] = (float)fmin(1, c_sca / c_ext);
			ext += m->count[k] * c_ext;
			sca += m->count[k] * c_sca;
		}
		extinction[w] = (float)(ext * 1e-12 / medium_volume(m));
		albedo[classes * waves + w] = ext > 0 ? (float)fmin(1, sca / ext) : 0;
	}
	const char *wrong = colour_weights(m->n_waves, m->wavelength, colour);
	if (wrong)
		die("medium", "%s", wrong);
	j->tables = (struct tables){ extinction, disc, most, albedo, &colour[0][0], m->node, m->theta, m->p, m->cdf, m->particle,
		m->first, m->reference };
	j->n_extinction = waves;
	j->n_disc = classes * waves;
	j->n_disc_most = classes;
	j->n_albedo = (classes + 1) * waves;
	j->n_colour = 3 * waves;
	j->n_node = 2 * (classes + 1);
	j->n_theta = m->n_nodes;
	j->n_p = j->n_cdf = m->n_nodes * waves;
	j->n_particle = 4 * m->n_particles;
	j->n_first = m->n_first;
	j->n_reference = m->n_references;
}

void job_make(struct job *j, const struct scenefile *file, const struct medium *medium, int transport, uint32 seed)
{
	struct scene *s = &j->scene;
	memset(j, 0, sizeof *j);
	camera(s, file);
	lights(s, file);
	optics(j, medium);
	s->seed = seed;
	s->transport = transport;
	s->n_waves = medium->n_waves;
	s->n_groups = (medium->n_waves + MAX_WAVES - 1) / MAX_WAVES;
	s->n_classes = medium->n_classes;
	s->round = medium->round;
	for (int a = 0; a < 3; a++) {
		s->extent[a] = (float)medium->half[a];
		s->cells[a] = medium->cells[a];
		s->grid_low[a] = medium->low[a];
		s->cell[a] = medium->cell[a];
		s->grid_high[a] = (float)(medium->low[a] + (double)medium->cells[a] * medium->cell[a]);
	}
}

void job_film(struct job *j, int spectral)
{
	struct scene *s = &j->scene;
	double eye = 0, corner = 0;
	int exponent;
	for (int a = 0; a < 3; a++) {
		double most = fmax(s->extent[s->round ? 0 : a], s->cells[a] ? fmax(-s->grid_low[a], s->grid_high[a]) : 0);
		eye += (double)s->eye[a] * s->eye[a];
		corner += most * most;
	}
	frexp(sqrt(eye) + sqrt(corner), &exponent);
	s->depth_scale = (float)ldexp(1, -exponent);
	s->spectral = spectral;
	s->film_sums = FILM_SUMS + (spectral ? s->n_waves : 0);
	j->film = xalloc((size_t)s->width * (size_t)s->height, (size_t)s->film_sums * sizeof *j->film);
}

void job_free(struct job *j)
{
	free((void *)(size_t)j->tables.extinction);
	free((void *)(size_t)j->tables.disc);
	free((void *)(size_t)j->tables.disc_most);
	free((void *)(size_t)j->tables.albedo);
	free((void *)(size_t)j->tables.colour);
	free(j->film);
}

#include "render/scene_setup.h"

#include "base/die.h"
#include "render/colour.h"
#include "render/kern/film.h"
#include "render/forward_peak.h"

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

static void to_floats(const double *from, float *to)
{
	for (int i = 0; i < 3; i++)
		to[i] = (float)from[i];
}

static int grey(const float *rgb) { return rgb[0] == rgb[1] && rgb[1] == rgb[2]; }
static int shines(const float *rgb) { return rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0; }

static struct light sun_light(const struct sun *sun)
{
	struct light l = { .kind = LIGHT_SUN };
	double towards[3], half = sun->angle * M_PI / 360, cap = 2 * pow(sin(half / 2), 2);
	for (int k = 0; k < 3; k++) {
		towards[k] = -sun->direction[k];
		/* the irradiance of a disc of radiance L, perpendicular to its axis, is pi L sin^2 */
		l.rgb[k] = (float)(cap > 0 ? sun->irradiance[k] / (M_PI * pow(sin(half), 2)) : sun->irradiance[k]);
	}
	unit(towards);
	to_floats(towards, l.at);
	struct vec inverse = inverse3(load3(l.at));
	memcpy(l.inverse, (float[]){ inverse.x, inverse.y, inverse.z }, sizeof l.inverse);
	l.cap = (float)cap;
	l.density = cap > 0 ? (float)(1 / (2 * M_PI * cap)) : 0;
	return l;
}

static struct light quad_light(const struct quad *quad, const double *origin)
{
	struct light l = { .kind = LIGHT_QUAD };
	double normal[3], across[3], area = 0;
	cross(quad->edge[0], quad->edge[1], normal);
	for (int k = 0; k < 3; k++)
		area += normal[k] * normal[k];
	area = sqrt(area);
	unit(normal);
	for (int i = 0; i < 2; i++) {
		/* in the plane, perpendicular to the other edge; its product with its own edge is the area */
		cross(i ? normal : quad->edge[1], i ? quad->edge[0] : normal, across);
		for (int k = 0; k < 3; k++)
			l.dual[i][k] = (float)(across[k] / area);
		to_floats(quad->edge[i], l.edge[i]);
	}
	for (int k = 0; k < 3; k++)
		l.at[k] = (float)(quad->corner[k] - origin[k]);
	to_floats(normal, l.normal);
	to_floats(quad->radiance, l.rgb);
	l.density = (float)(1 / area);
	return l;
}

/* Those that are drawn come first: what is left are quads that only stand in the way. */
static void lights(struct job *j, const struct scenefile *f)
{
	struct scene *s = &j->scene;
	to_floats(f->environment, s->environment);
	for (int i = 0; i < f->n_suns; i++) {
		struct light l = sun_light(&f->sun[i]);
		if (shines(l.rgb))
			s->light[s->n_lights++] = l;
	}
	uint32 *cdf = NULL;
	j->n_map_cdf = f->map.width ? envmap_cdf(&f->map, &cdf) : 0;
	j->tables.map_cdf = (const int *)cdf;
	if (j->n_map_cdf) {
		s->map_width = f->map.width;
		s->map_height = f->map.height;
		s->map_angle = (float)(4 * M_PI / s->map_width * sin(M_PI / 2 / s->map_height));
		s->light[s->n_lights++] = (struct light){ .kind = LIGHT_MAP };
		j->tables.map = f->map.rgb;
		j->n_map = 3 * (size_t)s->map_width * (size_t)s->map_height;
	}
	for (int dark = 0; dark < 2; dark++) {
		for (int i = 0; i < f->n_quads; i++) {
			struct light l = quad_light(&f->quad[i], f->medium_position);
			if (shines(l.rgb) == !dark)
				s->light[s->n_lights++] = l;
		}
		if (!dark)
			s->n_drawn = s->n_lights;
	}
	/* what is drawn of a sun is at most its density's height or, by detours, 1 / (1 - share) of the cap: the lower is taken */
	float highest = 0;
	for (size_t w = 0; w < j->n_cap; w++)
		highest = fmaxf(highest, j->tables.cap[w] / (1 - s->peak));
	for (int i = 0; i < s->n_lights; i++)
		s->light[i].small = s->light[i].kind == LIGHT_SUN && (s->light[i].cap == 0 || s->light[i].density > highest);
	/* one channel will do where nothing has a colour */
	s->channels = grey(s->environment) && !f->map.width && grey(j->tables.colour) && j->n_colour == 6 ? 1 : 3;
	for (int i = 0; i < s->n_lights; i++)
		s->channels = grey(s->light[i].rgb) ? s->channels : 3;
	s->pick = s->n_drawn ? 1.f / (float)s->n_drawn : 0;
	s->has_ground = f->has_ground;
	s->ground_height = (float)(f->ground_height - f->medium_position[1]);
	s->ground_albedo = (float)f->ground_albedo;
}

/* Optics as the kernels want them: in m, by class and for the whole. */
static void optics(struct job *j, const struct medium *m, int suns)
{
	size_t waves = (size_t)m->n_waves, classes = (size_t)m->n_classes;
	float *extinction = xalloc(waves, sizeof(float)), *disc = xalloc(classes * waves, sizeof(float));
	float *albedo = xalloc((classes + 1) * waves, sizeof(float));
	float (*rgb)[3] = xalloc(waves, sizeof *rgb), *colour = xalloc(waves, 6 * sizeof *colour);
	for (size_t w = 0; w < waves; w++) {
		double ext = 0, sca = 0;
		for (size_t k = 0; k < classes; k++) {
			double c_ext = m->c_ext[k * waves + w], c_sca = m->c_sca[k * waves + w];
			disc[k * waves + w] = (float)(c_ext * 1e-12 / M_PI);
			j->scene.largest = fmaxf(j->scene.largest, disc[k * waves + w]);
			albedo[k * waves + w] = (float)fmin(1, c_sca / c_ext);
			ext += m->count[k] * c_ext;
			sca += m->count[k] * c_sca;
		}
		/* of the whole medium; on a density grid, where the density is 1 */
		double volume = j->scene.transport == TRANSPORT_GRID && m->n_density ? m->matter : medium_volume(m);
		extinction[w] = volume > 0 ? (float)(ext * 1e-12 / volume) : 0;
		albedo[classes * waves + w] = ext > 0 ? (float)fmin(1, sca / ext) : 0;
	}
	const char *wrong = colour_weights(m->n_waves, m->wavelength, rgb);
	if (wrong)
		die("medium", "%s", wrong);
	for (size_t w = 0; w < waves; w++) {     /* shares from the positive parts: a colour out of gamut has others */
		float sum = 0;
		for (int c = 0; c < 3; c++)
			sum += fmaxf(0, rgb[w][c]);
		for (int c = 0; c < 3; c++) {
			colour[6 * w + (size_t)c] = rgb[w][c];
			colour[6 * w + 3 + (size_t)c] = sum > 0 ? fmaxf(0, rgb[w][c]) / sum : 1 / 3.f;
		}
	}
	free(rgb);
	struct forward_peak peak;
	forward_peak_make(&peak, m, suns ? j->scene.only_class : -1);
	phase_sampler_make(&j->phase_sampler, peak.n_classes, m->n_waves, peak.range, peak.theta, peak.p, peak.cdf);
	j->scene.peak = (float)peak.share;
	j->scene.detours = peak.share > 0 ? (float)(-1 / log(peak.share)) : 0;
	float *cap = peak.cap;
	peak.cap = NULL;
	forward_peak_free(&peak);
	const struct phase_sampler *g = &j->phase_sampler;
	j->tables = (struct tables){ .extinction = extinction, .disc = disc, .albedo = albedo, .cap = cap, .colour = colour, .phase = g->phase,
		.interval = g->interval, .alias = g->alias, .angle = g->angle, .particle = m->particle, .first = (const int *)m->first };
	j->n_extinction = waves;
	j->n_disc = classes * waves;
	j->n_albedo = (classes + 1) * waves;
	j->n_cap = waves;
	j->n_colour = 6 * waves;
	j->scene.isotropic = g->isotropic;
	j->n_phase = g->n_phase;
	j->n_interval = g->n_interval;
	j->n_alias = g->n_alias;
	j->n_angle = g->n_angle;
	j->n_particle = 4 * m->n_particles;
	j->n_first = m->n_first;
}

static void voxels(struct job *j, const struct medium *m)
{
	struct scene *s = &j->scene;
	s->counted = m->n_particles > 0;
	for (int a = 0; a < 3; a++) {
		/* cells lie between the nodes of a density, and half of one before the first; before all, an empty brick */
		double side = s->counted ? m->voxel : 2 * m->half[a] / m->voxels[a];
		s->voxels[a] = m->voxels[a] + !s->counted;
		s->voxel_low[a] = (float)(-m->half[a] - (BRICK + (s->counted ? 0 : 0.5)) * side);
		s->voxel[a] = (float)side;
		s->voxels_per_m[a] = (float)(1 / side);
	}
	if (s->transport != TRANSPORT_GRID)
		return;
	bricks_make(&j->bricks, m);
	memcpy(s->bricks, j->bricks.size, sizeof s->bricks);
	j->tables.brick = j->bricks.brick;
	j->tables.voxel = j->bricks.voxel;
	j->n_brick = j->bricks.n_brick;
	j->n_voxel = j->bricks.n_voxel;
	if (s->counted) {
		j->tables.count = (const int *)m->voxel_count;
		j->n_count = (size_t)m->voxels[0] * (size_t)m->voxels[1] * (size_t)m->voxels[2] * (size_t)m->n_classes;
	}
}

/* Fat rays have the area of a pixel's footprint at the medium's nearest depth (eq 23 with kappa 1), and no less than any particle. */
static float cross_section(const struct scenefile *f, const struct medium *m, float largest)
{
	double d2 = 0, pixel = 2 * tan(f->fov * M_PI / 360) / fmax(f->width, f->height), eye2 = 0;
	for (int a = 0; a < 3; a++) {
		double eye = f->position[a] - f->medium_position[a];
		eye2 += eye * eye;
		d2 += pow(fmax(0, fabs(eye) - m->half[a]), 2);
	}
	if (m->round)
		d2 = pow(fmax(0, sqrt(eye2) - m->half[0]), 2);
	return (float)fmax(M_PI * largest, pixel * pixel * d2);
}

void job_make(struct job *j, const struct scenefile *file, const struct medium *medium, int transport, int attenuation,
              int branches, uint32 seed)
{
	struct scene *s = &j->scene;
	double span = 0;           /* of the grid's coordinates */
	memset(j, 0, sizeof *j);
	s->seed = seed;
	s->transport = transport;
	s->attenuation = attenuation;
	s->branches = branches;
	s->branch_share = 1 / (float)branches;
	s->n_classes = medium->n_classes;
	/* particles scatter by their class, everything else as the mixture */
	s->only_class = s->transport == TRANSPORT_CONTINUOUS || !medium->n_particles ? medium->n_classes : medium->n_classes == 1 ? 0 : -1;
	camera(s, file);
	optics(j, medium, file->n_suns > 0);
	voxels(j, medium);
	s->fat = cross_section(file, medium, s->largest);
	lights(j, file);
	s->n_waves = medium->n_waves;
	s->n_groups = (medium->n_waves + MAX_WAVES - 1) / MAX_WAVES;
	s->carried = (medium->n_waves + s->n_groups - 1) / s->n_groups;
	s->round = medium->round;
	for (int a = 0; a < 3; a++) {
		s->extent[a] = (float)medium->half[a];
		s->cells[a] = medium->cells[a];
		s->grid_low[a] = medium->low[a];
		s->cell[a] = medium->cell[a];
		double high = medium->low[a] + (double)medium->cells[a] * medium->cell[a];
		s->grid_centre[a] = (float)((medium->low[a] + high) / 2);
		s->grid_reached[a] = (float)((high - medium->low[a]) / 2);
		span = fmax(span, fmax(fabs(medium->low[a]), fabs(high)));
	}
	s->largest_inverse = 1 / s->largest;
	s->reach2 = transport == TRANSPORT_EXPLICIT ? s->largest : s->fat / (float)M_PI;
	s->reach = (float)(sqrt(s->reach2) + 2e-6 * span);
	for (int a = 0; a < 3; a++)
		s->grid_reached[a] += s->reach;
}

void job_film(struct job *j, int spectral)
{
	struct scene *s = &j->scene;
	double eye = 0, corner = 0;
	int exponent;
	for (int a = 0; a < 3; a++) {
		double most = fmax(s->extent[s->round ? 0 : a], s->cells[a] ? fabs(s->grid_centre[a]) + s->grid_reached[a] : 0);
		eye += (double)s->eye[a] * s->eye[a];
		corner += most * most;
	}
	frexp(sqrt(eye) + sqrt(corner), &exponent);
	s->depth_scale = (float)ldexp(1, -exponent);
	s->spectral = spectral;
	s->film_sums = FILM_SUMS + (spectral ? s->n_waves : 0);
	j->film = xalloc((size_t)s->width * (size_t)s->height, (size_t)s->film_sums * sizeof *j->film);
}

void job_finish(struct job *j)
{
	size_t pixels = (size_t)j->scene.width * (size_t)j->scene.height;
	for (size_t i = 0; i < pixels; i++) {
		int64 *sum = j->film + i * (size_t)j->scene.film_sums;
		for (int c = 0; c < 3; c++) {
			int64 *own = &sum[SUM_OF(0, c)];
			if (c >= j->scene.channels)
				memcpy(own, sum, 3 * sizeof *own);
			else
				j->overflow |= __builtin_add_overflow(own[SUM_ALL], own[SUM_SINGLE], &own[SUM_ALL])
				    | __builtin_add_overflow(own[SUM_ALL], own[SUM_MULTIPLE], &own[SUM_ALL]);
		}
	}
}

void job_free(struct job *j)
{
	free((void *)(size_t)j->tables.extinction);
	free((void *)(size_t)j->tables.disc);
	free((void *)(size_t)j->tables.albedo);
	free((void *)(size_t)j->tables.cap);
	free((void *)(size_t)j->tables.colour);
	free((void *)(size_t)j->tables.map_cdf);
	phase_sampler_free(&j->phase_sampler);
	bricks_free(&j->bricks);
	free(j->film);
}

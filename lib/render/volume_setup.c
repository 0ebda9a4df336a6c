#include "render/setup_parts.h"

#include "base/die.h"
#include "render/colour.h"
#include "render/forward_peak.h"
#include "render/kern/voxels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Cross sections as the kernels want them: discs in m^2, albedos, by class and for the whole. */
static void optics(struct setup *u, int n, const struct medium *m)
{
	struct volume *v = &u->scene.volume[n];
	size_t waves = (size_t)m->n_waves, classes = (size_t)m->n_classes;
	float *extinction = setup_own(u, xalloc(waves, sizeof(float))), *disc_radius2 = setup_own(u, xalloc(classes * waves, sizeof(float)));
	float *albedo = setup_own(u, xalloc((classes + 1) * waves, sizeof(float)));
	/* of the whole medium; on a density grid, where the density is 1 */
	double volume = v->transport == TRANSPORT_GRID && m->kind == MEDIUM_DENSITY ? m->matter : medium_volume(m);
	for (size_t w = 0; w < waves; w++) {
		double ext = 0, sca = 0;
		for (size_t k = 0; k < classes; k++) {
			double c_ext = m->c_ext[k * waves + w], c_sca = m->c_sca[k * waves + w];
			disc_radius2[k * waves + w] = (float)(c_ext * 1e-12 / M_PI);
			v->largest = fmaxf(v->largest, disc_radius2[k * waves + w]);
			albedo[k * waves + w] = (float)fmin(1, c_sca / c_ext);
			ext += m->count[k] * c_ext;
			sca += m->count[k] * c_sca;
		}
		extinction[w] = volume > 0 ? (float)(ext * 1e-12 / volume) : 0;
		albedo[classes * waves + w] = ext > 0 ? (float)fmin(1, sca / ext) : 0;
	}
	v->largest_inverse = 1 / v->largest;
	if (v->classed) {               /* classes are drawn by number density x c_ext, as much as a factor of all */
		double most = 0;
		for (size_t k = 0; k < classes; k++)
			most = fmax(most, m->count[k]);
		for (size_t i = 0; i < classes * waves && most > 0; i++)
			disc_radius2[i] = (float)(disc_radius2[i] * (m->count[i / waves] / most));
	}
	SET_TABLE(u, n, extinction, extinction, waves);
	SET_TABLE(u, n, disc_radius2, disc_radius2, classes * waves);
	SET_TABLE(u, n, albedo, albedo, (classes + 1) * waves);
}

/* Colours of the wavelengths, and the shares of a light's in them. */
static void colours(struct setup *u, const struct medium *m)
{
	size_t waves = (size_t)m->n_waves;
	float (*rgb)[3] = xalloc(waves, sizeof *rgb), *colour = setup_own(u, xalloc(waves, 6 * sizeof *colour));
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
	SET_TABLE(u, 0, colour, colour, 6 * waves);
}

/* Phase functions, with the peak of the only class where it makes spikes. */
static void phases(struct setup *u, int n, const struct medium *m, int peaked)
{
	struct volume *v = &u->scene.volume[n];
	struct forward_peak peak;
	forward_peak_make(&peak, m, peaked && !n ? v->only_class : -1);
	phase_sampler_make(&u->sampler[n], peak.n_classes, m->n_waves, peak.range, peak.theta, peak.p);
	if (!n) {
		u->scene.peak = (float)peak.share;
		u->scene.chain_scale = peak.share > 0 ? (float)(-1 / log(peak.share)) : 0;
	}
	SET_TABLE(u, n, truncation, setup_own(u, peak.truncation), (size_t)m->n_waves);
	peak.truncation = NULL;
	forward_peak_free(&peak);
	u->scene.isotropic &= u->sampler[n].isotropic;
	SET_TABLE(u, n, phase, u->sampler[n].phase, u->sampler[n].n_phase);
	SET_TABLE(u, n, interval, u->sampler[n].interval, u->sampler[n].n_interval);
	SET_TABLE(u, n, alias, u->sampler[n].alias, u->sampler[n].n_alias);
	SET_TABLE(u, n, angle, u->sampler[n].angle, u->sampler[n].n_angle);
}

/* Fat rays have the area of a pixel's footprint at the medium's nearest depth (eq 23 with kappa 1), and no less than any particle. */
static float fat_area(const struct scenefile *f, const struct medium *m, const double *origin, const struct volume *v)
{
	double d2 = 0, pixel = 2 * tan(f->fov * M_PI / 360) / fmax(f->width, f->height), eye2 = 0;
	for (int a = 0; a < 3; a++) {
		double eye = f->position[a] - origin[a] - v->centre[a];
		eye2 += eye * eye;
		d2 += pow(fmax(0, fabs(eye) - m->half[a]), 2);
	}
	if (m->round)
		d2 = pow(fmax(0, sqrt(eye2) - m->half[0]), 2);
	return (float)fmax(M_PI * v->largest, pixel * pixel * d2);
}

/* The grid of particles, and the cylinders that query it. */
static void particles(struct setup *u, int n, const struct scenefile *f, const struct medium *m)
{
	struct volume *v = &u->scene.volume[n];
	double span = 0;           /* of the grid's coordinates */
	v->fat_area = fat_area(f, m, u->origin, v);
	v->query_radius2 = v->transport == TRANSPORT_EXPLICIT ? v->largest : v->fat_area / (float)M_PI;
	for (int a = 0; a < 3; a++) {
		double high = m->low[a] + (double)m->cells[a] * m->cell[a];
		v->cells[a] = m->cells[a];
		v->grid_low[a] = m->low[a];
		v->cell[a] = m->cell[a];
		v->grid_centre[a] = (float)((m->low[a] + high) / 2);
		v->grid_reached[a] = (float)((high - m->low[a]) / 2);
		span = fmax(span, fmax(fabs(m->low[a]), fabs(high)));
	}
	v->query_radius = (float)(sqrt(v->query_radius2) + 2e-6 * span);
	for (int a = 0; a < 3; a++)
		v->grid_reached[a] += v->query_radius;
	SET_TABLE(u, n, particle, m->particle, 4 * m->n_particles);
	SET_TABLE(u, n, first, (const int *)m->first, m->n_first);
}

static void voxels(struct setup *u, int n, const struct medium *m)
{
	struct volume *v = &u->scene.volume[n];
	for (int a = 0; a < 3; a++) {
		/* cells lie between the nodes of a density, and half of one before the first; before all, an empty brick */
		double side = v->counted ? m->voxel : 2 * m->half[a] / m->voxels[a];
		v->voxels[a] = m->voxels[a] + !v->counted;
		v->voxel_low[a] = (float)(-m->half[a] - (BRICK + (v->counted ? 0 : 0.5)) * side);
		v->voxel[a] = (float)side;
		v->voxels_per_m[a] = (float)(1 / side);
	}
	if (v->transport != TRANSPORT_GRID)
		return;
	bricks_make(&u->bricks[n], m);
	memcpy(v->bricks, u->bricks[n].size, sizeof v->bricks);
	SET_TABLE(u, n, brick, u->bricks[n].brick, u->bricks[n].n_brick);
	SET_TABLE(u, n, voxel, u->bricks[n].voxel, u->bricks[n].n_voxel);
	if (v->classed)
		SET_TABLE(u, n, density, m->density, m->n_density);
	if (v->counted)
		SET_TABLE(u, n, count, (const int *)m->voxel_count, (size_t)m->voxels[0] * (size_t)m->voxels[1] * (size_t)m->voxels[2] * (size_t)m->n_classes);
}

#define SCATTERINGS_MOST 1e6

/* Largest extinction of a voxel. */
static double densest(const struct setup *u, int n, int w)
{
	const struct bricks *b = &u->bricks[n];
	const struct volume *v = &u->scene.volume[n];
	const size_t waves = (size_t)u->scene.n_waves;
	double most = 0;
	for (size_t i = 0; i < b->n_voxel; i++) {
		size_t own = v->counted ? i % waves : v->classed ? i / BRICK_CORNERS % waves : (size_t)w;
		most = own == (size_t)w ? fmax(most, b->voxel[i]) : most;
	}
	return v->counted || v->classed ? most : most * u->tables[n].extinction[w];
}

/* Refuse what would hardly end. Of a medium that does not absorb, a path from outside meets 4 V/S times the mean extinction on the average
 * (Blanco and Fournier 2003), which is up to twice the depth along the shortest axis; one in a voxel, about that across it. */
static void ends(const struct setup *u, int n, const char *name, const struct medium *m)
{
	const struct volume *v = &u->scene.volume[n];
	size_t waves = (size_t)m->n_waves, classes = (size_t)m->n_classes;
	double shortest = fmin(m->half[0], fmin(m->half[1], m->half[2])), side = INFINITY;
	for (int a = 0; a < 3; a++)
		side = fmin(side, v->voxel[a]);
	for (size_t w = 0; w < waves; w++) {
		double sum = 0, albedo = v->only_class >= 0 ? u->tables[n].albedo[(size_t)v->only_class * waves + w] : 0;
		for (size_t k = 0; k < classes; k++) {
			sum += m->count[k] * m->c_ext[k * waves + w];
			albedo = v->only_class < 0 ? fmax(albedo, u->tables[n].albedo[k * waves + w]) : albedo;
		}
		double depth = sum * 1e-12 / medium_volume(m) * 2 * shortest;
		if (v->transport == TRANSPORT_GRID)
			depth = fmax(depth, densest(u, n, (int)w) * side);
		if (fmin(depth, 1 / (1 - albedo)) > SCATTERINGS_MOST)
			die(name, "optical depth %.3g at %g um without absorption: a path would be scattered over %g times", depth,
			    m->wavelength[w], SCATTERINGS_MOST);
	}
}

void volume_setup(struct setup *u, int n, const struct scenefile *f, const char *name, const struct medium *m, int peaked)
{
	struct volume *v = &u->scene.volume[n];
	v->counted = m->kind == MEDIUM_PARTICLES;
	v->classed = v->transport == TRANSPORT_GRID && medium_by_class(m);
	v->n_classes = m->n_classes;
	/* particles scatter by their class, as do densities by class, everything else as the mixture */
	v->only_class = v->classed ? -1 : v->transport == TRANSPORT_CONTINUOUS || !v->counted ? m->n_classes : m->n_classes == 1 ? 0 : -1;
	v->round = m->round;
	setup_floats(m->half, v->extent);
	optics(u, n, m);
	if (!n)
		colours(u, m);
	phases(u, n, m, peaked);
	particles(u, n, f, m);
	voxels(u, n, m);
	ends(u, n, name, m);
}

#include "medium/particle_grid.h"

#include "base/die.h"
#include "format/limits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CELLS_MAX 0x1p28

/* Radius in m of the largest disc. */
static double largest_disc(const struct medium *m)
{
	double c = 0;
	for (int i = 0; i < m->n_classes * m->n_waves; i++)
		c = fmax(c, m->c_ext[i]);
	return sqrt(c / M_PI) * 1e-6;
}

/* The side a of cells for which a ray costs least, in units of one particle looked at: a layer of cells costs 4, in it some
 * (1.5 + 2.2 r/a)^2 cells of 3 and n a^3 particles each are looked at. */
static double best_side(double n, double r)
{
	double best = 0, least = INFINITY;
	for (double a = r / 4 + cbrt(0.05 / n); a < 64 * (r + cbrt(1 / n)); a *= 1.05) {
		double cost = (4 + pow(1.5 + 2.2 * r / a, 2) * (3 + n * a * a * a)) / a;
		if (cost < least) {
			least = cost;
			best = a;
		}
	}
	return best;
}

static void place(struct medium *m)
{
	double low[3], high[3], volume = 1, r = largest_disc(m), total = INFINITY;
	for (int a = 0; a < 3; a++) {
		low[a] = INFINITY;
		high[a] = -INFINITY;
		for (size_t i = 0; i < m->n_particles; i++) {
			low[a] = fmin(low[a], m->particle[4 * i + (size_t)a]);
			high[a] = fmax(high[a], m->particle[4 * i + (size_t)a]);
		}
		/* wider by what floats and a flat cloud need */
		double margin = r + 1e-6 * (fabs(low[a]) + fabs(high[a]));
		low[a] -= margin;
		high[a] += margin;
		volume *= high[a] - low[a];
	}
	for (double side = best_side((double)m->n_particles / volume, r); total > CELLS_MAX; side *= 1.1) {
		total = 1;
		for (int a = 0; a < 3; a++) {
			double n = fmax(1, ceil((high[a] - low[a]) / side));
			total *= n;
			m->cells[a] = (int32_t)fmin(n, MEDIUM_CELLS_SIDE);
			total = n > MEDIUM_CELLS_SIDE ? INFINITY : total;
		}
	}
	for (int a = 0; a < 3; a++) {
		m->low[a] = (float)low[a];
		m->cell[a] = (float)((high[a] - m->low[a]) / m->cells[a] * (1 + 1e-6));
	}
}

static int index_of(const struct medium *m, int a, double x)
{
	return (int)fmin(fmax(floor((x - m->low[a]) / m->cell[a]), 0), m->cells[a] - 1);
}

static size_t home(const struct medium *m, const float *q)
{
	return ((size_t)index_of(m, 2, q[2]) * (size_t)m->cells[1] + (size_t)index_of(m, 1, q[1])) * (size_t)m->cells[0]
	    + (size_t)index_of(m, 0, q[0]);
}

void particle_grid_build(struct medium *m)
{
	place(m);
	size_t n_cells = (size_t)m->cells[0] * (size_t)m->cells[1] * (size_t)m->cells[2];
	float *sorted = xalloc(m->n_particles, 4 * sizeof *sorted);
	m->n_first = n_cells + 1;
	m->first = xalloc(m->n_first + 1, sizeof *m->first);
	/* counting sort: first[c + 2] counts cell c, then first[c + 1] is where its next particle goes, at last first[c] its first */
	for (size_t i = 0; i < m->n_particles; i++)
		m->first[home(m, m->particle + 4 * i) + 2]++;
	for (size_t c = 2; c <= n_cells; c++)
		m->first[c] += m->first[c - 1];
	for (size_t i = 0; i < m->n_particles; i++)
		memcpy(sorted + 4 * (size_t)m->first[home(m, m->particle + 4 * i) + 1]++, m->particle + 4 * i, 4 * sizeof *sorted);
	free(m->particle);
	m->particle = sorted;
}

int particle_grid_agrees(const struct medium *m)
{
	for (size_t c = 0; c + 1 < m->n_first; c++)
		for (size_t i = m->first[c]; i < m->first[c + 1]; i++)
			if (home(m, m->particle + 4 * i) != c)
				return 0;
	return 1;
}

size_t particle_grid_around(const struct medium *m, const double at[3], size_t *one)
{
	double largest = m->radius[m->n_classes - 1] * 1e-6;
	size_t found = 0;
	int low[3], high[3];
	for (int a = 0; a < 3; a++) {
		low[a] = index_of(m, a, at[a] - largest);
		high[a] = index_of(m, a, at[a] + largest);
	}
	for (int z = low[2]; z <= high[2]; z++)
		for (int y = low[1]; y <= high[1]; y++) {
			size_t row = ((size_t)z * (size_t)m->cells[1] + (size_t)y) * (size_t)m->cells[0];
			for (size_t i = m->first[row + (size_t)low[0]]; i < m->first[row + (size_t)high[0] + 1]; i++) {
				const float *p = m->particle + 4 * i;
				int32_t class;
				memcpy(&class, p + 3, sizeof class);
				double r = m->radius[class] * 1e-6, d2 = 0;
				for (int a = 0; a < 3; a++)
					d2 += (at[a] - p[a]) * (at[a] - p[a]);
				if (d2 < r * r) {
					*one = i;
					found++;
				}
			}
		}
	return found;
}

#include "medium/bake.h"

#include "base/die.h"
#include "format/columns.h"
#include "format/limits.h"
#include "medium/classes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int outside(const struct medium *m, const double *q)
{
	if (m->round)
		return sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]) > m->half[0] * (1 + 1e-6);
	return fabs(q[0]) > m->half[0] * (1 + 1e-6) || fabs(q[1]) > m->half[1] * (1 + 1e-6) || fabs(q[2]) > m->half[2] * (1 + 1e-6);
}

char *bake_particles(const char *path, int bounded, struct medium *m)
{
	struct tab *t = tab_open(path);
	int x = tab_need(t, &column_position[0]), y = tab_need(t, &column_position[1]), z = tab_need(t, &column_position[2]);
	int radius = tab_need(t, &column_radius);
	double row[TAB_COLS], low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
	double (*at)[3] = NULL;    /* until the cloud's middle is known */
	size_t room = 0;
	while (tab_next(t, row)) {
		unsigned long long number = (unsigned long long)tab_row(t);
		double q[3] = { row[x], row[y], row[z] };
		int32_t class = classes_find(m, t, row[radius]);
		for (int a = 0; a < 3; a++) {
			if (!(fabs(q[a]) <= MEDIUM_REACH / 2))
				die(tab_path(t), "row %llu: a position is not within %g m", number, MEDIUM_REACH / 2);
			low[a] = fmin(low[a], q[a]);
			high[a] = fmax(high[a], q[a]);
		}
		if (bounded && outside(m, q))
			die(tab_path(t), "row %llu: the particle lies outside the box or sphere given", number);
		if (m->n_particles == room) {
			room = room ? 2 * room : 1024;
			m->particle = xgrow(m->particle, room, 4 * sizeof *m->particle);
			at = xgrow(at, room, sizeof *at);
		}
		memcpy(at[m->n_particles], q, sizeof q);
		memcpy(&m->particle[4 * m->n_particles + 3], &class, 4);
		m->count[class]++;
		if (++m->n_particles > MEDIUM_PARTICLES_MOST)
			die(tab_path(t), "more than %d particles", MEDIUM_PARTICLES_MOST);
	}
	if (!m->n_particles)
		die(tab_path(t), "has no rows");
	/* Without a box: the bounding box of the centres, widened by what n uniform centres leave free on the average, 2 of n - 1
	 * gaps, and no less than a particle. */
	for (int a = 0; a < 3 && !bounded; a++) {
		double wider = m->n_particles > 1 ? 1 + 2 / ((double)m->n_particles - 1) : 1;
		m->centre[a] = low[a] + (high[a] - low[a]) / 2;
		m->half[a] = fmax((high[a] - low[a]) / 2 * wider, 1e-6 * m->radius[m->n_classes - 1]);
	}
	for (size_t i = 0; i < m->n_particles; i++)
		for (int a = 0; a < 3; a++)
			m->particle[4 * i + (size_t)a] = (float)(at[i][a] - m->centre[a]);
	free(at);
	char *history = xtext("%s", tab_history(t));
	tab_close(t);
	return history;
}

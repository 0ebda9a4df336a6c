#include "medium/host.h"

#include "base/die.h"
#include "optics/index/ior.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void host_absorption(const char *option, const char *index, struct medium *m)
{
	struct ior ior;
	double most = 0;
	if (!index)
		return;
	const char *wrong = ior_parse(index, &ior);
	if (wrong)
		die(option, "'%s' %s", index, wrong);
	m->host = xalloc((size_t)m->n_waves, sizeof *m->host);
	for (int w = 0; w < m->n_waves; w++) {
		double complex n;
		wrong = ior_at(&ior, m->wavelength[w], &n);
		if (wrong)
			die(option, "'%s' at %g um: %s", index, m->wavelength[w], wrong);
		m->host[w] = 4 * M_PI * cimag(n) / (m->wavelength[w] * 1e-6);
		most = fmax(most, m->host[w]);
	}
	if (most > 0)
		return;
	free(m->host);
	m->host = NULL;
}

#define NODES 181              /* of a phase function that nobody asks for */

struct medium host_medium(const struct medium *m)
{
	const size_t waves = (size_t)m->n_waves;
	struct medium h = { .kind = MEDIUM_DENSITY, .history = xtext("%s", ""), .round = m->round, .n_waves = m->n_waves, .n_classes = 1,
		.n_nodes = NODES, .voxels = { 1, 1, 1 }, .n_density = 1, .matter = medium_volume(m) };
	memcpy(h.centre, m->centre, sizeof h.centre);
	memcpy(h.half, m->half, sizeof h.half);
	h.wavelength = xalloc(waves, sizeof *h.wavelength);
	h.radius = xalloc(1, sizeof *h.radius);
	h.count = xalloc(1, sizeof *h.count);
	h.c_ext = xalloc(waves, sizeof *h.c_ext);
	h.c_sca = xalloc(waves, sizeof *h.c_sca);
	h.node = xalloc(4, sizeof *h.node);
	h.theta = xalloc(NODES, sizeof *h.theta);
	h.p = xalloc(NODES * waves, sizeof *h.p);
	h.density = xalloc(1, sizeof *h.density);
	h.radius[0] = h.count[0] = h.density[0] = 1;
	for (size_t w = 0; w < waves; w++) {     /* one particle takes away what all of the host does */
		h.wavelength[w] = m->wavelength[w];
		h.c_ext[w] = fmax(m->host[w] * h.matter * 1e12, DBL_MIN);
	}
	for (int i = 0; i < NODES; i++) {
		h.theta[i] = (float)(M_PI * i / (NODES - 1));
		for (size_t w = 0; w < waves; w++)
			h.p[(size_t)i * waves + w] = (float)(1 / (4 * M_PI));
	}
	h.node[1] = h.node[3] = NODES;
	return h;
}

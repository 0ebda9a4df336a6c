/* Lights as the kernels have them: a map is drawn as tabulated and found where it is drawn; quads close a box. */
#include "base/die.h"
#include "format/exr.h"
#include "render/kern/light.h"
#include "render/envmap.h"
#include "support/tap.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

static uint32 state = 1;

static uint32 bits(void)
{
	state++;
	return mix(mix(state, 0x9e3779b9u), 0x85ebca6bu);
}

/* A map of a few bright texels over a dim ground, one row black, in single all but one texel of the others, too; and what the kernels
 * need of it. */
static void map_make(int width, int height, int single, struct envmap *m, struct lights *l, struct tables *t)
{
	uint32 *cdf;
	*m = (struct envmap){ .width = width, .height = height, .rgb = xalloc((size_t)width * (size_t)height, 3 * sizeof(float)) };
	for (int i = 0; i < width * height; i++) {
		int black = i / width == height / 3 || (single && i % width != 1);
		for (int c = 0; c < 3; c++)
			m->rgb[3 * i + c] = black ? 0 : bits() % 50 ? 0.01f * (float)(c + 1) : (float)(bits() % 1000);
	}
	memset(l, 0, sizeof *l);
	l->map_width = width;
	l->map_height = height;
	l->map_angle = (float)(4 * M_PI / width * sin(M_PI / 2 / height));
	l->n = 1;
	l->map_pick = 1;
	l->light[0].kind = LIGHT_MAP;
	memset(t, 0, sizeof *t);
	ok(envmap_cdf(m, &cdf) == (size_t)height + 1 + (size_t)height * ((size_t)width + 1), "%d x %d: integrals made", width, height);
	t->map = m->rgb;
	t->map_cdf = (const int *)cdf;
}

static void map_test(int width, int height, int single)
{
	struct envmap m;
	struct lights l;
	struct tables t;
	map_make(width, height, single, &m, &l, &t);
	double all = 0, spheres = 0, flux = 0, worst = 0;
	for (int r = 0; r < height; r++)
		for (int c = 0; c < width; c++) {
			double angle = 2 * M_PI / width * (cos(M_PI * r / height) - cos(M_PI * (r + 1) / height));
			all += envmap_pdf(&l, &t, ALL_LANES, r, c) * angle;
			spheres += texel_angle(&l, r);
			flux += m.rgb[3 * (r * width + c) + 1] * angle;
			worst = fmax(worst, fabs(texel_angle(&l, r) / angle - 1));
		}
	ok(fabs(all - 1) < 1e-6 && fabs(spheres / (4 * M_PI) - 1) < 1e-6 && worst < 1e-5,
	   "%d x %d: densities integrate to 1 %+.1g, texels to the sphere %+.1g (each within %.1g)", width, height, all - 1,
	   spheres / (4 * M_PI) - 1, worst);

	/* A drawn direction is found in the texel that it was drawn from, but for slivers of rounding along the edges. */
	const int n = 400000;
	int astray = 0, far = 0, dark = 0;
	double sum = 0, sum2 = 0, length = 0;
	for (int i = 0; i < n; i++) {
		int row, column, r, c;
		struct vec d = envmap_draw(&l, &t, ALL_LANES, bits(), bits(), &row, &column);
		envmap_locate(&l, d, &r, &c);
		int turn = abs(column - c);
		astray += r != row || c != column;
		far += abs(r - row) > 1 || (r != 0 && r != height - 1 && turn > 1 && turn < width - 1);
		dark += row == height / 3;
		double v = m.rgb[3 * (row * width + column) + 1] / envmap_pdf(&l, &t, ALL_LANES, row, column);
		sum += v;
		sum2 += v * v;
		length = fmax(length, fabs(dot3(d, d) - 1));
	}
	ok(astray < 1 + n * 2e-6 * (width + height) && !far && !dark, "%d x %d: %d of %d directions in the next texel, %d further, %d where it is black", width,
	   height, astray, n, far, dark);
	ok(length < 1e-6, "%d x %d: directions are unit vectors within %.1g", width, height, length);
	double se = sqrt(fmax(0, sum2 / n - sum * sum / n / n) / n);
	ok(fabs(sum / n - flux) < 4 * se + 1e-6 * flux, "%d x %d: radiance over density %.6g, its integral %.6g, standard error %.2g", width, height, sum / n,
	   flux, se);
	free(m.rgb);
	free((void *)(size_t)t.map_cdf);
}

int main(void)
{
	map_test(7, 5, 0);
	map_test(64, 32, 0);
	map_test(1024, 512, 0);
	map_test(5, 4, 1);

	/* A texel alone, and one row. */
	struct lights l = { .map_width = 1, .map_height = 1, .map_angle = (float)(4 * M_PI), .map_pick = 1 };
	struct scene s;
	struct envmap one = { .width = 1, .height = 1, .rgb = (float[]){ 1, 2, 3 } };
	struct tables t = { .map = one.rgb };
	uint32 *cdf;
	ok(envmap_cdf(&one, &cdf) == 4, "a map of one texel");
	t.map_cdf = (const int *)cdf;
	ok(fabs(envmap_pdf(&l, &t, ALL_LANES, 0, 0) * 4 * M_PI - 1) < 1e-6, "is drawn evenly");
	struct envmap black = { .width = 1, .height = 1, .rgb = (float[]){ 0, 0, 0 } };
	free(cdf);
	ok(envmap_cdf(&black, &cdf) == 0, "a black one is not drawn");
	free(cdf);

	/* Rays from within a box of quads, along its edges and walls too, meet one of them from the front. */
	memset(&s, 0, sizeof s);
	for (int a = 0; a < 3; a++)
		for (int side = 0; side < 2; side++) {
			struct surface *q = &s.surfaces.surface[s.surfaces.n];
			int e = (a + 1) % 3, f = (a + 2) % 3;
			if (side) {
				int swap = e;
				e = f;
				f = swap;
			}
			for (int k = 0; k < 3; k++)
				q->corner[k] = -1;
			q->corner[a] = side ? 1 : -1;
			q->edge[0][e] = q->edge[1][f] = 2;
			q->dual[0][e] = q->dual[1][f] = 0.5f;
			q->normal[a] = side ? -1 : 1;
			q->light = s.surfaces.n;
			s.lights.light[s.lights.n++] = (struct light){ .kind = LIGHT_QUAD, .pick = 1 / 6.f, .pdf = 0.25f / 6, .surface = s.surfaces.n++ };
		}
	int leaks = 0, behind = 0, blocked = 0, bad = 0;
	for (int i = 0; i < 1000000; i++) {
		float x[6];
		for (int k = 0; k < 6; k++)
			x[k] = (float)(bits() >> 8) * 0x1p-23f - 1.f;
		if (i % 4 == 1)    /* a point a hair from a wall */
			x[0] = 0.99999994f;
		if (i % 4 == 2)    /* a direction that grazes */
			x[3] *= 1e-6f;
		struct ray r = { .from = vec3(x[0], x[1], x[2]), .along = unit3(vec3(x[3], x[4], x[5])), .skip = NONE };
		int which;
		float far = surface_distance(&s, r, &which);
		leaks += which == NONE;
		if (which != NONE) {
			float rgb[3], d = quad_pdf(&s, &s.lights.light[which], r.along, far);
			behind += !(d > 0.f);
			surface_radiance(&s, which, r, far, 0.1f, rgb);
			bad += !(rgb[0] == 0.f);
		}
		struct light_sample d;
		struct random random = { .key = bits(), .shift = bits() };
		light_draw(&s, &t, ALL_LANES, i % 6, r.from, &random, &d);
		if (any(d.shines)) {
			r.along = d.along;
			far = surface_distance(&s, r, &which);
			blocked += any(light_blocked(&d, which, far));
			bad += !(d.pdf > 0.f && d.t_end > 0.f && d.t_end < 4.f);
		}
	}
	/* an edge is two floats wide: of 1e6 rays 0.2 are expected on one */
	ok(leaks <= 4 && behind <= 4 && blocked <= 4 && !bad, "a box of quads: %d rays leave it, %d see a back, %d drawn are blocked, %d are no numbers", leaks, behind,
	   blocked, bad);

	/* What a map must not hold. */
	char folder[] = "/tmp/lights-XXXXXX";
	if (!mkdtemp(folder))
		die(folder, "cannot create:");
	char *path = xtext("%s/y.exr", folder);
	struct exr grey = { .width = 3, .height = 2 };
	float *y = exr_add(&grey, "Y");
	for (int i = 0; i < 6; i++)
		y[i] = (float)i;
	exr_write((struct out[]){ out_open(path, 1) }, &grey);
	struct envmap m;
	envmap_read(path, (double[]){ 1, 0.5, 2 }, &m);
	ok(m.width == 3 && m.height == 2 && m.rgb[15] == 5 && m.rgb[16] == 2.5f && m.rgb[17] == 10, "a map of Y alone, scaled by a colour");
	unlink(path);
	rmdir(folder);
	free(path);
	free(m.rgb);
	exr_free(&grey);
	return done_testing();
}

/* The kernels' particle queries: the grid misses none, flights agree with the transmittance, and Poisson particles transmit
 * as they must. With the argument "table": mean transmittance against C / A, for the chart. */
#include "base/die.h"
#include "medium/particle_grid.h"
#include "render/scene_setup.h"
#include "render/kern/volume.h"
#include "support/tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WAVES 3
#define CLASSES 2

/* A cube of side 1 m with particles at uniform places, and everything the kernels need of it. */
struct cube {
	struct medium medium;
	struct scene scene;
	struct tables tables;
	float disc_radius2[CLASSES * WAVES];
};

/* Fat rays are cylinders of that area. */
static void as_model(struct cube *q, int transport, double area)
{
	struct volume *v = &q->scene.volume[0];
	v->transport = transport;
	v->fat_area = (float)area;
	v->query_radius2 = transport == TRANSPORT_EXPLICIT ? v->largest : v->fat_area / PI;
	v->query_radius = sqrtf(v->query_radius2) + 1e-6f;
	for (int a = 0; a < 3; a++) {
		float half = 0.5f * (float)v->cells[a] * v->cell[a];
		v->grid_centre[a] = v->grid_low[a] + half;
		v->grid_reached[a] = half + v->query_radius;
	}
}

static const struct waves three = { WAVES, 0, 1 };

/* A ray walked to its end. */
static struct volume_walk walk(const struct cube *q, struct ray r, float t_end, int flight, const struct random *random)
{
	const struct volume *v = &q->scene.volume[0];
	struct volume_walk g;
	memset(&g, 0, sizeof g);
	volume_begin(&q->scene, v, &q->tables, &g, ALL_LANES, r, t_end, flight, three, random);
	volume_step(&q->scene, v, &q->tables, &g, three, random, 0);
	return g;
}

static void transmittance(const struct cube *q, struct ray r, float t_end, float *out)
{
	struct random none = { .key = 0 };
	struct volume_walk g = walk(q, r, t_end, 0, &none);
	volume_transmittance(&q->scene, &q->scene.volume[0], &q->tables, &g, ALL_LANES, three, out);
}

/* c[class][wave]: areas in m^2. */
static struct cube *make(size_t n, const double *c, uint32 seed)
{
	struct cube *q = xalloc(1, sizeof *q);
	struct medium *m = &q->medium;
	m->n_waves = WAVES;
	m->n_classes = CLASSES;
	m->c_ext = xalloc(CLASSES * WAVES, sizeof(double));
	for (int i = 0; i < CLASSES * WAVES; i++) {
		m->c_ext[i] = c[i] * 1e12;
		q->disc_radius2[i] = (float)(c[i] / M_PI);
		q->scene.volume[0].largest = fmaxf(q->scene.volume[0].largest, q->disc_radius2[i]);
	}
	m->half[0] = m->half[1] = m->half[2] = 0.5;
	m->kind = MEDIUM_PARTICLES;
	m->n_particles = n;
	m->particle = xalloc(n, 4 * sizeof(float));
	for (size_t i = 0; i < n; i++) {
		struct random r = random_of(seed, (uint32)i, 0);
		for (int a = 0; a < 3; a++)
			m->particle[4 * i + (size_t)a] = draw(&r, a) - 0.5f;
		memcpy(&m->particle[4 * i + 3], &(int32_t){ (int32_t)(draw_bits(&r, 3) & 1) }, 4);
	}
	particle_grid_build(m);
	q->scene.n_volumes = 1;
	q->scene.n_waves = q->scene.carried = WAVES;
	q->scene.n_groups = 1;
	q->scene.volume[0].n_classes = CLASSES;
	q->scene.volume[0].only_class = NONE;
	for (int a = 0; a < 3; a++) {
		q->scene.volume[0].cells[a] = m->cells[a];
		q->scene.volume[0].grid_low[a] = m->low[a];
		q->scene.volume[0].cell[a] = m->cell[a];
	}
	q->tables = (struct tables){ .disc_radius2 = q->disc_radius2, .particle = m->particle, .first = (const int *)m->first };
	as_model(q, TRANSPORT_EXPLICIT, 0);
	return q;
}

static void drop(struct cube *q)
{
	free(q->medium.c_ext);
	free(q->medium.particle);
	free(q->medium.first);
	free(q);
}

/* First particle met at a wavelength, and the transmittance, by looking at every one. */
static int brute(const struct cube *q, struct ray r, float t_end, int wave, const struct random *random, double *through)
{
	int best = NONE, fat = q->scene.volume[0].transport == TRANSPORT_FAT_RAY;
	float end = t_end;
	*through = 1;
	for (size_t i = 0; i < q->medium.n_particles; i++) {
		const float *p = q->medium.particle + 4 * i;
		int32_t class;
		memcpy(&class, &p[3], 4);
		struct vec v = vec3(p[0] - r.from.x, p[1] - r.from.y, p[2] - r.from.z);
		float depth = dot3(v, r.along);
		struct vec off = sub(v, scale(r.along, depth));
		float radius2 = q->disc_radius2[class * WAVES + wave], d2 = dot3(off, off);
		if (!(depth > 0.f) || !(depth < end) || (int)i == r.skip || !(d2 < (fat ? q->scene.volume[0].fat_area / PI : radius2)))
			continue;
		*through *= fat ? 1 - fmin(1, PI * radius2 / q->scene.volume[0].fat_area) : 0;
		if (depth < t_end && (!fat || coin(random, (int)i) < radius2 * (PI / q->scene.volume[0].fat_area))) {
			t_end = depth;
			best = (int)i;
		}
	}
	return best;
}

static struct ray some_ray(uint32 k, size_t n)
{
	struct random r = random_of(77, k, 0);
	struct ray ray = { .from = vec3(3 * draw(&r, 0) - 1.5f, 3 * draw(&r, 1) - 1.5f, 3 * draw(&r, 2) - 1.5f), .skip = NONE };
	struct vec to = vec3(draw(&r, 3) - 0.5f, draw(&r, 4) - 0.5f, draw(&r, 5) - 0.5f);
	ray.along = unit3(sub(to, ray.from));
	if (k % 16 == 0)           /* along an axis, exactly */
		ray.along = vec3(0, k % 32 ? 1 : -1, 0);
	if (k % 3 == 0)
		ray.skip = (int)(draw_bits(&r, 6) % n);
	ray.inverse = inverse3(ray.along);
	return ray;
}

static void compare(size_t n, double area, double wide, const char *what)
{
	const double c[] = { area, 1.2 * area, 0.9 * area, 3 * area, 2.5 * area, 3.5 * area };
	struct cube *q = make(n, c, 5);
	long wrong = 0, met = 0, rays = 2000;
	double off = 0;
	as_model(q, wide > 0 ? TRANSPORT_FAT_RAY : TRANSPORT_EXPLICIT, wide);
	for (uint32 k = 0; k < rays; k++) {
		float end = k % 5 ? FAR : 1.2f;
		struct ray r = some_ray(k, n);
		struct random random = random_of(3, k, 0);
		struct particle_query g = walk(q, r, end, 1, &random).particles;
		float all[WAVES];
		transmittance(q, r, end, all);
		for (int j = 0; j < WAVES; j++) {
			double through;
			wrong += g.id[j] != brute(q, r, end, j, &random, &through);
			met += g.id[j] != NONE;
			off = fmax(off, fabs(all[j] - through));
		}
	}
	ok(!wrong && met > 100, "%s: %ld rays meet what looking at every particle finds (%ld meetings, %ld differ)", what, rays, met, wrong);
	ok(off < 1e-5, "%s: and the same transmittance within %.2g", what, off);
	drop(q);
}

/* Flights through one set of particles: how many pass, and how deep the others come, against the product over the particles in
 * their order. */
static void flights(int attenuation)
{
	const double area = 1e-3, c[] = { area, area, area, 2 * area, 2 * area, 2 * area };
	const int n = 200000;
	struct cube *q = make(1000, c, 11);
	struct ray r = { vec3(-1, 0.05f, -0.02f), vec3(1, 0, 0), inverse3(vec3(1, 0, 0)), NONE, 0 };
	float through[WAVES], flight_pdf[CARRIED];
	double passed = 0, depth = 0, depth2 = 0;
	as_model(q, TRANSPORT_FAT_RAY, 5e-3);
	q->scene.volume[0].attenuation = attenuation;
	transmittance(q, r, FAR, through);
	for (int k = 0; k < n; k++) {
		struct random random = random_of(21, (uint32)k, 0);
		struct volume_walk g = walk(q, r, FAR, 1, &random);
		struct collision hit = volume_end(&q->scene, &q->scene.volume[0], &q->tables, &g, ALL_LANES, three, &random, flight_pdf);
		passed += !any(hit.happened);
		depth += any(hit.happened) ? hit.point.x + 1 : 0;
		depth2 += any(hit.happened) ? pow(hit.point.x + 1, 2) : 0;
	}
	/* E[depth; met] = int (T(x) - T(end)) dx along the ray, T by looking at the particles before x */
	double want = 0, step = 1e-3;
	for (double x = step / 2; x < 2; x += step) {
		float before[WAVES];
		transmittance(q, r, (float)x, before);
		want += step * ((double)before[1] - through[1]);
	}
	double z = (passed / n - through[1]) / sqrt(through[1] * (1 - through[1]) / n);
	double z2 = (depth / n - want) / sqrt((depth2 / n - pow(depth / n, 2)) / n);
	const char *law = attenuation == ATTENUATION_PRODUCT ? "product" : "exponential";
	/* two z-scores below 4 (and the quadrature's error well below the noise): false alarm 1.3e-4 */
	ok(fabs(z) < 4, "%s: %.4f of the flights pass, transmittance %.4f, z %.2f", law, passed / n, through[1], z);
	ok(fabs(z2) < 4, "%s: mean depth %.5f, wanted %.5f, z %.2f", law, depth / n, want, z2);
	drop(q);
}

static size_t poisson(double mean, uint32 seed)
{
	struct random r = random_of(99, seed, 0);
	size_t n = 0;
	for (double sum = 0;; n++, next_vertex(&r, ALL_LANES)) {
		sum -= log(1 - draw(&r, 0));
		if (sum > mean)
			return n;
	}
}

struct moments {
	double n, sum[5];          /* sum[k]: of T^k */
};

/* Transmittances of rays far enough apart to meet different particles, through many cubes of Poisson particles of cross section C,
 * by cylinders of area A. */
static struct moments transmittances(double tau, double c, double a, int transport, int attenuation, int cubes)
{
	const double all[] = { c, c, c, c, c, c };
	const int side = 24;       /* rays 1/24 m apart; the cylinder's radius must be below half that */
	struct moments m = { 0 };
	for (int k = 0; k < cubes; k++) {
		struct cube *q = make(poisson(tau / c, (uint32)(k + 1)), all, (uint32)(1000 + k));
		as_model(q, transport, a);
		q->scene.volume[0].attenuation = attenuation;
		for (int axis = 0; axis < 3; axis++)
			for (int i = 0; i < side * side; i++) {
				float p[3], d[3] = { 0, 0, 0 }, through[WAVES];
				p[axis] = -1;
				d[axis] = 1;
				p[(axis + 1) % 3] = ((float)(i % side) + 0.5f) / (float)side - 0.5f;
				p[(axis + 2) % 3] = ((float)(i / side) + 0.5f) / (float)side - 0.5f;
				struct ray r = { load3(p), load3(d), inverse3(load3(d)), NONE, 0 };
				transmittance(q, r, FAR, through);
				for (int e = 0; e < 5; e++)
					m.sum[e] += pow(through[1], e);
				m.n++;
			}
		drop(q);
	}
	return m;
}

/* Mean and second moment that theory gives. Exponential: exp[-(tau A/C)(1 - e^(-k C/A))] for the k-th; product: e^-tau and
 * exp[-tau (2 - C/A)]; explicit: e^-tau for all. */
static double theory(double tau, double ratio, int transport, int attenuation, int k)
{
	if (transport == TRANSPORT_EXPLICIT)
		return exp(-tau);
	if (attenuation == ATTENUATION_EXPONENTIAL)
		return exp(-tau / ratio * -expm1(-k * ratio));
	return exp(-tau / ratio * (1 - pow(1 - ratio, k)));
}

static const struct { const char *name; int transport, attenuation; } laws[] = {
	{ "explicit", TRANSPORT_EXPLICIT, 0 },
	{ "product", TRANSPORT_FAT_RAY, ATTENUATION_PRODUCT },
	{ "exponential", TRANSPORT_FAT_RAY, ATTENUATION_EXPONENTIAL },
};

static void transmits(int law, double tau, double ratio)
{
	const double a = 2e-4;
	struct moments m = transmittances(tau, ratio * a, a, laws[law].transport, laws[law].attenuation, 25);
	for (int k = 1; k <= 2; k++) {
		double mean = m.sum[k] / m.n, spread = sqrt((m.sum[2 * k] / m.n - mean * mean) / (m.n - 1));
		double want = theory(tau, ratio, laws[law].transport, laws[law].attenuation, k), z = (mean - want) / spread;
		ok(fabs(z) < 4, "%s, tau %.1f, C/A %.1f: E[T^%d] = %.5f, wanted %.5f, z %.2f", laws[law].name, tau, ratio, k, mean, want, z);
	}
	if (laws[law].transport == TRANSPORT_EXPLICIT) {
		double mean = m.sum[1] / m.n, variance = (m.sum[2] / m.n - mean * mean) * m.n / (m.n - 1), mu2 = exp(-tau) * (1 - exp(-tau));
		/* the fourth central moment of a 0-1 variable gives the spread of its sample variance */
		double z = (variance - mu2) / sqrt((mu2 * (1 - 3 * mu2) - mu2 * mu2) / m.n);
		ok(fabs(z) < 4, "explicit, tau %.1f: variance %.5f, wanted %.5f, z %.2f", tau, variance, mu2, z);
	}
}

static void table(double tau)
{
	printf("# tau %g\n# C/A\tlaw\tmean\terror\ttheory\tbeer\n", tau);
	for (size_t law = 1; law < 3; law++) {
		for (double ratio = 0.05; ratio <= 1.0001; ratio += 0.095) {
			struct moments m = transmittances(tau, ratio * 2e-4, 2e-4, laws[law].transport, laws[law].attenuation, 20);
			double mean = m.sum[1] / m.n, error = sqrt((m.sum[2] / m.n - mean * mean) / (m.n - 1));
			printf("%.3f\t%s\t%.5f\t%.5f\t%.5f\t%.5f\n", ratio, laws[law].name, mean, error,
			       theory(tau, ratio, laws[law].transport, laws[law].attenuation, 1), exp(-tau));
		}
		printf("\n\n");
	}
}

int main(int argc, char **argv)
{
	if (argc > 1 && !strcmp(argv[1], "table")) {
		table(2);
		return 0;
	}
	compare(1, 0.05, 0, "one particle");
	compare(2000, 2e-4, 0, "2,000 particles");
	compare(3000, 0.02, 0, "overlapping discs");
	compare(2000, 2e-4, 1e-3, "fat rays");
	compare(3000, 0.002, 0.05, "very fat rays");
	flights(ATTENUATION_PRODUCT);
	flights(ATTENUATION_EXPONENTIAL);
	/* 33 z-scores below 4: false alarm 2e-3, for seeds fixed beforehand */
	for (int i = 0; i < 3; i++)
		transmits(0, (double[]){ 0.5, 1, 2 }[i], 1);
	for (int law = 1; law < 3; law++)
		for (int t = 0; t < 2; t++)
			for (int i = 0; i < 3; i++)
				transmits(law, (double[]){ 0.5, 2 }[t], (double[]){ 0.1, 0.5, 1 }[i]);
	return done_testing();
}

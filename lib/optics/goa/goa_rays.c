#include "optics/goa/goa_rays.h"

#include "optics/goa/debye_order.h"
#include "optics/goa/goa.h"

#include <stdlib.h>
#include <string.h>

void goa_rays_fresnel(double complex m, double sin_i, double cos_i, double complex *r1, double complex *r2)
{
	double complex ct;
	if (cimag(m) == 0) {
		double n = creal(m), q2 = (n - 1) * (n + 1) + cos_i * cos_i;
		ct = q2 >= 0 ? sqrt(q2) / n : CMPLX(0, sqrt(-q2) / n);
	} else {
		ct = csqrt((m * m - sin_i * sin_i) / (m * m));
		ct = CMPLX(creal(ct), fabs(cimag(ct)));    /* rounding may have put 1 + i0 below the cut */
	}
	*r1 = (cos_i - m * ct) / (cos_i + m * ct);
	*r2 = (m * cos_i - ct) / (m * cos_i + ct);
}

int goa_rays_trace(double complex m, int order, const struct caustic *caustic, double theta, struct goa_beam *out)
{
	struct ray ray[RAYS_MAX(GOA_ORDER_MAX)];
	int n = 0;
	for (int p = 0; p <= order; p++) {
		int rays = rays_find(creal(m), p, &caustic[p], theta, ray);
		for (int k = 0; k < rays; k++) {
			const struct ray *r = &ray[k];
			struct goa_beam *b = &out[n];
			double complex r1, r2;
			goa_rays_fresnel(m, r->sin_i, r->cos_i, &r1, &r2);
			double complex f1 = p ? 1 - r1 * r1 : r1, f2 = p ? 1 - r2 * r2 : r2;
			for (int i = 1; i < p; i++) {
				f1 *= -r1;
				f2 *= -r2;
			}
			if (cabs(f1) + cabs(f2) < 1e-18)    /* nothing, whatever the size; of 100 orders most */
				continue;
			b->f1 = f1;
			b->f2 = f2;
			/* q and cos i have digits that u has lost */
			double complex chord = cimag(m) == 0 ? 2 * r->q : debye_order_chord(m, r->sin_i);
			b->path = (p ? p * chord : 0) - 2 * r->cos_i;
			b->ray = *r;
			n++;
		}
	}
	return n;
}

/* The size from which on no cap acts. */
static double settled(const struct ray *r, const struct caustic *c)
{
	if (r->p == 0)
		return 0;
	double k = 0.4607 * 0.4607 * c->third, until = fmax(k / (r->slope * r->slope), 2 / r->slope);
	if (!isnan(c->tau)) {
		double cosine = cos(c->incidence);
		until = fmax(until, sqrt(c->bend / (2 * cosine * cosine * r->gap * r->gap * r->gap)));
	}
	/* sin i/sin theta */
	return fmax(until, r->axial ? fmax(k * r->ratio * r->ratio, 2 * r->ratio) : r->ratio / (r->sin_i * r->sin_i));
}

static void put(struct goa_packet *k, int lane, const struct goa_beam *b, const struct caustic *caustic)
{
	double spread = rays_spread(&b->ray);
	k->path[lane] = creal(b->path) * M_2_PI;
	k->quarters[lane] = b->ray.eighths / 2.0;
	k->fade[lane] = cimag(b->path);
	k->fades |= k->fade[lane] != 0;
	k->clearest = fminf(k->clearest, (float)k->fade[lane]);
	k->spread[lane] = spread < 1e15 ? spread : 1e15;
	double until = settled(&b->ray, &caustic[b->ray.p]);
	k->until[lane] = until >= 0 ? until : INFINITY;
	k->f[0][lane] = -creal(b->f1);
	k->f[1][lane] = -cimag(b->f1);
	k->f[2][lane] = -creal(b->f2);
	k->f[3][lane] = -cimag(b->f2);
	k->ray[lane] = b->ray;
}

int goa_rays_find(double complex m, int order, const struct caustic *caustic, int n, const double *theta, struct goa_rays *out)
{
	int blocks = angle_blocks_count(n), beams = 0;
	size_t used = 0, room = 0;
	for (int p = 0; p <= order; p++)
		beams += RAYS_MAX(p);
	struct goa_beam *beam = malloc((size_t)beams * sizeof *beam);
	memset(out, 0, sizeof *out);
	out->angles = calloc((size_t)(blocks ? blocks : 1), sizeof *out->angles);
	if (!beam || !out->angles || angle_blocks_new(n, theta, &out->blocks))
		goto no_memory;
	for (int b = 0; b < blocks; b++) {
		out->blocks.first[b] = used;
		for (int lane = 0; lane < GOA_WIDTH && b * GOA_WIDTH + lane < n; lane++) {
			double t = theta[b * GOA_WIDTH + lane];
			int k = goa_rays_trace(m, order, caustic, t, beam);
			size_t end = out->blocks.first[b] + (size_t)k;
			if (t < 90) {
				double sine = sin(t * (M_PI / 180));
				out->angles[b].sine[lane] = sine;
				out->angles[b].root[lane] = sqrt(2 / (M_PI * fmax(sine, 1e-100))) / fmax(sine, 1e-100);
			}
			if (end > used && angle_blocks_room(&out->packet, &room, used, end - used, sizeof *out->packet))
				goto no_memory;
			for (; used < end; used++) {
				memset(&out->packet[used], 0, sizeof out->packet[used]);
				out->packet[used].clearest = INFINITY;
			}
			for (int i = 0; i < k; i++)
				put(&out->packet[out->blocks.first[b] + (size_t)i], lane, &beam[i], caustic);
		}
	}
	out->blocks.first[blocks] = used;
	free(beam);
	return 0;
no_memory:
	free(beam);
	goa_rays_free(out);
	return -1;
}

void goa_rays_free(struct goa_rays *r)
{
	angle_blocks_free(&r->blocks);
	free(r->packet);
	free(r->angles);
	memset(r, 0, sizeof *r);
}

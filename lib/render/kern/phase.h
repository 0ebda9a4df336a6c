/* phase - tabulated phase functions: values, and directions drawn exactly by them, both at a cost that does not grow with the table.
 *
 * A table is intervals of the angle, in each of which p is linear. An angle finds its interval by an index of two levels:
 * ANGLE_STEPS equal steps of [0, pi], each divided into as many equal parts as keep its nodes apart. A draw finds its interval by an
 * alias table (Walker 1977) of a power of two of columns, so that all its shares are integers: column c holds 2^shift of 2^32, the
 * first threshold of them of interval c, the rest of another. lib/render/phase_sampler.c makes both. */
#ifndef KERN_PHASE_H
#define KERN_PHASE_H

#include "render/kern/random.h"
#include "render/kern/math.h"
#include "render/kern/waves.h"

/* The row of a class: its first interval, first column, 32 - log2 of the number of columns, and first step. */
enum { PHASE_INTERVAL, PHASE_COLUMN, PHASE_SHIFT, PHASE_STEP, PHASE_ROW };

struct interval {
	fv sine, cosine, theta, width;    /* of its first angle; rad */
	fv p[CARRIED], slope[CARRIED];    /* p(theta + t) = p + slope t */
};

/* An entry of a class's row; only: the class of all lanes, or -1. */
FN iv phase_row(const struct tables *t, mv m, int only, iv class, int k)
{
	return only >= 0 ? IV(int_at(t->phase, PHASE_ROW * only + k)) : igather(m, t->phase, PHASE_ROW * class + k);
}

#define INTERVAL_ROW(waves) (4 + 2 * (waves))

FN void interval_load(const struct scene *s, const struct tables *t, mv m, iv i, struct waves w, struct interval *out)
{
	iv row = INTERVAL_ROW(N_WAVES) * i;
	fv q[4];
	gather4(m, t->interval, row, 0, q);
	out->sine = q[0];
	out->cosine = q[1];
	out->theta = q[2];
	out->width = q[3];
	for (int j = 0; j < CARRIED; j += 2) {
#ifdef WAVES
		gather4(m, t->interval, row, 4 + 2 * j, q);    /* two wavelengths; beyond the last one, what follows */
#else
		EACH(k, 4)
			q[k] = gather(m, t->interval, row + (4 + k % 2) + 2 * wave_of(s, w, j + k / 2));
#endif
		out->p[j] = q[0];
		out->slope[j] = q[1];
		if (j + 1 < CARRIED) {
			out->p[j + 1] = q[2];
			out->slope[j + 1] = q[3];
		}
	}
}

/* value[j] in sr^-1 at an angle in [0, pi]. */
FN void phase_value(const struct scene *s, const struct tables *t, mv m, int only, iv class, fv theta, struct waves w, fv *value)
{
	fv place = theta * ((float)ANGLE_STEPS / PI);
	iv step = iv_min(to_int(place), IV(ANGLE_STEPS - 1)), row = phase_row(t, m, only, class, PHASE_STEP) + 2 * step;
	iv parts[2], at[2];        /* the first part and their number; the interval where a part begins, and where the next one does */
	igather2(m, t->angle, row, parts);
	iv part = iv_min(to_int((place - to_float(step)) * to_float(parts[1])), parts[1] - 1);
	igather2(m, t->angle, parts[0] + 2 * part, at);
	at[0] += SEL(le(bits_float(unsigned_of(at[1])), theta), IV(1), IV(0));
	struct interval i;
#if defined WAVES && WAVES == 1
	fv q[4];                   /* all that is needed in one row */
	gather4(m, t->interval, INTERVAL_ROW(1) * at[0], 2, q);
	i = (struct interval){ .theta = q[0], .width = q[1], .p = { q[2] }, .slope = { q[3] } };
#else
	interval_load(s, t, m, at[0], w, &i);
#endif
	fv along = fv_min(i.width, fv_max(FV(0.f), theta - i.theta));
	EACH_WAVE(j)
		value[j] = i.p[j] + i.slope[j] * along;
}

/* A scattering angle, by its sine and cosine, with the density p(theta) sin(theta) of the hero: the interval by its tabulated
 * probability, the place in it by inverting the integral of (linear p) x sin, sin being a cubic over an interval (at most 1 degree:
 * relative error 4e-9), with one step of Newton, which is enough for intervals as phase_sampler.c makes them: within 1e-5 of their width.
 * value[j]: p there in sr^-1. Returns the interval. */
FN iv phase_draw(const struct scene *s, const struct tables *t, mv m, int only, iv class, struct waves w, uv u, uv v, fv *sine,
                 fv *cosine, fv *value)
{
	iv shift = phase_row(t, m, only, class, PHASE_SHIFT);
	uv column = SEL(m, u >> unsigned_of(shift), UV(0)), rest = u - (column << unsigned_of(shift));
	iv entry = 2 * ((phase_row(t, m, only, class, PHASE_COLUMN) + signed_of(column)) * N_WAVES + hero_of(s, w));
	iv alias[2];
	igather2(m, t->alias, entry, alias);
	iv at = phase_row(t, m, only, class, PHASE_INTERVAL) + SEL(ilt(signed_of(rest), alias[0]), signed_of(column), alias[1]);
	struct interval i;
	interval_load(s, t, m, at, w, &i);
	fv sn = i.sine, cs = i.cosine, h = i.width, p = hero_among(s, i.p, w), d = hero_among(s, i.slope, w) * h;
	/* density (p + d f) (sn + c1 f + c2 f^2 + c3 f^3) = q[0] + q[1] f + .. + q[4] f^4 */
	fv c1 = cs * h, c2 = -0.5f * sn * h * h, c3 = -0.166666667f * cs * h * h * h;
	const fv q[5] = { p * sn, p * c1 + d * sn, p * c2 + d * c1, p * c3 + d * c2, d * c3 };
	fv x = h * invert_density(q, unit_of(v) + 0x1p-25f, 1), x2 = x * x;
	fv turn = x - x * x2 * 0.166666667f, back = x2 * (0.5f - x2 * 0.0416666667f);    /* sin x, 1 - cos x */
	*sine = sn + (cs * turn - sn * back);
	*cosine = cs - (sn * turn + cs * back);
	EACH_WAVE(j)
		value[j] = i.p[j] + i.slope[j] * x;
	return at;
}

#endif

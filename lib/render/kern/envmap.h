/* envmap - the map around everything: latitude and longitude, constant over a texel. */
#ifndef KERN_ENVMAP_H
#define KERN_ENVMAP_H

#include "render/kern/math.h"
#include "render/kern/scene.h"

/* Solid angle of a texel: by the polar angle of its middle, from the nearer pole, where the sine is relative. */
FN fv texel_angle(const struct lights *l, iv row)
{
	fv sn, cs;
	fv_sincos((to_float(iv_min(row, l->map_height - 1 - row)) + 0.5f) * (PI / (float)l->map_height), &sn, &cs);
	return sn * l->map_angle;
}

/* Width of an interval of a CDF in units of 2^-31. All of it, 2^31, is no signed number: one less is, and the same float. */
FN fv cdf_width(INTS cdf, mv m, iv i)
{
	uv width = unsigned_of(igather(m, cdf, i + 1)) - unsigned_of(igather(m, cdf, i));
	return to_float(signed_of(width - (width >> 31)));
}

/* Pdf of drawing a direction in a texel, sr^-1. */
FN fv envmap_pdf(const struct lights *l, const struct tables *t, mv m, iv row, iv column)
{
	iv columns = l->map_height + 1 + row * (l->map_width + 1);
	fv share = cdf_width(t->map_cdf, m, row) * 0x1p-31f * (cdf_width(t->map_cdf, m, columns + column) * 0x1p-31f);
	return share * l->map_pick / texel_angle(l, row);
}

/* The texel in a direction: top row +y, centre column -z, columns turn towards +x. */
FN void envmap_locate(const struct lights *l, struct vec d, iv *row, iv *column)
{
	fv polar = fv_atan2(fv_sqrt(d.x * d.x + d.z * d.z), d.y) / PI, azimuth = 0.5f + fv_atan2(d.x, -d.z) / (2.f * PI);
	*row = to_int(fv_min(polar * (float)l->map_height, FV((float)l->map_height - 1.f)));
	*column = to_int(fv_max(FV(0.f), fv_min(azimuth * (float)l->map_width, FV((float)l->map_width - 1.f))));
}

FN void envmap_value(const struct lights *l, const struct tables *t, mv m, iv row, iv column, fv *rgb)
{
	EACH(c, 3)
		rgb[c] = gather(m, t->map, 3 * (row * l->map_width + column) + c);
}

/* The interval of cdf[n + 1], which begins at index from, in units of 2^-31, that u of 32 bits falls into, and the place in it, in
 * (0, 1]. Compared less 1, so that 2^31 is a signed number. */
FN iv cdf_draw(INTS cdf, mv m, iv from, int n, uv u, fv *place)
{
	iv low = IV(0), high = IV(n), target = signed_of(u >> 1);
	for (mv on = m & ilt(low + 1, high); any(on); on &= ilt(low + 1, high)) {
		iv middle = signed_of(unsigned_of(low + high) >> 1);
		mv below = ilt(signed_of(unsigned_of(igather(on, cdf, from + middle)) - 1u), target);
		SET(on & below, low, middle);
		SET(on & NOT(below), high, middle);
	}
	iv begin = igather(m, cdf, from + low);
	fv width = cdf_width(cdf, m, from + low);
	*place = fv_min(FV(1.f), (to_float(signed_of(unsigned_of(target) - unsigned_of(begin))) + 0.5f) / fv_max(width, FV(1.f)));
	return low;
}

/* A direction of the map by its luminance: texel by texel exactly as tabulated, uniform in solid angle over one. */
FN struct vec envmap_draw(const struct lights *l, const struct tables *t, mv m, uv u, uv v, iv *row, iv *column)
{
	fv down, across, sn, cs, step = FV(PI / (float)l->map_height);
	*row = cdf_draw(t->map_cdf, m, IV(0), l->map_height, u, &down);
	*column = cdf_draw(t->map_cdf, m, l->map_height + 1 + *row * (l->map_width + 1), l->map_width, v, &across);
	/* sin^2(theta / 2), linear in solid angle, from the nearer pole, where it resolves the smallest texel */
	mv north = ilt(*row, IV(l->map_height / 2));
	fv from = to_float(SEL(north, *row, l->map_height - 1 - *row));
	fv_sincos(0.5f * from * step, &sn, &cs);
	fv h0 = sn * sn;
	fv_sincos(0.5f * (from + 1.f) * step, &sn, &cs);
	fv h = h0 + (sn * sn - h0) * SEL(north, down, 1.f - down);
	fv y = 1.f - 2.f * h, out = 2.f * fv_sqrt(h * (1.f - h));
	fv_sincos(2.f * PI * fv_min(FV(1.f), (to_float(*column) + across) / (float)l->map_width), &sn, &cs);
	return vec3(-out * sn, SEL(north, y, -y), out * cs);    /* the left edge is +z, a quarter turn from there -x */
}

#endif

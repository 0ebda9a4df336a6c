#include "optics/index/ior.h"

#include <math.h>
#include <stdlib.h>
#include <strings.h>

/* A decimal number at the start of text; no blanks, hexadecimal, infinities or NaN. */
static int number(const char *text, double *out, char **rest)
{
	const char *c = text + (*text == '+' || *text == '-');
	if (!(*c >= '0' && *c <= '9') && !(*c == '.' && c[1] >= '0' && c[1] <= '9'))
		return 0;
	if (*c == '0' && (c[1] == 'x' || c[1] == 'X'))
		return 0;
	*out = strtod(text, rest);
	return 1;
}

/* The imaginary unit, and nothing after it: i, or j as electrical engineers write it. */
static int imaginary(const char *text)
{
	return (*text == 'i' || *text == 'j') && !text[1];
}

const char *ior_parse(const char *text, struct ior *out)
{
	double re, im = 0;
	char *rest;
	out->material = NULL;
	for (size_t i = 0; i < n_materials; i++)
		if (!strcasecmp(text, materials[i].name)) {
			out->material = &materials[i];
			out->value = 0;
			return NULL;
		}
	if (!number(text, &re, &rest))
		return materials_unknown;
	if (imaginary(rest))
		return "has no real part, which must be greater than 0";
	if (*rest) {
		if ((*rest != '+' && *rest != '-') || !number(rest, &im, &rest) || !imaginary(rest))
			return "is not a refractive index (write it like 1.33 or 1.5+0.1i)";
		if (signbit(im))
			return "has a negative imaginary part; here a positive one absorbs (write it like 1.5+0.1i)";
	}
	if (!(re > 0))
		return "has a real part that is not greater than 0";
	if (!isfinite(re) || !isfinite(im))
		return "is too large";
	out->value = re + im * I;
	return NULL;
}

const char *ior_at(const struct ior *ior, double wavelength, double complex *out)
{
	const struct material *m = ior->material;
	if (!m) {
		*out = ior->value;
		return NULL;
	}
	if (!(wavelength >= m->wavelength[0] && wavelength <= m->wavelength[m->n - 1]))
		return m->outside;
	size_t lo = 0, hi = m->n - 1;
	while (hi - lo > 1) {
		size_t mid = lo + (hi - lo) / 2;
		if (m->wavelength[mid] <= wavelength)
			lo = mid;
		else
			hi = mid;
	}
	double t = (wavelength - m->wavelength[lo]) / (m->wavelength[hi] - m->wavelength[lo]);
	double k0 = m->im[lo], k1 = m->im[hi];
	/* The ends come out as tabulated, to the bit. */
	double re = t == 0 ? m->re[lo] : t == 1 ? m->re[hi] : m->re[lo] + t * (m->re[hi] - m->re[lo]);
	double im = t == 0 ? k0 : t == 1 ? k1 : k0 > 0 && k1 > 0 ? k0 * pow(k1 / k0, t) : k0 + t * (k1 - k0);
	*out = re + im * I;
	return NULL;
}

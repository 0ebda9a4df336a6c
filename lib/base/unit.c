#include "base/unit.h"

#include "base/die.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LIST_MAX 10000000.0    /* values in a range: beyond that it is a slip */
#define LIGHT 299792458.0      /* speed of light in vacuum, m/s */

/* A number and its unit: 10^exponent of metres or hertz, 10^0 of plain numbers. */
struct part {
	double value;
	int exponent, frequency;
};

/* A decimal number at the start of text; hexadecimal, infinities and NaN are not numbers here. */
static const char *number(const char *text, double *out, char **rest)
{
	const char *c = text + (*text == '+' || *text == '-');
	if (!(*c >= '0' && *c <= '9') && !(*c == '.' && c[1] >= '0' && c[1] <= '9'))
		return "is not a number";
	if (*c == '0' && (c[1] == 'x' || c[1] == 'X'))
		return "is not a decimal number";
	*out = strtod(text, rest);
	return isfinite(*out) ? NULL : "is too large";
}

const char *unit_real(const char *text, double *out)
{
	char *rest;
	const char *bad = number(text, out, &rest);
	return bad ? bad : *rest ? "is not a number" : NULL;
}

const char *unit_int(const char *text, long long *out)
{
	double v;
	const char *bad = unit_real(text, &v);
	if (bad)
		return bad;
	if (v != floor(v) || fabs(v) > 0x1p53)
		return "is not a whole number";
	*out = (long long)v;
	return NULL;
}

/* 10^e is exact for 0 <= e <= 22, so that one rounding is all there is. */
static double scale10(double v, int e)
{
	double p = 1;
	for (int i = abs(e); i > 0; i--)
		p *= 10;
	return e < 0 ? v / p : v * p;
}

static const char *length_part(const char *text, struct part *out)
{
	static const struct { const char *name; int exponent; } units[] = {
		{ "nm", -9 }, { "um", -6 }, { "\xc2\xb5m", -6 }, { "\xce\xbcm", -6 },    /* the signs micro and mu, in UTF-8 */
		{ "mm", -3 }, { "cm", -2 }, { "m", 0 }, { "km", 3 },
	};
	char *rest;
	const char *bad = number(text, &out->value, &rest);
	if (bad)
		return strstr(bad, "large") ? bad : "is not a length (write it like 10um or 550nm)";
	out->frequency = 0;
	for (size_t i = 0; i < sizeof units / sizeof *units; i++)
		if (!strcmp(rest, units[i].name)) {
			out->exponent = units[i].exponent;
			return NULL;
		}
	return *rest ? "has an unknown unit (nm, um, mm, cm, m, km)" : "is a length without a unit (write it like 10um or 550nm)";
}

/* A wavelength in vacuum, or the frequency that has it. */
static const char *wavelength_part(const char *text, struct part *out)
{
	static const struct { const char *name; int exponent; } units[] = { { "kHz", 3 }, { "MHz", 6 }, { "GHz", 9 }, { "THz", 12 } };
	char *rest;
	if (!number(text, &out->value, &rest))
		for (size_t i = 0; i < sizeof units / sizeof *units; i++)
			if (!strcmp(rest, units[i].name)) {
				out->exponent = units[i].exponent;
				out->frequency = 1;
				return out->value > 0 ? NULL : "is not a frequency above 0";
			}
	const char *bad = length_part(text, out);
	return bad && strstr(bad, "unknown") ? "has an unknown unit (nm, um, mm, cm, m, km; kHz, MHz, GHz, THz)" : bad;
}

static const char *plain_part(const char *text, struct part *out)
{
	out->exponent = out->frequency = 0;
	return unit_real(text, &out->value);
}

/* In 10^exponent metres, or plain. */
static const char *convert(const struct part *p, int exponent, double *out)
{
	*out = p->frequency ? LIGHT / scale10(p->value, p->exponent + exponent) : scale10(p->value, p->exponent - exponent);
	return isfinite(*out) ? NULL : "is too large";
}

const char *unit_length(const char *text, int exponent, double *out)
{
	struct part p;
	const char *bad = length_part(text, &p);
	return bad ? bad : convert(&p, exponent, out);
}

typedef const char *part_parser(const char *text, struct part *out);

static const char *list(const char *text, part_parser *parse, int exponent, int by_step, struct reals *out)
{
	char *copy = xtext("%s", text), *word[3];
	struct part p[3];
	int n = 0;
	const char *bad = NULL;
	out->v = NULL;
	out->n = 0;
	if (!strchr(text, ':')) {
		for (char *c = copy; !bad && c;) {
			char *comma = strchr(c, ',');
			if (comma)
				*comma++ = 0;
			bad = parse(c, &p[0]);
			if (!bad) {
				out->v = xgrow(out->v, out->n + 1, sizeof *out->v);
				bad = convert(&p[0], exponent, &out->v[out->n++]);
			}
			c = comma;
		}
		free(copy);
		return bad;
	}
	for (char *c = copy, *next; c && n < 4; c = next, n++) {
		next = strchr(c, ':');
		if (next)
			*next++ = 0;
		if (n < 3)
			word[n] = c;
	}
	if (n != 3) {
		free(copy);
		return by_step ? "is not a range FROM:TO:STEP" : "is not a range FROM:TO:COUNT";
	}
	for (int i = 0; !bad && i < 3; i++)
		bad = i == 2 && !by_step ? plain_part(word[i], &p[i]) : parse(word[i], &p[i]);
	free(copy);
	if (bad)
		return bad;
	if (p[1].frequency != p[0].frequency || (by_step && p[2].frequency != p[0].frequency))
		return "mixes lengths and frequencies";
	/* In one unit all through, decimals stay what they are: 380nm:780nm:10nm has 550/1000 um in it. */
	double v[3];
	for (int i = 0; i < 3; i++)
		v[i] = i < (by_step ? 3 : 2) ? scale10(p[i].value, p[i].exponent - p[0].exponent) : p[i].value;
	if (!isfinite(v[1]) || !isfinite(v[2]) || !isfinite(v[1] - v[0]) || !isfinite(scale10(v[1], p[0].exponent - exponent)))
		return "is too large";
	double count = by_step ? floor((v[1] - v[0]) / v[2] * (1 + 1e-12) + 1e-9) + 1 : v[2];
	if (by_step ? !(v[2] > 0) || v[1] < v[0] : !(v[0] > 0) || v[1] < v[0] || count != floor(count) || count < 1)
		return by_step ? "needs FROM <= TO and STEP > 0" : "needs 0 < FROM <= TO and a whole COUNT";
	if (!(count <= LIST_MAX))
		return "has too many values";
	out->n = (size_t)count;
	out->v = xalloc(out->n, sizeof *out->v);
	for (size_t i = 0; i < out->n; i++) {
		p[0].value = by_step ? v[0] + (double)i * v[2]
		    : i == 0 ? v[0] : i == out->n - 1 ? v[1]
		    : v[0] * pow(v[1] / v[0], (double)i / (double)(out->n - 1));
		bad = convert(&p[0], exponent, &out->v[i]);
	}
	return bad;
}

const char *unit_lengths(const char *text, int exponent, int by_step, struct reals *out)
{
	return list(text, length_part, exponent, by_step, out);
}

const char *unit_wavelengths(const char *text, int exponent, struct reals *out)
{
	return list(text, wavelength_part, exponent, 1, out);
}

const char *unit_reals(const char *text, int by_step, struct reals *out)
{
	return list(text, plain_part, 0, by_step, out);
}

const char *unit_concentration(const char *text, double *out)
{
	char *rest;
	const char *bad = number(text, out, &rest);
	if (bad)
		return bad;
	if (!strcmp(rest, "/cm3"))
		*out *= 1e6;
	else if (strcmp(rest, "/m3"))
		return "is a concentration without a unit (write it like 4e12/m3 or 100/cm3)";
	return *out >= 0 && isfinite(*out) ? NULL : "is out of range";
}

const char *unit_bytes(const char *text, double *out)
{
	static const char *const suffix[] = { "", "KiB", "MiB", "GiB" };
	char *rest;
	const char *bad = number(text, out, &rest);
	if (bad)
		return bad;
	for (int i = 0; i < 4; i++, *out *= 1024)
		if (!strcmp(rest, suffix[i]))
			return *out >= 1 && isfinite(*out) ? NULL : "is out of range";
	return "has an unknown unit (KiB, MiB, GiB)";
}

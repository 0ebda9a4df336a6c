#include "base/unit.h"

#include "base/die.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LIST_MAX 10000000.0    /* values in a range: beyond that it is a slip */

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

static const char *length_parts(const char *text, double *value, int *exponent)
{
	static const struct { const char *name; int exponent; } units[] = {
		{ "nm", -9 }, { "um", -6 }, { "mm", -3 }, { "cm", -2 }, { "m", 0 }, { "km", 3 },
	};
	char *rest;
	const char *bad = number(text, value, &rest);
	if (bad)
		return strstr(bad, "large") ? bad : "is not a length (write it like 10um or 550nm)";
	for (size_t i = 0; i < sizeof units / sizeof *units; i++)
		if (!strcmp(rest, units[i].name)) {
			*exponent = units[i].exponent;
			return NULL;
		}
	return *rest ? "has an unknown unit (nm, um, mm, cm, m, km)" : "is a length without a unit (write it like 10um or 550nm)";
}

const char *unit_length(const char *text, int exponent, double *out)
{
	int e;
	const char *bad = length_parts(text, out, &e);
	if (bad)
		return bad;
	*out = scale10(*out, e - exponent);
	return isfinite(*out) ? NULL : "is too large";
}

/* One entry of a list: its number and its unit's exponent (0 for plain numbers). */
typedef const char *part_parser(const char *text, double *value, int *exponent);

static const char *plain_parts(const char *text, double *value, int *exponent)
{
	*exponent = 0;
	return unit_real(text, value);
}

static const char *list(const char *text, part_parser *parse, int exponent, int by_step, struct reals *out)
{
	char *copy = xtext("%s", text), *part[3];
	double v[3];
	int e[3], n = 0;
	const char *bad = NULL;
	out->v = NULL;
	out->n = 0;
	if (!strchr(text, ':')) {
		for (char *c = copy; !bad && c;) {
			char *comma = strchr(c, ',');
			if (comma)
				*comma++ = 0;
			bad = parse(c, v, e);
			if (!bad) {
				out->v = xgrow(out->v, out->n + 1, sizeof *out->v);
				out->v[out->n] = scale10(v[0], e[0] - exponent);
				bad = isfinite(out->v[out->n++]) ? NULL : "is too large";
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
			part[n] = c;
	}
	if (n != 3) {
		free(copy);
		return by_step ? "is not a range FROM:TO:STEP" : "is not a range FROM:TO:COUNT";
	}
	for (int i = 0; !bad && i < 3; i++)
		bad = i == 2 && !by_step ? plain_parts(part[i], &v[i], &e[i]) : parse(part[i], &v[i], &e[i]);
	free(copy);
	if (bad)
		return bad;
	/* In one unit all through, decimals stay what they are: 380nm:780nm:10nm has 550/1000 um in it. */
	int common = e[0];
	for (int i = 1; i < (by_step ? 3 : 2); i++)
		v[i] = scale10(v[i], e[i] - common);
	if (!isfinite(v[1]) || !isfinite(v[2]) || !isfinite(v[1] - v[0]) || !isfinite(scale10(v[1], common - exponent)))
		return "is too large";
	double count = by_step ? floor((v[1] - v[0]) / v[2] * (1 + 1e-12) + 1e-9) + 1 : v[2];
	if (by_step ? !(v[2] > 0) || v[1] < v[0] : !(v[0] > 0) || v[1] < v[0] || count != floor(count) || count < 1)
		return by_step ? "needs FROM <= TO and STEP > 0" : "needs 0 < FROM <= TO and a whole COUNT";
	if (!(count <= LIST_MAX))
		return "has too many values";
	out->n = (size_t)count;
	out->v = xalloc(out->n, sizeof *out->v);
	for (size_t i = 0; i < out->n; i++) {
		double value = by_step ? v[0] + (double)i * v[2]
		    : i == 0 ? v[0] : i == out->n - 1 ? v[1]
		    : v[0] * pow(v[1] / v[0], (double)i / (double)(out->n - 1));
		out->v[i] = scale10(value, common - exponent);
	}
	return NULL;
}

const char *unit_lengths(const char *text, int exponent, int by_step, struct reals *out)
{
	return list(text, length_parts, exponent, by_step, out);
}

const char *unit_reals(const char *text, int by_step, struct reals *out)
{
	return list(text, plain_parts, 0, by_step, out);
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

/* Refractive indices: what is parsed, what is refused, and the tables against published values and formulas. */
#include "optics/index/ior.h"
#include "support/tap.h"

#include <math.h>
#include <string.h>

static void parsed(const char *text, double re, double im)
{
	struct ior ior;
	const char *bad = ior_parse(text, &ior);
	ok(!bad && !ior.material && creal(ior.value) == re && cimag(ior.value) == im, "'%s' is %g + %gi", text, re, im);
}

static void refused(const char *text, const char *message)
{
	struct ior ior;
	const char *bad = ior_parse(text, &ior);
	ok(bad && strstr(bad, message), "'%s' is refused: %s", text, bad ? bad : "(accepted)");
}

/* Published values: n within the tolerance (0: the very row), k within 1e-3; im < 0: k is not compared. */
static void published(const char *name, double wavelength, double re, double tolerance, double im)
{
	struct ior ior;
	double complex m = NAN;
	const char *bad = ior_parse(name, &ior);
	if (!bad)
		bad = ior_at(&ior, wavelength, &m);
	ok(!bad && fabs(creal(m) - re) <= tolerance && (im < 0 || fabs(cimag(m) - im) <= 1e-3 * im),
	   "%s at %g um: %.6f + %.3gi, published %.8g + %.3gi", name, wavelength, creal(m), cimag(m), re, im);
}

static double sellmeier(double constant, int n, const double (*ab)[2], double l)
{
	double s = constant;
	for (int i = 0; i < n; i++)
		s += ab[i][0] * l * l / (l * l - ab[i][1] * ab[i][1]);
	return sqrt(s);
}

static double silica(double l)
{
	static const double ab[][2] = { { 0.6961663, 0.0684043 }, { 0.4079426, 0.1162414 }, { 0.8974794, 9.896161 } };
	return sellmeier(1, 3, ab, l);
}

static double nacl(double l)
{
	static const double ab[][2] = { { 0.198, 0.05 }, { 0.48398, 0.1 }, { 0.38696, 0.128 }, { 0.25998, 0.158 },
		{ 0.08796, 40.5 }, { 3.17064, 60.98 }, { 0.30038, 120.34 } };
	return sellmeier(1.00055, 7, ab, l);
}

static double air(double l)
{
	return 1 + 0.05792105 / (238.0185 - 1 / (l * l)) + 0.00167917 / (57.362 - 1 / (l * l));
}

static double soda_lime(double l)
{
	return 1.5130 - 0.003169 * l * l + 0.003962 / (l * l);
}

static double soot(double l)
{
	double x = log(l);
	return 1.811 + x * (0.1263 + x * (0.027 + x * 0.0417));
}

/* A table made from a formula: the largest deviation between its rows. */
static void formula(const char *name, double lo, double hi, double (*f)(double), double tolerance)
{
	struct ior ior;
	double complex m;
	double worst = 0;
	const char *bad = ior_parse(name, &ior);
	for (int i = 0; !bad && i <= 100000; i++) {
		double l = lo * pow(hi / lo, i / 100000.0);
		l = fmin(l, hi);
		bad = ior_at(&ior, l, &m);
		if (!bad)
			worst = fmax(worst, fabs(creal(m) - f(l)));
	}
	ok(!bad && worst <= tolerance, "%s follows its formula from %g to %g um: off by %.1e at most (%.0e)", name, lo, hi, worst, tolerance);
}

int main(void)
{
	parsed("1.33", 1.33, 0);
	parsed("1.5+0.1i", 1.5, 0.1);
	parsed("1.5+0.1j", 1.5, 0.1);
	parsed("1.5+1e-10i", 1.5, 1e-10);
	parsed("1.5e0+0i", 1.5, 0);
	parsed("+.75", .75, 0);
	refused("1.5-0.1i", "positive one absorbs");
	refused("1.5-0i", "positive one absorbs");
	refused("0.1i", "no real part");
	refused("0", "not greater than 0");
	refused("-1.33", "not greater than 0");
	refused("1e-400", "not greater than 0");
	refused("1e400", "too large");
	refused("1.5+1e400i", "too large");
	refused("1.5+0.1", "not a refractive index");
	refused("1.5+0.1k", "not a refractive index");
	refused("1.5+0.1ij", "not a refractive index");
	refused("1.5-0.1j", "positive one absorbs");
	refused("0.1j", "no real part");
	refused("1.5+i", "not a refractive index");
	refused("1.5 +0.1i", "not a refractive index");
	refused("1.5+0.1i ", "not a refractive index");
	refused("1.5+0x1i", "not a refractive index");
	refused("1.33um", "not a refractive index");
	refused("0x1p0", "neither a number");
	refused("", "neither a number");
	refused(" 1.5", "neither a number");
	refused("nan", "neither a number");
	refused("inf", "neither a number");
	refused("1.5+nani", "not a refractive index");
	refused("unobtainium", "air, ice, nacl, silica, soda-lime, soot, water");
	refused("wate", "air, ice");

	struct ior ior;
	double complex m;
	ok(!ior_parse("NaCl", &ior) && ior.material && !strcmp(ior.material->name, "nacl"), "NaCl is nacl");
	ok(!ior_parse("1.5+0.1i", &ior) && !ior_at(&ior, NAN, &m) && creal(m) == 1.5 && cimag(m) == 0.1, "a number has no range");
	ior_parse("water", &ior);
	const char *bad = ior_at(&ior, 0.19, &m);
	ok(bad && strstr(bad, "water, 0.2um to 200um"), "below the data: %s", bad ? bad : "");
	ok(ior_at(&ior, 200.001, &m) && ior_at(&ior, NAN, &m) && ior_at(&ior, -1, &m), "above the data, NaN and negative are refused");
	ok(!ior_at(&ior, 0.2, &m) && creal(m) == 1.396 && cimag(m) == 1.1e-7, "the first row is reached");
	ok(!ior_at(&ior, 200, &m) && creal(m) == 2.13 && cimag(m) == 0.504, "the last row is reached");
	ok(!ior_at(&ior, 0.5, &m) && creal(m) == 1.335 && cimag(m) == 1e-9, "a row comes out as tabulated");
	ok(!ior_at(&ior, 0.5875, &m) && fabs(creal(m) - 1.3325) < 1e-15 && fabs(cimag(m) / sqrt(3.6e-9 * 1.09e-8) - 1) < 1e-14,
	   "between rows: n linear, k logarithmic");

	published("water", 0.589, 1.33250, 5e-4, -1);         /* IAPWS; Hale and Querry give three decimals */
	published("water", 3, 1.371, 0, 0.272);               /* Hale and Querry's own rows */
	published("water", 10, 1.218, 0, 0.0508);
	published("ice", 0.59, 1.3097, 0, 4.93e-9);           /* Warren and Brandt's */
	published("air", 0.5893, 1.0002772, 1e-7, 0);         /* Edlen 1966: 1 + 27.7e-5 */
	published("silica", 0.5875618, 1.45846, 5e-6, 0);     /* Malitson: n_d */
	published("nacl", 0.589, 1.5442, 2e-4, 0);            /* handbooks */
	published("soda-lime", 0.589, 1.523, 5e-4, -1);       /* window glass, n_D */
	published("soot", 0.55, 1.7362, 1e-4, 0.594);

	formula("silica", 0.21, 6.7, silica, 1e-6);
	formula("nacl", 0.2, 30, nacl, 1e-6);
	formula("air", 0.23, 1.69, air, 1e-9);
	formula("soda-lime", 0.31, 4.6, soda_lime, 1e-6);
	formula("soot", 0.4, 30, soot, 2e-4);

	for (size_t i = 0; i < n_materials; i++) {
		const struct material *t = &materials[i];
		int good = t->wavelength[0] <= 0.4 && t->wavelength[t->n - 1] >= 0.78 && *t->source;
		for (size_t j = 0; j < t->n; j++)
			good &= isfinite(t->re[j]) && t->re[j] > 0 && isfinite(t->im[j]) && t->im[j] >= 0 && (!j || t->wavelength[j] > t->wavelength[j - 1]);
		ok(good, "%s: ascending, positive, covers 400 to 780 nm, %zu rows", t->name, t->n);
	}
	ok(n_materials == 7, "seven materials");
	return done_testing();
}

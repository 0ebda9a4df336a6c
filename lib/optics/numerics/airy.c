#include "optics/numerics/airy.h"

#include <math.h>

#define AI0 0.355028053887817239     /* Ai(0) = Bi(0)/sqrt 3 */
#define AIP0 0.258819403792806798    /* -Ai'(0) = Bi'(0)/sqrt 3 */
#define INNER 6.2                    /* series within, asymptotics beyond */
#define TERMS 11

/* u_k, v_k of the asymptotic series in 1/xi, xi = (2/3) z^(3/2). */
static const double u[TERMS] = { 1, 0.06944444444444445, 0.03713348765432099, 0.03799305912780064, 0.05764919041266972,
	0.11609906402551541, 0.2915913992307505, 0.8776669695100169, 3.079453030173167, 12.341573332345238, 55.62278536591708 };
static const double v[TERMS] = { 1, -0.09722222222222222, -0.04388503086419753, -0.04246283078989483, -0.0626621634920323,
	-0.12410589602727509, -0.3082537649010791, -0.9204799924129445, -3.210493584648621, -12.807293080735626,
	-57.50830351391427 };

/* f, g and their derivatives: Ai = AI0 f - AIP0 g, Bi = sqrt 3 (AI0 f + AIP0 g). For real z apart, where it takes a quarter of the time. */
#define SERIES(name, number, size) \
static void name(number z, number out[4]) \
{ \
	number z3 = z * z * z, f = 1, g = z, fp = z * z / 2, gp = 1, tf = 1, tg = z, tfp = fp, tgp = 1; \
	double most = size(z3); \
	for (int k = 3; k < 150; k += 3) { \
		f += tf *= z3 / ((k - 1.0) * k); \
		g += tg *= z3 / (k * (k + 1.0)); \
		fp += tfp *= z3 / (k * (k + 2.0)); \
		gp += tgp *= z3 / ((k - 2.0) * k); \
		if (k * (double)k > most && size(tf) + size(tg) + size(tfp) + size(tgp) < 1e-16 * (size(f) + size(g) + size(gp))) \
			break; \
	} \
	out[0] = f; \
	out[1] = g; \
	out[2] = fp; \
	out[3] = gp; \
}
SERIES(series, double complex, cabs)
SERIES(series_real, double, fabs)

struct airy airy_real(double z)
{
	struct airy a;
	if (fabs(z) <= INNER) {
		double s[4];
		series_real(z, s);
		a.ai = AI0 * s[0] - AIP0 * s[1];
		a.aip = AI0 * s[2] - AIP0 * s[3];
		a.bi = sqrt(3) * (AI0 * s[0] + AIP0 * s[1]);
		a.bip = sqrt(3) * (AI0 * s[2] + AIP0 * s[3]);
		return a;
	}
	double root = sqrt(fabs(z)), xi = 2.0 / 3 * fabs(z) * root, quarter = sqrt(root), w = 1 / xi, power = 1;
	double even_u = 0, odd_u = 0, even_v = 0, odd_v = 0;
	for (int k = 0; k < TERMS; k++, power *= w) {
		double sign = z < 0 && k % 4 >= 2 ? -1 : 1;
		if (k % 2) {
			odd_u += sign * u[k] * power;
			odd_v += sign * v[k] * power;
		} else {
			even_u += sign * u[k] * power;
			even_v += sign * v[k] * power;
		}
	}
	double scale = 1 / sqrt(M_PI);
	if (z > 0) {
		double small = exp(-xi), large = exp(xi);
		a.ai = scale / 2 / quarter * small * (even_u - odd_u);
		a.aip = -scale / 2 * quarter * small * (even_v - odd_v);
		a.bi = scale / quarter * large * (even_u + odd_u);
		a.bip = scale * quarter * large * (even_v + odd_v);
		return a;
	}
	double s, c;
	sincos(xi + M_PI / 4, &s, &c);
	a.ai = scale / quarter * (s * even_u - c * odd_u);
	a.aip = -scale * quarter * (c * even_v + s * odd_v);
	a.bi = scale / quarter * (c * even_u + s * odd_u);
	a.bip = scale * quarter * (s * even_v - c * odd_v);
	return a;
}

/* Ai and Ai' less e^(-xi), where that alone is left. */
static void falling(double complex z, double complex *ai, double complex *aip)
{
	double complex root = csqrt(z), w = -1.5 / (z * root), power = 1, su = 0, sv = 0;
	for (int k = 0; k < TERMS; k++, power *= w) {
		su += u[k] * power;
		sv += v[k] * power;
	}
	*ai = su / csqrt(root);
	*aip = -sv * csqrt(root);
}

double complex airy_ratio(double complex z)
{
	double complex a, ap, b, bp;
	if (cabs(z) <= INNER) {
		double complex s[4];
		series(z, s);
		return (AI0 * s[2] - AIP0 * s[3]) / (AI0 * s[0] - AIP0 * s[1]);
	}
	double complex xi = 2.0 / 3 * z * csqrt(z);
	if (fabs(carg(z)) < 2 * M_PI / 3 || fabs(creal(xi)) > 8) {
		falling(z, &a, &ap);
		return ap / a;
	}
	/* Ai(z) = -(w Ai(w z) + w* Ai(w* z)), w = e^(2 pi i/3): both arguments lie where one exponential is left */
	double complex w = CMPLX(-0.5, sqrt(0.75)), ea = cexp(-2.0 / 3 * w * z * csqrt(w * z));
	double complex eb = cexp(-2.0 / 3 * conj(w) * z * csqrt(conj(w) * z));
	falling(w * z, &a, &ap);
	falling(conj(w) * z, &b, &bp);
	return (w * w * ap * ea + conj(w * w) * bp * eb) / (w * a * ea + conj(w) * b * eb);
}

#include "optics/closed_form/evans_fournier.h"

#include <math.h>

/* van de Hulst's K(w) = 1/2 + e^-w/w + (e^-w - 1)/w^2, Re w >= 0 */
static double complex anomalous(double complex w)
{
	if (norm2(w) < 1e-4)
		return w * (1.0 / 3 - w * (1.0 / 8 - w / 30));
	double kept = exp(-creal(w));
	double complex e = CMPLX(kept * cos(cimag(w)), -kept * sin(cimag(w))), over = conj(w) / norm2(w);
	return 0.5 + over * (e + (e - 1) * over);
}

#define POLE 1e-3              /* least modulus of what is divided by: the model's poles are no sphere's */

/* z, or a number of its phase that is no nearer to 0 than POLE. */
static double complex from_pole(double complex z)
{
	double r2 = norm2(z);
	return r2 >= POLE * POLE ? z : r2 > 0 ? z * (POLE / sqrt(r2)) : POLE;
}

/* The fit's departure, ~ x^(-2/3) as the edge; g; absorption. */
double evans_fournier_error(double x, double complex m)
{
	double n = creal(m), k = cimag(m), d = fabs(n - 1), edge = n < 1 ? 4 : 1.5 * (fmin(1, 0.1 + 5 * d) + fmax(0, 1.5 * (n - 1.6)));
	if (n < 0.3 || n > 5 || k > 1)     /* far from what it was made for */
		return 1;
	if (x < 10)
		return fmin(1, (n < 1 ? 3 : 1.5) * x);
	if (k > 0 && x * hypot(d, k) < 0.3)    /* what little is scattered, between its limits */
		return 1;
	return fmin(1, edge * pow(x, -2.0 / 3) + 0.015 + (n < 1 ? 0.05 : 0.02) * d +
			       (k == 0 ? 0 : 2 / x + (n < 1 ? 0.3 : k > d ? 0.16 : 0.06)));
}

struct efficiencies evans_fournier_efficiencies(double x, double complex m)
{
	double n = creal(m), k = cimag(m), d = fabs(n - 1), n2 = n * n, k2 = k * k;
	double size2 = (n2 + k2) * (n2 + k2), diff = n2 - k2, root = sqrt(k);
	double x2 = x * x, contrast = norm2(m - 1) * norm2(m + 1);     /* |m^2 - 1|^2; |m^2 + 2|^2, |2 m^2 + 3|^2: */
	double w = fmax(size2 + 4 * diff + 4, POLE * POLE), second = fmax(4 * size2 + 12 * diff + 9, POLE * POLE);
	double dipole = 8.0 / 3 * x2 * x2 * contrast / w;
	double absorbed = 24 * n * k / w * x;
	double more = 4.0 / 15 + 20 / (3 * second) + 4.8 * (7 * size2 + 4 * (diff - 5)) / (w * w);
	double small = absorbed + n * k * more * x * x2 +
		       dipole * ((size2 + diff - 2) * (size2 + diff - 2) - 36 * n2 * k2) / (contrast * w);
	if (!(small > dipole))
		small = dipole + absorbed;
	double large = (2 - exp(-pow(x, -2.0 / 3))) * 4 * creal(anomalous(2 * x * CMPLX(k, -(n - 1))));
	double a = 0.5 + d - 2.0 / 3 * root - k / 2 + (d + 2.0 / 3 * (root - 5 * k)) * (d + 2.0 / 3 * (root - 5 * k));
	double b = 0.6 - 0.75 * sqrt(d) + 3 * d * d * d * d + (k > 0 ? 25 / (6 + 5 * d / k) : 0);
	double mu = fmax(a + b / x, 0.1), ratio = small / large;
	struct efficiencies q;
	q.ext = ratio < 1 ? small * pow(1 + pow(ratio, mu), -1 / mu) : large * pow(1 + pow(ratio, -mu), -1 / mu);
	double complex face = (m - 1) / (m + 1);
	/* absorption of a large sphere: anomalous diffraction with the chords of refracted rays, less what is reflected at once */
	double enters = 1 - 0.45 * sqrt(norm2(face)), longer = n > 1 ? n2 * (1 - pow(1 - 1 / n2, 1.5)) : n2;
	double lost = k == 0 ? 0 : fmin(2 * enters * creal(anomalous(4 * x * k * longer / enters)) / q.ext, 1);
	double turn = x2 * x2, albedo = k == 0 ? 1 : (dipole / (dipole + absorbed) + turn * (1 - lost)) / (1 + turn);
	q.sca = albedo * q.ext;
	q.abs = q.ext - q.sca;
	double rise = 0.16 * x2, most = 1 / (1 + (n > 1 ? 0.4 * (n - 1) : 0.5 * (1 / n - 1)) * fmax(1 - 1.3 * lost, 0));
	q.g = most * rise * (1 + 2 * rise) / (1 + rise * (1 + 2 * rise));
	double complex far = (1 - face * face) / from_pole(1 - 2 / m + 1e-3) * cexp(4 * I * x * m);
	q.back = norm2(face) * norm2(1 - far);
	return q;
}

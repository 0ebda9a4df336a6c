/* Lorenz-Mie theory as textbooks have it, in double precision, one sphere after the other: complex division for each term (Bohren and
 * Huffman 1983, appendix A), Wiscombe's number of terms. What `make bench-mie` compares with.
 * usage: textbook RE IM FROM TO COUNT            efficiencies and g of COUNT log-spaced size parameters: seconds, terms, sum of Q_ext
 *        textbook RE IM FROM TO COUNT ANGLES     S1 and S2 at equally spaced angles: seconds, terms x angles, sum of |S1|^2 */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double seconds(void)
{
	struct timespec t;
	clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int coefficients(double x, double complex m, double complex *a, double complex *b, double complex *d)
{
	double complex y = m * x;
	int n = (int)(x + 4.05 * cbrt(x) + 2), top = (int)fmax(n, cabs(y)) + 16;
	d[top] = 0;
	for (int l = top; l > 0; l--)
		d[l - 1] = l / y - 1 / (d[l] + l / y);
	double psi0 = cos(x), psi1 = sin(x), chi0 = -sin(x), chi1 = cos(x);
	double complex xi1 = psi1 - I * chi1;
	for (int l = 1; l <= n; l++) {
		double psi = (2 * l - 1) / x * psi1 - psi0, chi = (2 * l - 1) / x * chi1 - chi0;
		double complex xi = psi - I * chi, f = d[l] / m + l / x, g = m * d[l] + l / x;
		a[l] = (f * psi - psi1) / (f * xi - xi1);
		b[l] = (g * psi - psi1) / (g * xi - xi1);
		psi0 = psi1;
		psi1 = psi;
		chi0 = chi1;
		chi1 = chi;
		xi1 = xi;
	}
	return n;
}

static double efficiency(double x, int n, const double complex *a, const double complex *b, double *g)
{
	double ext = 0, sca = 0, asym = 0;
	double complex back = 0;
	for (int l = 1; l <= n; l++) {
		ext += (2 * l + 1) * creal(a[l] + b[l]);
		sca += (2 * l + 1) * (creal(a[l] * conj(a[l])) + creal(b[l] * conj(b[l])));
		asym += (2 * l + 1) / (l * (l + 1.0)) * creal(a[l] * conj(b[l]));
		if (l < n)
			asym += l * (l + 2) / (l + 1.0) * creal(a[l] * conj(a[l + 1]) + b[l] * conj(b[l + 1]));
		back += (l % 2 ? -1 : 1) * (2 * l + 1) * (a[l] - b[l]);
	}
	*g = 2 * asym / sca + creal(back * conj(back)) / (x * x);
	return 2 / (x * x) * ext;
}

static void amplitudes(double mu, int n, const double complex *a, const double complex *b, double complex *s1, double complex *s2)
{
	double pi0 = 0, pi1 = 1;
	*s1 = *s2 = 0;
	for (int l = 1; l <= n; l++) {
		double tau = l * mu * pi1 - (l + 1) * pi0, w = (2 * l + 1) / (l * (l + 1.0)), next = ((2 * l + 1) * mu * pi1 - (l + 1) * pi0) / l;
		*s1 += w * (a[l] * pi1 + b[l] * tau);
		*s2 += w * (a[l] * tau + b[l] * pi1);
		pi0 = pi1;
		pi1 = next;
	}
}

int main(int argc, char **argv)
{
	if (argc < 6) {
		fputs("usage: textbook RE IM FROM TO COUNT [ANGLES]\n", stderr);
		return 2;
	}
	double complex m = atof(argv[1]) + I * atof(argv[2]);
	double from = atof(argv[3]), to = atof(argv[4]), terms = 0, sum = 0, all = 0;
	int count = atoi(argv[5]), angles = argc > 6 ? atoi(argv[6]) : 0;
	size_t room = (size_t)((1 + cabs(m)) * to + 4.05 * cbrt(to) + 100);
	double complex *a = malloc(3 * room * sizeof *a), *b = a + room, *d = b + room;
	if (!a)
		return 2;
	double begin = seconds();
	for (int i = 0; i < count; i++) {
		double x = from * pow(to / from, count > 1 ? i / (count - 1.0) : 0), g;
		int n = coefficients(x, m, a, b, d);
		if (angles) {
			begin = i ? begin : seconds();
			double start = seconds();
			for (int j = 0; j < angles; j++) {
				double complex s1, s2;
				amplitudes(cos(M_PI * j / (angles - 1)), n, a, b, &s1, &s2);
				sum += creal(s1 * conj(s1));
			}
			all += seconds() - start;
			terms += (double)n * angles;
		} else {
			sum += efficiency(x, n, a, b, &g);
			sum += 0 * g;
			terms += n;
		}
	}
	if (!angles)
		all = seconds() - begin;
	printf("%.6g %.0f %.12g\n", all, terms, sum);
	free(a);
	return 0;
}

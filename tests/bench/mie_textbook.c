/* The yardstick of speed: Lorenz-Mie theory as textbooks have it (Bohren and Huffman 1983, appendix A), a size after the other in complex
 * doubles, for -O3 -march=native. Prints nanoseconds a term (and angle).
 * usage: mie_textbook M_RE M_IM X0 X1 COUNT [ANGLES]     sizes log-spaced, with amplitudes at equal angles
 *        mie_textbook M_RE M_IM X                        qext qsca g qback */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double complex *d, *a, *b;
static double q[4], sink;

static int solve(double x, double complex m)
{
	double complex y = m * x;
	int n = (int)(x + 4.05 * cbrt(x) + 8), start = (int)fmax(n, cabs(y)) + 16 + (int)(8 * cbrt(cabs(y)));
	d = realloc(d, ((size_t)start + 2) * sizeof *d);
	a = realloc(a, ((size_t)n + 2) * sizeof *a);
	b = realloc(b, ((size_t)n + 2) * sizeof *b);
	d[start] = 0;
	for (int l = start; l > 0; l--)
		d[l - 1] = l / y - 1 / (d[l] + l / y);
	double psi0 = cos(x), psi1 = sin(x), chi0 = -sin(x), chi1 = cos(x), ext = 0, sca = 0, g = 0;
	double complex back = 0;
	for (int l = 1; l <= n; l++) {
		double psi = (2 * l - 1) * psi1 / x - psi0, chi = (2 * l - 1) * chi1 / x - chi0;
		double complex xi = CMPLX(psi, -chi), xi1 = CMPLX(psi1, -chi1);
		double complex f = d[l] / m + l / x, h = m * d[l] + l / x;
		a[l] = (f * psi - psi1) / (f * xi - xi1);
		b[l] = (h * psi - psi1) / (h * xi - xi1);
		ext += (2 * l + 1) * creal(a[l] + b[l]);
		sca += (2 * l + 1) * (creal(a[l] * conj(a[l])) + creal(b[l] * conj(b[l])));
		g += (2 * l + 1) / (l * (l + 1.0)) * creal(a[l] * conj(b[l]));
		if (l > 1)
			g += (l - 1) * (l + 1.0) / l * creal(a[l - 1] * conj(a[l]) + b[l - 1] * conj(b[l]));
		back += (l % 2 ? -1.0 : 1.0) * (2 * l + 1) * (a[l] - b[l]);
		psi0 = psi1, psi1 = psi, chi0 = chi1, chi1 = chi;
	}
	q[0] = 2 / (x * x) * ext;
	q[1] = 2 / (x * x) * sca;
	q[2] = 2 * g / sca;
	q[3] = creal(back * conj(back)) / (x * x);
	return n;
}

static void amplitudes(int n, int angles)
{
	for (int i = 0; i < angles; i++) {
		double mu = cos(M_PI * i / (angles - 1)), pi0 = 0, pi1 = 1;
		double complex s1 = 0, s2 = 0;
		for (int l = 1; l <= n; l++) {
			double tau = l * mu * pi1 - (l + 1) * pi0, w = (2 * l + 1) / (l * (l + 1.0)), next = ((2 * l + 1) * mu * pi1 - (l + 1) * pi0) / l;
			s1 += w * (a[l] * pi1 + b[l] * tau);
			s2 += w * (a[l] * tau + b[l] * pi1);
			pi0 = pi1, pi1 = next;
		}
		sink += creal(s1) + cimag(s2);
	}
}

int main(int argc, char **argv)
{
	if (argc != 4 && argc != 6 && argc != 7)
		return 2;
	double complex m = CMPLX(atof(argv[1]), atof(argv[2]));
	double x0 = atof(argv[3]), terms = 0;
	if (argc == 4) {
		solve(x0, m);
		return printf("%.17g %.17g %.17g %.17g\n", q[0], q[1], q[2], q[3]) < 0;
	}
	double x1 = atof(argv[4]);
	int count = atoi(argv[5]), angles = argc == 7 ? atoi(argv[6]) : 0;
	clock_t begin = clock();
	for (int i = 0; i < count; i++) {
		int n = solve(count > 1 ? x0 * pow(x1 / x0, i / (count - 1.0)) : x0, m);
		terms += n;
		sink += q[0] + q[2] + q[3];
		if (angles)
			amplitudes(n, angles);
	}
	double ns = (double)(clock() - begin) / CLOCKS_PER_SEC * 1e9;
	fprintf(stderr, "%g\n", sink);      /* so that nothing is left out */
	return printf("%.4g\n", ns / terms / (angles ? angles : 1)) < 0;
}

/* How long one sphere takes by itself: the efficiencies of a single size, again and again. Prints nanoseconds a term, terms counted as in
 * mie_textbook.c.
 * usage: mie_alone M_RE M_IM X COUNT */
#include "optics/mie/mie.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

int main(int argc, char **argv)
{
	if (argc != 5)
		return 2;
	double complex m = CMPLX(atof(argv[1]), atof(argv[2]));
	double x = atof(argv[3]), error, sink = 0;
	int count = atoi(argv[4]), terms = (int)(x + 4.05 * cbrt(x) + 8);
	struct efficiencies q;
	clock_t begin = clock();
	for (int i = 0; i < count; i++) {
		if (mie_many(1, &x, &m, &q, &error))
			return 1;
		sink += q.ext + q.g;
	}
	double ns = (double)(clock() - begin) / CLOCKS_PER_SEC * 1e9;
	fprintf(stderr, "%g\n", sink);      /* so that nothing is left out */
	return printf("%.4g\n", ns / terms / count) < 0;
}

#include "optics/goa/impact_quadrature.h"

#include "optics/goa/debye_order.h"
#include "optics/goa/goa_rays.h"

#include <math.h>

int impact_quadrature(double complex m, int panels, struct impact *out)
{
	double n = creal(m), edge = n < 1 ? asin(n) : M_PI_2;
	int k = 0;
	for (int panel = 0; panel < (n < 1 ? 2 : 1) * panels; panel++) {
		int enters = panel < panels;
		double width = (enters ? edge : M_PI_2 - edge) / panels;
		double lo = enters ? width * panel : edge + width * (panel - panels);
		for (int j = 0; j < GAUSS; j++) {
			double i = lo + width * (1 + gauss_node[j]) / 2, u = sin(i);
			double complex r1, r2;
			goa_rays_fresnel(m, u, cos(i), &r1, &r2);
			out[k++] = (struct impact){ .weight = gauss_weight[j] * width * u * cos(i), .incidence = i, .enters = enters,
				.reflected = { norm2(r1), norm2(r2) }, .chord = enters ? cimag(debye_order_chord(m, u)) : INFINITY };
		}
	}
	return k;
}

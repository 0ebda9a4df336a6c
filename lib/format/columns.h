/* columns - the one list of the columns by which programs understand each other's tables: name, type as it is written (any is
 * read), unit. A new column is one line here, its name in COLUMNS at the end, and a line in the manual page of the tool that writes it. */
#ifndef FORMAT_COLUMNS_H
#define FORMAT_COLUMNS_H

#include "format/tab.h"

static const struct tab_col
	/* keys of optics: a radius and a wavelength, or x, which stands for both */
	column_wavelength = { "wavelength", TAB_F64, "um" },    /* in vacuum */
	column_radius = { "radius", TAB_F64, "um" },
	column_size_parameter = { "x", TAB_F64, "1" },

	/* size distributions: classes and their limits */
	column_weight = { "weight", TAB_F64, "1" },
	column_radius_lo = { "radius_lo", TAB_F64, "um" },
	column_radius_hi = { "radius_hi", TAB_F64, "um" },

	/* particles */
	column_position[3] = { { "x", TAB_F32, "m" }, { "y", TAB_F32, "m" }, { "z", TAB_F32, "m" } },
	column_class = { "class", TAB_I32, "1" },

	/* coefficients of partial waves, one n a row, in a host of some index */
	column_coeffs[7] = {
		{ "host_re", TAB_F64, "1" }, { "host_im", TAB_F64, "1" }, { "n", TAB_I32, "1" },
		{ "a_re", TAB_F64, "1" }, { "a_im", TAB_F64, "1" }, { "b_re", TAB_F64, "1" }, { "b_im", TAB_F64, "1" },
	},

	/* cross sections, and efficiencies where there is no radius */
	column_c_ext = { "c_ext", TAB_F64, "um^2" },
	column_c_sca = { "c_sca", TAB_F64, "um^2" },
	column_c_abs = { "c_abs", TAB_F64, "um^2" },
	column_q_ext = { "q_ext", TAB_F64, "1" },
	column_q_sca = { "q_sca", TAB_F64, "1" },
	column_q_abs = { "q_abs", TAB_F64, "1" },
	column_q_back = { "q_back", TAB_F64, "1" },
	column_c_back = { "c_back", TAB_F64, "um^2/sr" },
	column_radius_eff = { "radius_eff", TAB_F64, "um" },
	column_volume = { "volume", TAB_F64, "um^3" },
	column_g = { "g", TAB_F64, "1" },
	column_method = { "method", TAB_I32, "1" },
	column_error = { "error", TAB_F64, "1" },

	/* scattering by angle */
	column_theta = { "theta", TAB_F64, "deg" },
	column_s1_re = { "s1_re", TAB_F64, "1" },
	column_s1_im = { "s1_im", TAB_F64, "1" },
	column_s2_re = { "s2_re", TAB_F64, "1" },
	column_s2_im = { "s2_im", TAB_F64, "1" },
	column_p = { "p", TAB_F64, "sr^-1" };

/* All of them, for a reader of names without units. */
#define COLUMNS \
	&column_wavelength, &column_radius, &column_size_parameter, &column_weight, &column_radius_lo, &column_radius_hi, \
	&column_position[0], &column_position[1], &column_position[2], &column_class, &column_coeffs[0], &column_coeffs[1], \
	&column_coeffs[2], &column_coeffs[3], &column_coeffs[4], &column_coeffs[5], &column_coeffs[6], &column_c_ext, \
	&column_c_sca, &column_c_abs, &column_q_ext, &column_q_sca, &column_q_abs, &column_q_back, &column_g, &column_method, \
	&column_error, &column_c_back, &column_radius_eff, &column_volume, &column_theta, &column_s1_re, &column_s1_im, &column_s2_re, &column_s2_im, &column_p

#endif

/* colour - from radiance at a few wavelengths to linear sRGB. */
#ifndef RENDER_COLOUR_H
#define RENDER_COLOUR_H

/* colour_weights - rgb[n][3], linear RGB of radiance 1 at each wavelength alone; radiance 1 at all gives exactly (1, 1, 1).
 * One wavelength is grey; two: the longer R, the shorter B, their mean G; three: R (longest), G, B; four or more: CIE 1931
 * colour matching functions (the fits of Wyman, Sloan and Shirley 2013), trapezoid weights over the wavelength, each of X, Y, Z
 * scaled so that radiance 1 has the colour of D65, then linear sRGB (IEC 61966-2-1), negative values kept.
 * Given:    wavelength[n]  um, ascending
 * Returns NULL, or what is wrong (no wavelength in the visible). */
const char *colour_weights(int n, const double *wavelength, float (*rgb)[3]);

#endif

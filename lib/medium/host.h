/* host - what is between the particles of a medium, which may absorb light: water, ice. */
#ifndef MEDIUM_HOST_H
#define MEDIUM_HOST_H

#include "medium/medium.h"

/* host_absorption - set the medium's absorption by a host, an index or a material as in --host (or NULL: none), at its wavelengths:
 * 4 pi Im(n) / wavelength (Bohren and Huffman 1983, eq 2.52). Dies, with option as the culprit, where it is no index, or its data do not
 * reach a wavelength. */
void host_absorption(const char *option, const char *index, struct medium *m);

/* host_medium - the host of a medium as one of its own, which does not scatter, of the same shape in the same place. Its arrays are its
 * own: medium_free. */
struct medium host_medium(const struct medium *m);

#endif

/* provenance - whether tables that are baked together belong together, by the commands in their histories. Of commands that mean
 * the same some are told apart (5um and 5000nm): what differs here is likely to be a mistake, not sure to be one. */
#ifndef MEDIUM_PROVENANCE_H
#define MEDIUM_PROVENANCE_H

/* What commands say of a table. */
enum provenance {
	PROVENANCE_SIZES,     /* psd: the size distribution, whatever its classes */
	PROVENANCE_OPTICS     /* xsect, mie-coeffs, mie-phase, goa-phase: --particle and --host */
};

/* provenance_known - whether a history has such a command. */
int provenance_known(enum provenance what, const char *history);

/* provenance_stranger - what the first such command of a history says that none of another history's does, from malloc; the order
 * of options does not count. NULL where there is no such, or the other history has no such commands at all. */
char *provenance_stranger(enum provenance what, const char *history, const char *other);

/* provenance_host - what --host was of the last command of a history that has optics, from malloc; NULL where it was not given. */
char *provenance_host(const char *history);

#endif

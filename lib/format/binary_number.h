/* binary_number - numbers of binary files of other programs, and the column of a table that holds all values of a kind. */
#ifndef FORMAT_BINARY_NUMBER_H
#define FORMAT_BINARY_NUMBER_H

#include "format/tab.h"

struct binary_number {
	char kind;               /* i, u or f: two's complement, unsigned, IEEE 754 */
	int bytes;               /* 1, 2, 4 or 8; of f 4 or 8 */
};

/* binary_number_column - i32 or f32 where that holds them all, else f64. */
enum tab_type binary_number_column(struct binary_number n);

/* binary_number_value - what stands at p, its lowest byte first, or with big its highest. 0 where an integer is beyond 2^53, which no
 * double need hold. */
int binary_number_value(struct binary_number n, const unsigned char *p, int big, double *out);

#endif

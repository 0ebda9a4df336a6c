#include "format/binary_number.h"

#include <string.h>

enum tab_type binary_number_column(struct binary_number n)
{
	if (n.kind == 'f')
		return n.bytes == 4 ? TAB_F32 : TAB_F64;
	return n.bytes < 4 || (n.bytes == 4 && n.kind == 'i') ? TAB_I32 : TAB_F64;
}

int binary_number_value(struct binary_number n, const unsigned char *p, int big, double *out)
{
	uint64_t bits = 0;
	for (int b = 0; b < n.bytes; b++)
		bits = bits << 8 | p[big ? b : n.bytes - 1 - b];
	if (n.kind == 'f') {
		float single;
		memcpy(&single, &(uint32_t){ (uint32_t)bits }, 4);
		memcpy(out, &bits, 8);
		*out = n.bytes == 4 ? (double)single : *out;
		return 1;
	}
	uint64_t sign = n.kind == 'i' ? UINT64_C(1) << (8 * n.bytes - 1) : 0;
	int negative = (bits & sign) != 0;
	/* the magnitude: two's complement, wrapped to the number's width */
	uint64_t size = negative ? (~bits + 1) & (sign | (sign - 1)) : bits;
	*out = negative ? -(double)size : (double)size;
	return size <= UINT64_C(1) << 53;
}

/* The film's integers are exact. */
#include "render/kern/film.h"
#include "support/tap.h"

#define MOST (((int64)1 << 61) - 1)    /* of a sample, less than a quarter of a sum's limit either way */

int main(void)
{
	static const int64 values[] = { 0, 1, -1, 65535, 1LL << 31, (1LL << 32) - 1, -(1LL << 32), 0x123456789abcdef, MOST, -MOST };
	unsigned __int128 want = 0;
	int64 sum[2] = { 0, 0 }, sums[8] = { 0 };
	uint64 bad = 0;
	for (int k = 0; k < 6; k++)
		for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
			bad |= film_add_square(sum, values[i]);
			want += (unsigned __int128)((__int128)values[i] * values[i]);
		}
	ok(!(bad >> 63) && (uint64)sum[0] == (uint64)want && (uint64)sum[1] == (uint64)(want >> 64), "squares are summed to the last bit");
	int64 full[2] = { -1, INT64_MAX };
	ok(film_add_square(full, 1) >> 63, "a sum of squares beyond 2^127 is told");
	l8 told = { 0 }, n = { MOST, -MOST, 1 };
	for (int k = 0; k < 1000; k++) {
		told |= film_add8(sums, n);
		told |= film_add8(sums, -n);
	}
	ok(!FILM_BEYOND(told[0]) && !FILM_BEYOND(told[1]) && sums[0] == 0 && sums[1] == 0 && sums[2] == 0, "what is just in range may come and go");
	for (int k = 0; k < 9; k++)
		told |= film_add8(sums, n);
	ok(FILM_BEYOND(told[0]) && FILM_BEYOND(told[1]) && !FILM_BEYOND(told[2]), "a sum out of range is told, however far");
	return done_testing();
}

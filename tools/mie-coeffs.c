/* mie-coeffs - partial-wave coefficients of spheres by Lorenz-Mie theory. */
#include "base/die.h"
#include "toolkit/coeffs.h"
#include "toolkit/spheres.h"

#include <string.h>

static void put(struct tab_out *out, struct spheres *in, const struct waves *w)
{
	double row[TAB_COLS];
	int k = spheres_key(in, &w->size, row);
	spheres_carry(in, w, row + k + COEFFS_COLS);
	for (int l = 1; l <= w->n; l++) {
		coeffs_values(w, l, row + k);
		tab_put(out, row);
	}
}

static void run(struct spheres *in, const char *output, const char *command)
{
	static struct waves w[SPHERES_BATCH];
	struct tab_col cols[TAB_COLS];
	int k = spheres_key_columns(in, cols);
	memcpy(cols + k, column_coeffs, sizeof column_coeffs);
	k += COEFFS_COLS;
	int ncarried = spheres_carried(in, k, cols, cols + k), n = spheres_batch(in, w), failed = 0;
	struct tab_out *out = tab_create(output, spheres_history(in), command, spheres_law(in), k + ncarried, cols);
	for (; n; n = spheres_batch(in, w)) {
#pragma omp parallel for schedule(dynamic) reduction(|:failed) if (n > 1)
		for (int i = 0; i < n; i++)
			failed |= waves_solve(&w[i]) != 0;
		if (failed)
			die(NULL, "out of memory");
		for (int i = 0; i < n; i++) {
			put(out, in, &w[i]);
			waves_free(&w[i]);
		}
	}
	tab_finish(out);
}

int main(int argc, char **argv)
{
	static struct sizes_options sizes = SIZES_INIT;    /* static: the lists in it live as long as the process */
	const char *output = NULL;
	const struct opt opts[] = {
		SIZES_OPTIONS(sizes),
		OPT_OUTPUT(&output),
		OPT_END
	};
	const struct opt_tool tool = { "[OPTION].. [SIZES]", "Partial-wave coefficients of spheres by Lorenz-Mie theory.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (args.n > 1)
		die(args.operand[1], "one table at most");
	struct spheres *in = spheres_open_sizes(&sizes, args.n ? args.operand[0] : NULL);
	run(in, output, args.history);
	spheres_close(in);
	return 0;
}

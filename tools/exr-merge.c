/* exr-merge - the parts of an image, rendered apart, into one. */
#include "base/die.h"
#include "base/opt.h"
#include "base/standard.h"
#include "render/image.h"

#include <stdlib.h>

int main(int argc, char **argv)
{
	const char *output = NULL;
	int whole = 0;
	const struct opt opts[] = {
		{ "-o", OPT_FILE, &output, 0, 0, "OUT.exr", "the image", 1 },
		{ "--whole", OPT_FLAG, &whole, 0, 0, NULL, "no samples are to follow: leave the sums out", 1 },
		OPT_END
	};
	const struct opt_tool tool = { "[--whole] -o OUT.exr IN.exr..", "Add the parts of an image that vrender --sample-range made.", opts, 0 };
	struct opt_line args = opt_parse(&tool, argc, argv);
	if (!output)
		die("-o", "is needed");
	if (!args.n)
		die(NULL, "needs the parts of an image; see exr-merge --help");
	int from_stdin = 0;
	for (int i = 0; i < args.n; i++)
		from_stdin += standard(args.operand[i]);
	if (from_stdin > 1)
		die(NULL, "only one of the images can be standard input");
	struct image all, more;
	image_read(args.operand[0], &all);
	for (int i = 1; i < args.n; i++) {
		image_read(args.operand[i], &more);
		image_merge(&all, &more, standard_input(args.operand[i]));
		image_free(&more);
	}
	if (whole && !image_whole(&all))
		die("--whole", "samples are missing: the parts are not all from 0 on without a gap");
	struct out out = out_open(output, 1);
	image_write(&out, &all, !whole && !image_complete(&all));
	image_free(&all);
	free(args.history);
	return 0;
}

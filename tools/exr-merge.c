/* exr-merge - the parts of an image, rendered apart, into one. */
#include "base/die.h"
#include "base/opt.h"
#include "base/standard.h"
#include "render/image.h"

#include <stdlib.h>

int main(int argc, char **argv)
{
	const char *output = NULL;
	const struct opt opts[] = {
		{ "-o", OPT_FILE, &output, 0, 0, "OUT.exr", "the image", 1 },
		OPT_END
	};
	const struct opt_tool tool = { "-o OUT.exr IN.exr..", "Add the parts of an image that vrender --sample-range made.", opts, 0 };
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
	struct out out = out_open(output, 1);
	image_write(&out, &all, !image_whole(&all));
	image_free(&all);
	free(args.history);
	return 0;
}

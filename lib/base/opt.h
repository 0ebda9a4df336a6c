/* opt - command lines: one table of options gives parsing, ranges, defaults, --help and the history line. */
#ifndef BASE_OPT_H
#define BASE_OPT_H

#include "base/unit.h"

enum opt_type {
	OPT_FLAG,             /* int            no value; set to 1 */
	OPT_INT,              /* long long */
	OPT_REAL,             /* double */
	OPT_TEXT,             /* const char * */
	OPT_FILE,             /* const char *   a file name: left out of the history */
	OPT_CHOICE,           /* int            index into arg, the words separated by '|' */
	OPT_UM,               /* double         a length in um */
	OPT_UMS,              /* struct reals   lengths in um: A,B,.. or log-spaced FROM:TO:COUNT */
	OPT_WAVELENGTHS,      /* struct reals   wavelengths in um, or their frequencies: A,B,.. or FROM:TO:STEP */
	OPT_REALS,            /* struct reals   numbers: A,B,.. or log-spaced FROM:TO:COUNT */
	OPT_REAL_STEPS,       /* struct reals   numbers: A,B,.. or FROM:TO:STEP */
	OPT_M,                /* double         a length in m */
	OPT_BOX,              /* double[3]      lengths in m: X,Y,Z */
	OPT_PER_M3,           /* double         a concentration in m^-3 */
	OPT_BYTES,            /* double         bytes */
};

struct opt {
	const char *name;     /* "--radius", "-o" */
	enum opt_type type;
	void *dst;            /* holds the default beforehand; NaN in a double, or an integer below lo: none */
	double lo, hi;        /* every value lies in [lo, hi]; lo == hi: anywhere */
	const char *arg;      /* how the value is written, for --help */
	const char *help;
	int local;            /* where or how, not what: left out of the history */
};

struct opt_tool {
	const char *synopsis; /* after the program's name: "[OPTION].. [TABLE]" */
	const char *summary;  /* one sentence */
	const struct opt *opts;   /* ends with a NULL name */
	int words;            /* operands are words, not files: they stand in the history */
};

struct opt_line {
	int n;                /* operands */
	char **operand;
	char *history;        /* the command, sh-quoted, less file names and local options */
};

/* opt_parse - parse argv by the table; --help and --version print and exit 0, anything wrong dies. What it returns lives
 * as long as the program; lists (struct reals) are the caller's to free. SIGPIPE gets its default back, and
 * descriptors 0 to 2 are open from here on. */
struct opt_line opt_parse(const struct opt_tool *tool, int argc, char **argv);

/* Shared rows. */
#define OPT_END { NULL, OPT_FLAG, NULL, 0, 0, NULL, NULL, 0 }
#define OPT_OUTPUT(dst) { "-o", OPT_FILE, dst, 0, 0, "FILE", "write to FILE instead of standard output", 1 }

#endif

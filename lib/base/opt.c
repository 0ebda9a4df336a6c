#include "base/opt.h"

#include "base/die.h"
#include "base/out.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Append a word as sh would need it quoted. */
static void quote(char **line, const char *word)
{
	static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
	char *old = *line, *q = xalloc(4 * strlen(word) + 3, 1), *w = q;
	if (*word && !word[strspn(word, plain)]) {
		strcpy(q, word);
	} else {
		*w++ = '\'';
		for (const char *c = word; *c; c++) {
			if (*c == '\'')
				w = stpcpy(w, "'\\''");
			else
				*w++ = (unsigned char)*c < ' ' ? '?' : *c;
		}
		*w = '\'';
	}
	*line = *old ? xtext("%s %s", old, q) : xtext("%s", q);
	free(old);
	free(q);
}

static const char *choice(const char *words, const char *text, int *out)
{
	size_t n = strlen(text);
	int i = 0;
	for (const char *w = words; w; w = strchr(w, '|') ? strchr(w, '|') + 1 : NULL, i++)
		if (n && !strchr(text, '|') && !strncmp(w, text, n) && (w[n] == '|' || !w[n])) {
			*out = i;
			return NULL;
		}
	return "is none of the choices";
}

static const char *box(const char *text, double out[3])
{
	struct reals r;
	const char *bad = strchr(text, ':') ? "is not X,Y,Z" : unit_lengths(text, 0, 1, &r);
	if (bad)
		return bad;
	if (r.n == 3)
		memcpy(out, r.v, sizeof(double[3]));
	else
		bad = "is not three lengths X,Y,Z";
	free(r.v);
	return bad;
}

static const char *parse(const struct opt *o, const char *text, const double **values, size_t *n)
{
	static double one;
	const char *bad = NULL;
	long long whole;
	*values = o->dst;
	*n = 1;
	switch (o->type) {
	case OPT_FLAG:
		*(int *)o->dst = 1;
		*n = 0;
		return NULL;
	case OPT_INT:
		bad = unit_int(text, &whole);
		if (!bad) {
			*(long long *)o->dst = whole;
			one = (double)whole;
			*values = &one;
		}
		return bad;
	case OPT_TEXT:
	case OPT_FILE:
		*(const char **)o->dst = text;
		*n = 0;
		return *text ? NULL : "is empty";
	case OPT_CHOICE:
		*n = 0;
		return choice(o->arg, text, o->dst);
	case OPT_REAL:   return unit_real(text, o->dst);
	case OPT_UM:     return unit_length(text, -6, o->dst);
	case OPT_M:      return unit_length(text, 0, o->dst);
	case OPT_PER_M3: return unit_concentration(text, o->dst);
	case OPT_BYTES:  return unit_bytes(text, o->dst);
	case OPT_BOX:
		*n = 3;
		return box(text, o->dst);
	case OPT_UMS:         bad = unit_lengths(text, -6, 0, o->dst); break;
	case OPT_WAVELENGTHS: bad = unit_wavelengths(text, -6, o->dst); break;
	case OPT_REALS:       bad = unit_reals(text, 0, o->dst); break;
	case OPT_REAL_STEPS:  bad = unit_reals(text, 1, o->dst); break;
	}
	*values = ((struct reals *)o->dst)->v;
	*n = ((struct reals *)o->dst)->n;
	return bad;
}

/* The range as --help and error messages give it. */
static void range(const struct opt *o, char *text, size_t size)
{
	if (o->hi == DBL_MAX)
		snprintf(text, size, "at least %.6g", o->lo);
	else
		snprintf(text, size, "from %.6g to %.6g", o->lo, o->hi);
}

static void set(const struct opt *o, const char *text)
{
	const double *v;
	size_t n;
	char span[64];
	const char *bad = parse(o, text, &v, &n);
	if (bad && o->type == OPT_CHOICE)
		die(o->name, "'%s' %s %s", text, bad, o->arg);
	if (bad)
		die(o->name, "'%s' %s", text, bad);
	for (size_t i = 0; i < n && o->lo != o->hi; i++)
		if (!(v[i] >= o->lo && v[i] <= o->hi)) {
			range(o, span, sizeof span);
			const char *unit = o->type == OPT_UM || o->type == OPT_UMS || o->type == OPT_WAVELENGTHS ? " um"
			    : o->type == OPT_M || o->type == OPT_BOX ? " m" : "";
			die(o->name, "'%s' is out of range: %s%s", text, span, unit);
		}
}

static void standing(const struct opt *o, char *text, size_t size)
{
	const char *w = o->arg;
	*text = 0;
	switch (o->type) {
	case OPT_INT:
		if (o->lo == o->hi || (double)*(long long *)o->dst >= o->lo)    /* a default out of range: none */
			snprintf(text, size, " (%lld)", *(long long *)o->dst);
		break;
	case OPT_REAL:
		if (!isnan(*(double *)o->dst))
			snprintf(text, size, " (%.6g)", *(double *)o->dst);
		break;
	case OPT_TEXT:
		if (*(const char **)o->dst)
			snprintf(text, size, " (%s)", *(const char **)o->dst);
		break;
	case OPT_CHOICE:
		for (int i = 0; i < *(int *)o->dst && w; i++)
			w = strchr(w, '|') ? strchr(w, '|') + 1 : NULL;
		if (w && *(int *)o->dst >= 0)
			snprintf(text, size, " (%.*s)", (int)strcspn(w, "|"), w);
		break;
	default:
		break;
	}
}

static void help(const struct opt_tool *tool)
{
	printf("usage: %s %s\n%s\n\n", program_invocation_short_name, tool->synopsis, tool->summary);
	for (const struct opt *o = tool->opts; o->name; o++) {
		char left[256], now[128];
		snprintf(left, sizeof left, "%s%s%s", o->name, o->arg ? " " : "", o->arg ? o->arg : "");
		standing(o, now, sizeof now);
		printf("  %-28s  %s%s\n", left, o->help, now);
	}
	printf("  %-28s  %s\n  %-28s  %s\n", "--help", "print this and exit", "--version", "print the version and exit");
	printf("\nA value in parentheses is the default. The manual: man %s\n", program_invocation_short_name);
}

static void finish(void)
{
	struct out out = { .f = stdout, .path = "-" };
	out_close(&out);
	exit(0);
}

struct opt_line opt_parse(const struct opt_tool *tool, int argc, char **argv)
{
	static struct opt_line line;     /* reachable to the end: it is nobody's to free */
	int only_operands = 0;
	out_fill_standard();
	signal(SIGPIPE, SIG_DFL);        /* a parent may have left it ignored; who is cut by head ends silently */
	line = (struct opt_line){ 0, xalloc((size_t)argc + 1, sizeof(char *)), xtext("%s", "") };
	quote(&line.history, program_invocation_short_name);
	for (int i = 1; i < argc; i++) {
		const char *word = argv[i];
		if (only_operands || *word != '-' || !word[1]) {
			line.operand[line.n++] = argv[i];
			if (tool->words)
				quote(&line.history, word);
			continue;
		}
		if (!strcmp(word, "--")) {
			only_operands = 1;
			continue;
		}
		if (!strcmp(word, "--help")) {
			help(tool);
			finish();
		}
		if (!strcmp(word, "--version")) {
			printf("%s (motes) %s\n", program_invocation_short_name, MOTES_VERSION);
			finish();
		}
		size_t n = strncmp(word, "--", 2) ? strlen(word) : strcspn(word, "=");
		const struct opt *o = tool->opts;
		while (o->name && (strlen(o->name) != n || strncmp(o->name, word, n)))
			o++;
		if (!o->name)
			die(word, "unknown option; see %s --help", program_invocation_short_name);
		const char *value = "";
		if (o->type == OPT_FLAG) {
			if (word[n])
				die(o->name, "takes no value");
		} else if (word[n]) {
			value = word + n + 1;
		} else {
			if (++i >= argc)
				die(o->name, "needs a value (%s)", o->arg);
			value = argv[i];
		}
		set(o, value);
		if (!o->local && o->type != OPT_FILE) {
			quote(&line.history, o->name);
			if (o->type != OPT_FLAG)
				quote(&line.history, value);
		}
	}
	return line;
}

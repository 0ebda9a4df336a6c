#include "medium/provenance.h"

#include "base/die.h"

#include <stdlib.h>
#include <string.h>

static int begins(const char *text, const char *word)
{
	size_t n = strlen(word);
	return !strncmp(text, word, n) && (!text[n] || text[n] == ' ');
}

static int counts(enum provenance what, const char *option)
{
	if (what == PROVENANCE_SIZES)
		return !begins(option, "--classes");
	/* a vacuum is what is around particles unless it is said */
	return begins(option, "--particle") || (begins(option, "--host") && strcmp(option, "--host 1.0") && strcmp(option, "--host 1"));
}

static int by_text(const void *a, const void *b)
{
	return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Whether a command tells of it. */
static int tells(enum provenance what, const char *line)
{
	static const char *const programs[][5] = { { "psd" }, { "xsect", "mie-coeffs", "mie-phase", "goa-phase" } };
	int is = 0;
	for (const char *const *p = programs[what]; *p; p++)
		is |= begins(line, *p);
	return is;
}

/* What a command says, in an order of its own; NULL if it is another program's. */
static char *meaning(enum provenance what, const char *line)
{
	if (!tells(what, line))
		return NULL;
	char *copy = xtext("%s", strchr(line, ' ') ? strchr(line, ' ') + 1 : ""), *rest = copy, *said = xtext("%s", "");
	char **part = xalloc(strlen(copy) + 1, sizeof *part);
	size_t n = 0;
	/* an option goes with the words up to the next; a kind of distribution stands alone */
	while (*rest) {
		char *option = strncmp(rest, "--", 2) ? strchr(rest, ' ') : strstr(rest, " --");
		part[n++] = rest;
		rest = option ? option + 1 : rest + strlen(rest);
		if (option)
			*option = 0;
	}
	qsort(part, n, sizeof *part, by_text);
	for (size_t i = 0; i < n; i++)
		if (counts(what, part[i]))
			xappend(&said, "%s%s", *said ? " " : "", part[i]);
	free(part);
	free(copy);
	if (*said)
		return said;
	free(said);      /* such as optics that coefficients settled */
	return NULL;
}

/* The meanings of a history's commands, each on a line, after a first newline. */
static char *meanings(enum provenance what, const char *history)
{
	char *copy = xtext("%s", history), *save = NULL, *all = xtext("\n");
	for (char *line = strtok_r(copy, "\n", &save); line; line = strtok_r(NULL, "\n", &save)) {
		char *said = meaning(what, line);
		if (said)
			xappend(&all, "%s\n", said);
		free(said);
	}
	free(copy);
	return all;
}

int provenance_known(enum provenance what, const char *history)
{
	char *all = meanings(what, history);
	int known = all[1] != 0;
	free(all);
	return known;
}

char *provenance_stranger(enum provenance what, const char *history, const char *other)
{
	char *mine = meanings(what, history), *others = meanings(what, other), *save = NULL, *found = NULL;
	for (char *line = others[1] ? strtok_r(mine, "\n", &save) : NULL; line && !found; line = strtok_r(NULL, "\n", &save)) {
		char *framed = xtext("\n%s\n", line);
		if (!strstr(others, framed))
			found = xtext("%s", line);
		free(framed);
	}
	free(mine);
	free(others);
	return found;
}

char *provenance_host(const char *history)
{
	static const char option[] = " --host ";
	char *copy = xtext("%s", history), *save = NULL, *host = NULL;
	for (char *line = strtok_r(copy, "\n", &save); line; line = strtok_r(NULL, "\n", &save)) {
		const char *said = tells(PROVENANCE_OPTICS, line) ? strstr(line, option) : NULL;
		if (!said)
			continue;
		said += strlen(option);
		free(host);
		host = xtext("%.*s", (int)strcspn(said, " "), said);
	}
	free(copy);
	return host;
}

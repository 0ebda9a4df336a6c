#include "optics/select/method_selection.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define KEPT 256             /* so much of what methods prepare is kept from call to call */

/* An index, by method. */
struct known {
	double complex m;
	double limit[METHODS];   /* the size up to, or from, which it is good enough, and cheaper than Lorenz-Mie theory */
	double spent[METHODS];   /* on Lorenz-Mie terms of sizes that it serves, if only it were prepared */
	void *prepared[METHODS];
	int used;
};

struct method_selection {
	enum method method;
	double tolerance;
	struct known *known;     /* a hash table, its size a power of two */
	size_t room, n;
	int kept;
};

struct method_selection *method_selection_new(enum method method, double tolerance)
{
	struct method_selection *l = calloc(1, sizeof *l);
	if (!l)
		return NULL;
	*l = (struct method_selection){ .method = method, .tolerance = tolerance, .known = calloc(64, sizeof *l->known), .room = 64 };
	if (l->known)
		return l;
	free(l);
	return NULL;
}

enum method method_selection_asked(const struct method_selection *l) { return l->method; }

static void forget(struct method_selection *l)
{
	for (size_t k = 0; k < l->room; k++)
		for (int method = 0; method < METHODS; method++)
			if (l->known[k].prepared[method]) {
				method_table[method].forget(l->known[k].prepared[method]);
				l->known[k].prepared[method] = NULL;
			}
	l->kept = 0;
}

void method_selection_free(struct method_selection *l)
{
	if (!l)
		return;
	forget(l);
	free(l->known);
	free(l);
}

static struct known *slot(struct known *table, size_t room, double complex m)
{
	uint64_t bits[2], h;
	memcpy(bits, &m, sizeof bits);
	h = (bits[0] ^ (bits[1] * 0x9e3779b97f4a7c15u)) * 0xbf58476d1ce4e5b9u;
	size_t k = (size_t)(h >> 32) & (room - 1);
	while (table[k].used && table[k].m != m)
		k = (k + 1) & (room - 1);
	return &table[k];
}

/* How far from good, where error(x, m) is below the tolerance, it stays so on the way to bad. */
static double reach(double (*error)(double, double complex), double complex m, double tolerance, double good, double bad)
{
	if (error(bad, m) < tolerance)
		return bad;
	for (int i = 0; i < 30; i++) {
		double middle = sqrt(good * bad);
		if (error(middle, m) < tolerance)
			good = middle;
		else
			bad = middle;
	}
	return good;
}

static double limit(const struct method_row *row, double complex m, double tolerance)
{
	if (row->serves == METHOD_SMALL)
		return reach(row->error, m, tolerance, 1e-8, 1);
	return fmax(reach(row->error, m, tolerance, 2 * MIE_X_MAX, 10), row->cost);
}

static int grow(struct method_selection *l)
{
	struct known *table = calloc(2 * l->room, sizeof *table);
	if (!table)
		return -1;
	for (size_t k = 0; k < l->room; k++)
		if (l->known[k].used)
			*slot(table, 2 * l->room, l->known[k].m) = l->known[k];
	free(l->known);
	l->known = table;
	l->room *= 2;
	return 0;
}

/* Have every index in the table. */
static int meet(struct method_selection *l, int n, const struct sphere *s)
{
	for (int i = 0; i < n; i++) {
		struct known *r = slot(l->known, l->room, s[i].m);
		if (r->used)
			continue;
		*r = (struct known){ .m = s[i].m, .used = 1 };
		for (int k = 0; k < METHODS && l->method == METHOD_AUTO; k++)
			if (method_table[k].serves != METHOD_NEVER)
				r->limit[k] = limit(&method_table[k], r->m, l->tolerance);
		if (2 * ++l->n > l->room && grow(l))
			return -1;
	}
	return 0;
}

static int serves(const struct known *r, int method, double x)
{
	enum method_serves which = method_table[method].serves;
	return (which == METHOD_SMALL && x <= r->limit[method]) || (which == METHOD_LARGE && x >= r->limit[method]);
}

/* Where what Lorenz-Mie theory costs outweighs what a method prepares for an index; or where it is asked for. */
static int prepare(struct method_selection *l, enum method method, int n, const struct sphere *s)
{
	const struct method_row *row = &method_table[method];
	int asked = l->method == method;
	for (int pass = 0; pass < 2; pass++)
		for (int i = 0; i < n; i++) {
			struct known *r = slot(l->known, l->room, s[i].m);
			void **own = &r->prepared[method];
			if (!asked && !serves(r, method, s[i].x))
				continue;
			if (pass == 0) {
				r->spent[method] += s[i].x;
				continue;
			}
			if (!*own && (asked || r->spent[method] > (cimag(r->m) > 0 ? row->first_absorbing : row->first))) {
				*own = row->prepare(r->m);
				if (!*own)
					return -1;
				l->kept++;
			}
			if (*own)
				row->extend(*own, s[i].x);
		}
	return 0;
}

static enum method choose(const struct known *r, double x)
{
	for (int k = 0; k < METHODS; k++)
		if (serves(r, k, x) && (!method_table[k].prepare || r->prepared[k]))
			return k;
	return METHOD_MIE;
}

/* The spheres left to Lorenz-Mie theory, side by side. */
static int by_mie(int n, const struct sphere *s, struct efficiencies *q, double *error, const enum method *used)
{
	int some = 0, failed;
	for (int i = 0; i < n; i++)
		some += used[i] == METHOD_MIE;
	if (some == 0)
		return 0;
	double *x = malloc((size_t)some * (2 * sizeof *x + sizeof(double complex) + sizeof *q));
	if (!x)
		return -1;
	double *some_error = x + some;
	double complex *m = (double complex *)(some_error + some);
	struct efficiencies *some_q = (struct efficiencies *)(m + some);
	for (int i = 0, k = 0; i < n; i++)
		if (used[i] == METHOD_MIE) {
			x[k] = s[i].x;
			m[k++] = s[i].m;
		}
	failed = some == n ? mie_many(n, x, m, q, error) : mie_many(some, x, m, some_q, some_error);
	for (int i = 0, k = 0; i < n && some < n && !failed; i++)
		if (used[i] == METHOD_MIE) {
			q[i] = some_q[k];
			error[i] = some_error[k++];
		}
	free(x);
	return failed;
}

int method_selection_many(struct method_selection *l, int n, const struct sphere *s, struct efficiencies *q, double *error,
                          enum method *used)
{
	int failed = 0;
	for (int i = 0; i < n; i++)
		used[i] = l->method;
	if (l->method == METHOD_MIE)
		return by_mie(n, s, q, error, used);
	if (l->kept > KEPT)
		forget(l);
	if (meet(l, n, s))
		return -1;
	for (int k = 0; k < METHODS; k++)
		if (method_table[k].prepare && (l->method == METHOD_AUTO || l->method == (enum method)k) && prepare(l, k, n, s))
			return -1;
	for (int i = 0; i < n && l->method == METHOD_AUTO; i++)
		used[i] = choose(slot(l->known, l->room, s[i].m), s[i].x);
#pragma omp parallel for schedule(dynamic, 16) reduction(|:failed) if (n > 1)
	for (int i = 0; i < n; i++)
		if (used[i] != METHOD_MIE) {
			const struct known *r = slot(l->known, l->room, s[i].m);
			q[i] = method_table[used[i]].efficiencies(&s[i], r->prepared[used[i]], l->method != METHOD_AUTO, &error[i]);
			failed |= isinf(error[i]) != 0;
		}
	return failed ? -1 : by_mie(n, s, q, error, used);
}

/* die - the one way out: a line on stderr, exit status 2. */
#ifndef BASE_DIE_H
#define BASE_DIE_H

#include <stddef.h>

/* die - print "tool: object: what" and exit 2.
 * Given:  object  the file, option or column at fault; NULL leaves it out
 *         fmt     printf format of what is wrong; one ending in ':' has the text of errno appended
 */
void die(const char *object, const char *fmt, ...) __attribute__((noreturn, format(printf, 2, 3)));

/* warn - the same line, and go on. */
void warn(const char *object, const char *fmt, ...) __attribute__((format(printf, 2, 3)));

/* xalloc - n zeroed objects of the given size; dies when there is no memory or n * size overflows. */
void *xalloc(size_t n, size_t size);

/* xgrow - resize an array to n objects; dies likewise. The new part is not cleared. */
void *xgrow(void *p, size_t n, size_t size);

/* xtext - a printf into memory of its own. */
char *xtext(const char *fmt, ...) __attribute__((format(printf, 1, 2)));

/* xappend - the same at the end of such a text, which may move. */
void xappend(char **text, const char *fmt, ...) __attribute__((format(printf, 2, 3)));

#endif

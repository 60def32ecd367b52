/* exit.h: the program's exit statuses. */
#ifndef BASE_EXIT_H
#define BASE_EXIT_H

#include <stdio.h>

/* X(name, status, meaning): help texts, pages and code use these rows. */
#define EXIT_ROWS(X) \
    X(EXIT_DONE, 0, "done") \
    X(EXIT_RUN_FAILED, 1, "failed") \
    X(EXIT_BAD_INPUT, 2, "bad input") \
    X(EXIT_INTERRUPTED, 130, "interrupted") /* 128 + 2, the number of SIGINT, as in shells */

#define EXIT_VALUE(name, status, meaning) name = status,
enum { EXIT_ROWS(EXIT_VALUE) };
#undef EXIT_VALUE

#define EXIT_ONE(name, status, meaning) +1
enum { EXITS = 0 EXIT_ROWS(EXIT_ONE) };
#undef EXIT_ONE

/* Prints the exit statuses in a help text. why[i] is the reason for the status of row i, or "" for none. If why[i] is
 * NULL, the row is not printed. If a reason has further lines, they must begin with seven spaces. */
void exit_describe(FILE *out, const char *const *why);

#endif

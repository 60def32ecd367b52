/* exit.h: how a command ends. */
#ifndef BASE_EXIT_H
#define BASE_EXIT_H

/* X(name, status, meaning) */
#define EXIT_ROWS(X) \
    X(EXIT_DONE, 0, "done") \
    X(EXIT_RUN_FAILED, 1, "the run failed") \
    X(EXIT_BAD_INPUT, 2, "bad input") \
    X(EXIT_INTERRUPTED, 130, "interrupted") /* 128 + SIGINT, as shells have it */

#define EXIT_VALUE(name, status, meaning) name = status,
enum { EXIT_ROWS(EXIT_VALUE) };
#undef EXIT_VALUE

#endif

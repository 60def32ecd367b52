/* board_tests.h: shared frame of the firmware tests (f405.c, atmega.c): a named test, a count, a seed, and a failure's reason. */
#ifndef TESTS_TOOLS_BOARD_TESTS_H
#define TESTS_TOOLS_BOARD_TESTS_H

#include <stdbool.h>
#include <stddef.h>

extern const char *image; /* file of the image */

/* Sets the reason; returns false. */
__attribute__((format(printf, 1, 2))) bool no(const char *form, ...);
extern char why[300];

/* Random: 0 ... limit - 1. */
unsigned below(unsigned limit);

typedef struct board_test {
    const char *name;
    bool (*holds)(unsigned times);
    unsigned times; /* default of TIMES */
    const char *what;
} board_test;

/* Parses TEST IMAGE [TIMES [SEED]] and returns the test, with times, image and seed set. NULL after a message: no such test. */
const board_test *board_test_asked(int count, char **words, const board_test *tests, size_t of,
                                   board_test *asked);

/* Prints "ok - ..." or "not ok - ..."; returns the exit status. */
int board_test_tell(bool good, const char *what);

#endif

/* board_tests.h: what the tests of what is flashed share (f405.c, atmega.c): a test by its name, so many times, from a seed; and
 * why one does not hold. */
#ifndef TESTS_TOOLS_BOARD_TESTS_H
#define TESTS_TOOLS_BOARD_TESTS_H

#include <stdbool.h>
#include <stddef.h>

extern const char *image; /* its file */

/* Why not; returns false. */
__attribute__((format(printf, 1, 2))) bool no(const char *form, ...);
extern char why[300];

/* Scattered: 0 ... limit - 1. */
unsigned below(unsigned limit);

typedef struct board_test {
    const char *name;
    bool (*holds)(unsigned times);
    unsigned times; /* unless told */
    const char *what;
} board_test;

/* Of the command line TEST IMAGE [TIMES [SEED]] the test, with its times, image and seed set; NULL, reported: none. */
const board_test *board_test_asked(int count, char **words, const board_test *tests, size_t of,
                                   board_test *asked);

/* Prints "ok - ..." or "not ok - ..."; returns the exit status. */
int board_test_tell(bool good, const char *what);

#endif

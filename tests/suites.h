/* suites.h: the test suites of a test program. Their table is generated from the test files. */
#ifndef TESTS_SUITES_H
#define TESTS_SUITES_H

#include "unity.h"

/* Boards do fewer random cases than a PC. */
#define WH_TEST_SMALL (!__STDC_HOSTED__)

struct suite {
    const char *name;
    const char *file; /* the file that defines it, whose name begins its lines of output */
    void (*run)(void);
};

extern const struct suite suites[]; /* [suite_count] */
extern const unsigned suite_count;

/* The head of a suite and the head of a test. tests/suites.sh makes the table of suites from these. The code after
 * SUITE(name) runs before the tests. */
#define SUITE(name) \
    void suite_##name(void); \
    void suite_##name(void)
#define TEST(suite, name) \
    void test_##suite##_##name(void); \
    void test_##suite##_##name(void)

/* Compares numbers of the build's real type as floats. `most` is the largest allowed difference. */
#define CHECK_NEAR(most, wanted, found) \
    TEST_ASSERT_FLOAT_WITHIN((float)(most), (float)(wanted), (float)(found))

#endif

/* suites.h: the test suites of one test program. The table is generated from the test files. */
#ifndef TESTS_SUITES_H
#define TESTS_SUITES_H

#include "unity.h"

/* Boards draw fewer cases than a PC. */
#define WH_TEST_SMALL (!__STDC_HOSTED__)

struct suite {
    const char *name;
    const char *file; /* the file that defines it; its lines of output begin with this name */
    void (*run)(void);
};

extern const struct suite suites[]; /* [suite_count] */
extern const unsigned suite_count;

/* A test of a suite; tests/suites.sh makes the table of these lines. What a suite does first, or by itself, is its SUITE(name). */
#define SUITE(name) \
    void suite_##name(void); \
    void suite_##name(void)
#define TEST(suite, name) \
    void test_##suite##_##name(void); \
    void test_##suite##_##name(void)

/* Reals of the build, compared as floats. */
#define CHECK_NEAR(most, wanted, found) \
    TEST_ASSERT_FLOAT_WITHIN((float)(most), (float)(wanted), (float)(found))

#endif

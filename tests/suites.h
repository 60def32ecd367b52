/* suites.h: the test suites of one test program. The table is generated from the test files. */
#ifndef TESTS_SUITES_H
#define TESTS_SUITES_H

#include "unity.h"

/* Boards run fewer random cases than a PC. */
#define WH_TEST_SMALL (!__STDC_HOSTED__)

struct suite {
    const char *name;
    const char *file; /* the file that defines it; its lines of output begin with this name */
    void (*run)(void);
};

extern const struct suite suites[]; /* [suite_count] */
extern const unsigned suite_count;

/* Heads of a suite and of its tests; tests/suites.sh makes the table from them. SUITE(name) runs before the tests. */
#define SUITE(name) \
    void suite_##name(void); \
    void suite_##name(void)
#define TEST(suite, name) \
    void test_##suite##_##name(void); \
    void test_##suite##_##name(void)

/* `wanted` and `found` are of the build's real type and compared as floats; `most` is the largest difference. */
#define CHECK_NEAR(most, wanted, found) \
    TEST_ASSERT_FLOAT_WITHIN((float)(most), (float)(wanted), (float)(found))

#endif

/* main.c: runs the portable suites, on this machine and on boards. */
#include "tests/suites.h"

#include "unity.h"

#if !__STDC_HOSTED__
#include "boards/board.h"
#endif

static const char *suite_name;
static unsigned tests_before;

void setUp(void) {}
void tearDown(void) {}

/* A suite that forgot its RUN_TESTs must not look like one that passed. */
static void test_suite_ran_a_test(void) {
    TEST_ASSERT_TRUE_MESSAGE((unsigned)Unity.NumberOfTests > tests_before + 1U, suite_name);
}

int main(void) {
#if !__STDC_HOSTED__
    board_start();
#endif
    UNITY_BEGIN();
    for (unsigned i = 0; i < suite_count; i++) {
        suite_name = suites[i].name;
        tests_before = (unsigned)Unity.NumberOfTests;
        suites[i].run();
        RUN_TEST(test_suite_ran_a_test);
    }
    return UNITY_END() == 0 ? 0 : 1;
}

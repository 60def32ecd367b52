/* main.c: runs the host suites; with arguments, only the suites named ("suite_lang lang"). */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "tests/suites.h"

#include "unity.h"

static const char *suite_name;
static unsigned tests_before;

void setUp(void) {}
void tearDown(void) {}

/* A suite that forgot its RUN_TESTs must not look like one that passed. */
static void test_suite_ran_a_test(void) {
    TEST_ASSERT_TRUE_MESSAGE((unsigned)Unity.NumberOfTests > tests_before + 1U, suite_name);
}

static bool is_wanted(const char *name, int count, char **wanted) {
    for (int i = 1; i < count; i++) {
        if (strcmp(name, wanted[i]) == 0 || strcmp(name + strlen("suite_"), wanted[i]) == 0) {
            return true;
        }
    }
    return count <= 1;
}

int main(int argc, char **argv) {
    (void)setvbuf(stdout, NULL, _IOLBF, 0); /* what was said before a crash must be seen */
    UNITY_BEGIN();
    for (unsigned i = 0; i < suite_count; i++) {
        if (!is_wanted(suites[i].name, argc, argv)) {
            continue;
        }
        suite_name = suites[i].name;
        tests_before = (unsigned)Unity.NumberOfTests;
        suites[i].run();
        RUN_TEST(test_suite_ran_a_test);
    }
    return UNITY_END() == 0 ? 0 : 1;
}

/* main.c: runs the suites of a test program, on this machine and on boards. On this machine, arguments are names of
 * suites (such as "suite_lang lang"), and only these suites run. An unknown name ends the program with status 2. */
#include "tests/suites.h"

#if __STDC_HOSTED__
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#else
#include "boards/board.h"
#endif

static const char *suite_name;
static unsigned tests_before;

void setUp(void) {}
void tearDown(void) {}

/* A suite that runs no test must fail. */
static void test_suite_ran_a_test(void) {
    TEST_ASSERT_TRUE_MESSAGE((unsigned)Unity.NumberOfTests > tests_before + 1U, suite_name);
}

static void run_suite(const struct suite *each) {
    suite_name = each->name;
    tests_before = (unsigned)Unity.NumberOfTests;
    UnitySetTestFile(each->file);
    /* an assertion that fails outside a test must end this suite instead of jumping into the suite before */
    if (TEST_PROTECT()) {
        each->run();
    }
    UnitySetTestFile(__FILE__);
    RUN_TEST(test_suite_ran_a_test);
}

#if __STDC_HOSTED__

static const char *short_name(const struct suite *each) { return each->name + strlen("suite_"); }

static bool is_called(const struct suite *each, const char *name) {
    return strcmp(each->name, name) == 0 || strcmp(short_name(each), name) == 0;
}

static bool is_known(const char *name) {
    for (unsigned i = 0; i < suite_count; i++) {
        if (is_called(&suites[i], name)) {
            return true;
        }
    }
    fprintf(stderr, "error: there is no suite '%s'\nhint: one of", name);
    for (unsigned i = 0; i < suite_count; i++) {
        fprintf(stderr, "%s %s", i > 0 ? "," : "", short_name(&suites[i]));
    }
    fputc('\n', stderr);
    return false;
}

static bool is_wanted(const struct suite *each, int count, char **names) {
    for (int i = 0; i < count; i++) {
        if (is_called(each, names[i])) {
            return true;
        }
    }
    return count == 0;
}

int main(int argc, char **argv) {
    for (int i = 1; i < argc; i++) {
        if (!is_known(argv[i])) {
            return 2;
        }
    }
    (void)setvbuf(stdout, NULL, _IOLBF, 0); /* a crash must not lose output */
    UNITY_BEGIN();
    for (unsigned i = 0; i < suite_count; i++) {
        if (is_wanted(&suites[i], argc - 1, argv + 1)) {
            run_suite(&suites[i]);
        }
    }
    return UNITY_END() == 0 ? 0 : 1;
}

#else

int main(void) {
    board_start();
    UNITY_BEGIN();
    for (unsigned i = 0; i < suite_count; i++) {
        run_suite(&suites[i]);
    }
    return UNITY_END() == 0 ? 0 : 1;
}

#endif

/* test_generated_texts.c: what must hold for any mechanism is tried with every function: the writers of random expressions
 * and mechanisms know each row of host/number/function_rows.h. */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "expressions.h"
#include "host/number/functions.h"
#include "mechanism.h"
#include "unity.h"

void suite_generated_texts(void);

enum { SEED = 7 };

static const char *name(int f) { return function_name((function_id)f); }

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/* Marks the functions that the text calls; how many are left. */
static int mark_called(const char *text, bool called[FUNCTIONS]) {
    int left = 0;
    for (int f = 0; f < FUNCTIONS; f++) {
        char call[40];
        snprintf(call, sizeof call, "%s(", name(f));
        for (const char *at = strstr(text, call); at != NULL && !called[f];
             at = strstr(at + 1, call)) {
            called[f] = at == text || !is_letter(at[-1]);
        }
        left += !called[f];
    }
    return left;
}

static void expect_all(const bool called[FUNCTIONS], const char *where) {
    char message[400];
    size_t length = (size_t)snprintf(message, sizeof message, "%s never writes", where);
    bool all = true;
    for (int f = 0; f < FUNCTIONS; f++) {
        if (!called[f] && length < sizeof message) {
            length += (size_t)snprintf(message + length, sizeof message - length, " %s()", name(f));
        }
        all = all && called[f];
    }
    TEST_ASSERT_TRUE_MESSAGE(all, message);
}

/* Drawn until each was there, and then named. */
static void test_generated_texts(void) {
    static char text[1 << 14];
    static const char *const coordinates[] = {"q"};
    static const char *const constants[] = {"p"};
    const expression_names names = {coordinates, 1, 0, constants, 1};
    uint64_t seed = SEED + 3;
    bool written[FUNCTIONS] = {false};
    int left = FUNCTIONS;
    for (int i = 0; i < 5000 && left > 0; i++) {
        expression_write(&names, 3, 1, &seed, text, sizeof text);
        left = mark_called(text, written);
    }
    expect_all(written, "expression_write() of tests/host/expressions.c");
    bool derived_from[FUNCTIONS] = {false};
    left = FUNCTIONS;
    for (unsigned i = 0; i < 2000 && left > 0; i++) {
        char whole[MECHANISM_SIZE];
        mechanism_write(i, SEED + i, whole);
        left = mark_called(whole, derived_from);
    }
    expect_all(derived_from, "mechanism_write() of tests/host/mechanism.c");
}

void suite_generated_texts(void) { RUN_TEST(test_generated_texts); }

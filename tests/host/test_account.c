/* test_account.c: the energy's account in a summary: its entries are what closed forms say, with impacts between. */
#include "command.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/cli/commands.h"

#include "unity.h"

void suite_account(void);

/* The number behind `words` in the summary. */
static double told(const char *summary, const char *words) {
    const char *at = strstr(summary, words);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, words);
    return strtod(at + strlen(words), NULL);
}

/* A ball that falls from h and bounces once with restitution e loses m g h (1 - e^2) there: the summary gives that to
 * the contact and what is left over to the numbers, `with ledger` or without, and the bits are the same. */
static void test_what_contacts_took_is_told_apart(void) {
    dice d = dice_of("bounces", 4004);
    for (unsigned i = 0; i < dice_cases(10); i++) {
        const double e = dice_between(&d, 0.2, 0.95);
        const double height = dice_between(&d, 0.5, 2.0);
        const double fall_s = sqrt(2.0 * height / 9.81);
        char text[400];
        said what;
        snprintf(text, sizeof text,
                 "mechanism ball\ncoordinate z [m]\nT = 2 [kg]*z'^2/2\nV = 2 [kg]*9.81 [m/s^2]*z\n"
                 "stop z >= 0 restitution %.9f\nscene s { start z = %.9f [m]\nuntil %.4f [s] }\n",
                 e, height, fall_s * (1.0 + e));
        const char *words[] = {model_keep(text), NULL, NULL, NULL};
        command_say(command_run, words, &what);
        TEST_ASSERT_EQUAL_INT(said_owes(what.err), what.status);
        const double took = -told(what.out, "impacts, friction, holds and settings");
        const double lost = 2.0 * 9.81 * height * (1.0 - e * e);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-8 * lost, lost, took, text);
        TEST_ASSERT_TRUE_MESSAGE(fabs(told(what.out, "\n  left over")) < 1e-9 * lost, what.out);
        const char *hash = strstr(what.out, "state hash");
        TEST_ASSERT_NOT_NULL(hash);
        char kept[40];
        snprintf(kept, sizeof kept, "%.37s", hash);
        words[1] = "--with";
        words[2] = "ledger";
        command_say(command_run, words, &what);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.out, kept), what.out);
    }
    model_drop();
}

/* What a constant force gave, P (z - h), and what an evenly damped slide lost do not depend on impacts of other
 * coordinates, nor on those between: each entry that is printed is its closed form, and with what contacts took they
 * add up to the change. A rule over the steps' ends misses part of the step with the impact. */
static void test_entries_across_impacts_are_closed_forms(void) {
    dice d = dice_of("pushed bounces", 4005);
    for (unsigned i = 0; i < dice_cases(10); i++) {
        const double e = dice_between(&d, 0.2, 0.95);
        const double height = dice_between(&d, 0.5, 2.0);
        const double push = dice_between(&d, -8.0, 8.0);
        const double damping = dice_between(&d, 0.1, 1.0);
        char text[500];
        said what;
        snprintf(text, sizeof text,
                 "mechanism ball\ncoordinate z [m]\ncoordinate x [m]\ninput P = %.9f [N]\n"
                 "T = 2 [kg]*(z'^2 + x'^2)/2\nV = 2 [kg]*9.81 [m/s^2]*z\nQ(z) = P\n"
                 "F = %.9f [N*s/m]*x'^2/2\nstop z >= 0 restitution %.9f\n"
                 "scene s { start z = %.9f [m], x' = 1.5 [m/s]\nuntil 2 [s] }\n",
                 push, damping, e, height);
        const char *words[] = {model_keep(text), NULL, NULL, NULL};
        command_say(command_run, words, &what);
        TEST_ASSERT_EQUAL_INT(said_owes(what.err), what.status);
        const double work = push * (told(what.out, "\n  z ") - height);
        const double lost =
            1.5 * 1.5 * (exp(-2.0 * damping) - 1.0); /* m v^2/2, x' falls by b t/m */
        const double change = told(what.out, "\n  change");
        const double took = told(what.out, "impacts, friction, holds and settings");
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-8, work, told(what.out, "work of inputs"), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-8, lost, told(what.out, "\n  losses"), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-7, change, work + lost + took, text);
    }
    model_drop();
}

void suite_account(void) {
    RUN_TEST(test_what_contacts_took_is_told_apart);
    RUN_TEST(test_entries_across_impacts_are_closed_forms);
}

/* test_busy_beside.c: contacts that are too busy for a step which is too coarse for a spring or a damper beside them, too: whatever a warning
 * says would do does, of all that was told. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/cli/commands.h"
#include "rattle.h"
#include "unity.h"

void suite_busy_beside(void);

static void say(const char *text, const char *step, said *what) {
    const char *words[] = {model_keep(text),
                           "--quiet",
                           "--number",
                           "double",
                           step != NULL ? "--step" : NULL,
                           step,
                           NULL};
    command_say(command_run, words, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what->err), what->status, text);
}

static void test_a_cure_is_one_of_all(void) {
    dice d = dice_of("busy beside", 15005);
    const unsigned cases = dice_cases(few_or_all(usual_or(80, 12), 300));
    unsigned energies = 0;
    unsigned both = 0;
    unsigned cured = 0;
    for (unsigned i = 0; i < cases; i++) {
        const bool damped =
            i % 2 == 1; /* what is agreed on may leave most of a damper's loss over */
        const rattle r = rattle_drawn(&d, damped ? HOLD : (rattle_kind)(i / 2 % KINDS));
        const double rate_radps =
            pow(10.0, damped ? dice_between(&d, -0.1, 0.4) : dice_between(&d, -0.8, 0.1)) /
            r.step_s;
        const double speed = r.kind == BALL ? fabs(r.speed_mps) : r.number[r.kind == HOLD ? 0 : 1];
        const double size_m = speed / rate_radps * pow(10.0, dice_between(&d, -0.5, 3.0));
        char text[LINKAGE_TEXT];
        said what;
        rattle_write_beside(&r, damped, rate_radps, size_m, text);
        say(text, NULL, &what);
        const bool energy = strstr(what.err, "cannot be believed") != NULL;
        energies += energy ? 1U : 0U;
        both += energy && strstr(what.err, "[events]") != NULL ? 1U : 0U;
        for (const char *at = what.err; (at = strstr(at, "--step ")) != NULL; at++) {
            char step[40];
            if (sscanf(at, "--step %39s", step) == 1 &&
                strncmp(at + strlen("--step ") + strlen(step), " would do", 9) == 0) {
                said then;
                say(text, step, &then);
                cured++;
                if (then.err[0] != '\0') {
                    printf("%s%s# and with %s: %s\n", text, what.err, step, then.err);
                }
                TEST_ASSERT_EQUAL_STRING("", then.err);
            }
        }
    }
    model_drop();
    printf(
        "  %u rattles beside a spring or a damper: %u told of their energy, %u of both; %u cures, all silent\n",
        cases, energies, both, cured);
    TEST_ASSERT_TRUE(energies > cases / 4 && cured > cases / 4 && (both > 0 || cases < 30));
}

/* A body that a heavy round one meets head-on, with nothing that presses them together: the restitution that the hint names
 * ends the events. */
static void test_head_on(void) {
    dice d = dice_of("head on", 15006);
    const unsigned cases = dice_cases(few_or_all(usual_or(60, 20), 300));
    unsigned told = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[500];
        said what;
        const double v = dice_between(&d, -20.0, 20.0);
        const double r = dice_between(&d, 0.001, 0.03);
        const double at = v * dice_between(&d, 0.1, 0.4) + (v > 0.0 ? r : -r);
        bool again = true;
        for (int cured = 0; again; cured++) {
            snprintf(text, sizeof text,
                     "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ncoordinate u [m]\n"
                     "T = 1 [kg]*(x'^2 + y'^2)/2 + 1e4 [kg]*u'^2/2\n"
                     "stop sqrt((x - u)^2 + y^2) >= %.9g [m] restitution %s\n"
                     "scene s { start u = %.9g [m], u' = %.9g [m/s]; step 1 [ms]; until 1 [s] }\n",
                     r, cured > 0 ? "0.01" : "0", -at, v);
            say(text, NULL, &what);
            TEST_ASSERT_TRUE_MESSAGE(cured == 0 || what.err[0] == '\0', text);
            TEST_ASSERT_TRUE_MESSAGE(what.err[0] == '\0' || strstr(what.err, "restitution 0.01"),
                                     what.err);
            again = cured == 0 && what.err[0] != '\0';
            told += again;
        }
    }
    model_drop();
    TEST_ASSERT_TRUE(told * 10 > cases);
}

/* A clock in a stop that has far less inertia than the body: its run ends, and the hint names the stop. */
static void test_light_clocks(void) {
    dice d = dice_of("light clocks", 15007);
    const unsigned cases = dice_cases(usual_or(20, 8));
    unsigned failed = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[500];
        said what;
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate y [m]\ncoordinate c [s]\n"
                 "T = 1 [kg]*y'^2/2 + %.9g [J]*c'^2/2\nV = 9.81 [N]*y\n"
                 "stop y >= %.9g [m]*sin(%.9g [1/s]*c) restitution %.9g\n"
                 "scene s { start y = 0.1 [m], c' = 1; step 1 [ms]; until 1 [s] }\n",
                 pow(10.0, dice_between(&d, -9.0, -5.0)), dice_between(&d, 0.01, 0.03),
                 dice_between(&d, 20.0, 60.0), dice_between(&d, 0.0, 0.8));
        command_say(command_run, (const char *[]){model_keep(text), "--quiet", NULL}, &what);
        const bool fails = strstr(what.err, "left all bounds") != NULL;
        TEST_ASSERT_TRUE_MESSAGE(!fails || strstr(what.err, "a clock there needs"), what.err);
        failed += fails;
    }
    model_drop();
    TEST_ASSERT_TRUE(failed * 2 > cases);
}

void suite_busy_beside(void) {
    RUN_TEST(test_a_cure_is_one_of_all);
    RUN_TEST(test_head_on);
    RUN_TEST(test_light_clocks);
}

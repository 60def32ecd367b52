/* test_pulse_trains.c: forces that are on for a small part of their period, which is in a simple ratio to the step: at every
 * stage they are off, and nothing moves. And forces of so many and a half turns a step, of which stages at quarters of a step make
 * one of half a turn, in steps of half the length, too. The references are closed forms. What is off is told, or not trusted;
 * pulses that the steps resolve are silent. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/cli/commands.h"
#include "unity.h"

void suite_pulse_trains(void);

static const char *const methods[] = {"rk4", "rk4", "rk38", "nystroem5", "heun"};
enum { METHODS = sizeof methods / sizeof methods[0] };

typedef struct verdict_of {
    double value; /* of what was asked for */
    bool warned;
    bool too_fast; /* more goes on than the stages see */
    bool trusted;  /* to the end */
} verdict_of;

/* Runs it, and finds `name` in the final state. */
static verdict_of ask(const char *text, const char *name, const char *method, const char *number) {
    static said what;
    const char *words[] = {model_keep(text), "--method", method, "--number", number, NULL};
    command_say(command_run, words, &what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
    const char *at = strstr(what.out, name);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what.out);
    verdict_of v = {.warned = strstr(what.err, "warning") != NULL,
                    .too_fast = strstr(what.err, "more goes on between") != NULL,
                    .trusted = strstr(what.out, "to the end: every") != NULL};
    TEST_ASSERT_NOT_NULL(said_number(at + strlen(name), &v.value));
    return v;
}

/* A mass with drag that a force pushes for the part `duty` of its period; where it is at rest at first. */
static void write_train(char *text, size_t size, double pulses_hz, double duty, double phase,
                        double end_s) {
    snprintf(text, size,
             "mechanism train\ncoordinate x [m]\ncoordinate t [s]\n"
             "let c = cos(2*pi*(%.17g [Hz]*t + %.17g))\n"
             "T = 1 [kg]*x'^2/2 + 1e-9 [J]*t'^2/2\nF = 1 [N*s/m]*x'^2/2\n"
             "Q(x) = 1 [N]*(1 + sign(c - cos(pi*%.17g)))/2\n"
             "scene s { start t' = 1\nstep 1 [ms]\nuntil %.17g [s] }\n",
             pulses_hz, phase, duty, end_s);
}

static void test_pulses_between_stages(void) {
    static const double turns[] = {0.5, 1.0, 1.0, 1.5, 2.0, 3.0, 5.0};
    dice d = dice_of("pulses", 6301);
    const unsigned cases = dice_cases(few_or_all(usual_or(8, 3), 200));
    unsigned wrong = 0;
    unsigned told = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[700];
        const double duty = pow(10.0, dice_between(&d, -2.1, -0.6));
        const double off = pow(10.0, dice_between(&d, -7.0, -2.0));
        const double way = dice_one_of(&d, 2) == 0 ? 1.0 : -1.0;
        const double pulses_hz =
            1000.0 * turns[dice_one_of(&d, 7)] * (1.0 + (i % 3 == 0 ? way * off : 0.0));
        write_train(text, sizeof text, pulses_hz, duty, dice_between(&d, 0.0, 1.0), 1.0);
        const verdict_of v =
            ask(text, "  x' ", methods[i % METHODS], i / METHODS % 2 == 0 ? "double" : "float");
        const double right = duty * (1.0 - exp(-1.0));
        const bool is_off = !(fabs(v.value - right) < 0.1 * right);
        TEST_ASSERT_FALSE_MESSAGE(is_off && !v.warned && v.trusted, text);
        wrong += is_off ? 1U : 0U;
        told += is_off && v.warned ? 1U : 0U;
    }
    model_drop();
    printf("  %u pulse trains between stages: %u wrong, %u told, the rest not trusted\n", cases,
           wrong, told);
    TEST_ASSERT_TRUE(wrong > cases / 3);
}

/* The rate that the mass has in the end: each pulse adds what is left of it. */
static double driven_mps(double pulses_hz, double duty, double phase, double end_s) {
    double sum = 0.0;
    for (int k = 0; (k - 0.5 * duty - phase) / pulses_hz < end_s; k++) {
        const double on_s = fmax((k - 0.5 * duty - phase) / pulses_hz, 0.0);
        const double off_s = fmin((k + 0.5 * duty - phase) / pulses_hz, end_s);
        sum += off_s > on_s ? exp(off_s - end_s) - exp(on_s - end_s) : 0.0;
    }
    return sum;
}

/* Of 12 to 3,000 steps a period. */
static void test_pulses_that_steps_resolve(void) {
    dice d = dice_of("slow pulses", 6303);
    const unsigned cases = dice_cases(few_or_all(usual_or(10, 4), 400));
    unsigned right = 0;
    unsigned silent = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[700];
        const double pulses_hz = pow(10.0, dice_between(&d, -0.5, 1.9));
        const double duty = dice_between(&d, 0.1, 0.9);
        const double phase = dice_between(&d, 0.0, 1.0);
        write_train(text, sizeof text, pulses_hz, duty, phase, 5.0);
        const verdict_of v =
            ask(text, "  x' ", methods[i % METHODS], i % 2 == 0 ? "double" : "float");
        right += fabs(v.value - driven_mps(pulses_hz, duty, phase, 5.0)) < 0.01 ? 1U : 0U;
        silent += v.warned ? 0U : 1U;
        TEST_ASSERT_FALSE_MESSAGE(v.too_fast, text);
    }
    model_drop();
    printf("  %u pulse trains that steps resolve: %u right, %u silent, none told as too fast\n",
           cases, right, silent);
    TEST_ASSERT_TRUE(silent > cases / 2);
    TEST_ASSERT_EQUAL_UINT(cases, right);
}

/* A body on a spring, from rest, and a force of k + 1/2 or k turns a step. */
static void test_turns_and_a_half(void) {
    static const char *const all[] = {"nystroem5", "nystroem5", "nystroem5", "rk4",
                                      "rk38",      "nystroem4", "heun"};
    dice d = dice_of("turns and a half", 6307);
    const unsigned cases = dice_cases(few_or_all(usual_or(14, 7), 400));
    unsigned wrong = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[600];
        const double turns = 0.5 * (1.0 + dice_one_of(&d, 60));
        const double near = dice_one_of(&d, 3) == 0 ? pow(10.0, dice_between(&d, -6.0, -3.0)) : 0.0;
        const double force_radps = 2.0 * 3.14159265358979324 * (turns + near) / 0.05;
        const double spring = pow(10.0, dice_between(&d, -1.0, 1.5));
        const double phase = dice_between(&d, 0.0, 6.28);
        const double end_s = 0.05 * (30.0 + dice_one_of(&d, 300));
        snprintf(text, sizeof text,
                 "mechanism half\ncoordinate x [m]\ncoordinate t [s]\n"
                 "T = 1 [kg]*x'^2/2 + 1e-9 [J]*t'^2/2\nV = %.17g [N/m]*x^2/2\n"
                 "Q(x) = 1 [N]*sin(%.17g [Hz]*t + %.17g)\n"
                 "scene s { start t' = 1\nstep 50 [ms]\nuntil %.17g [s] }\n",
                 spring, force_radps, phase, end_s);
        const verdict_of v = ask(text, "  x ", all[i % 7], "double");
        const double own_radps = sqrt(spring);
        const double forced_m = 1.0 / (spring - force_radps * force_radps);
        const double swing_m = forced_m * force_radps * cos(phase) / own_radps;
        const double right =
            forced_m * (sin(force_radps * end_s + phase) - sin(phase) * cos(own_radps * end_s)) -
            swing_m * sin(own_radps * end_s);
        const double range = fabs(swing_m) + fabs(forced_m);
        const bool is_off = !(fabs(v.value - right) < 0.1 * range);
        TEST_ASSERT_FALSE_MESSAGE(is_off && !v.warned && v.trusted, text);
        wrong += is_off ? 1U : 0U;
    }
    model_drop();
    printf("  %u forces of whole and half turns a step: %u wrong, none silent\n", cases, wrong);
    TEST_ASSERT_TRUE(wrong > cases / 2);
}

void suite_pulse_trains(void) {
    RUN_TEST(test_pulses_between_stages);
    RUN_TEST(test_pulses_that_steps_resolve);
    RUN_TEST(test_turns_and_a_half);
}

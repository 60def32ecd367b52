/* test_turning.c: motions that turn because accelerations ask for rates: a charge in a magnetic field, a pendulum on a
 * frame that turns, springs or none beside it. A method with positions of its own has another limit for them than for
 * springs, or none; what `whirl map` says is held against the program's own runs, on both sides. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/commands/commands.h"
#include "motion.h"

#include "unity.h"

void suite_turning(void);

enum { STEPS = 20000, WINDOW = 1000 };
/* A millionth a step, from the first window to the last. */
#define NOTHING (1e-6 * (STEPS - WINDOW))

/* In a field, on a frame that turns, or both: x'' = field y' - k x, y'' = -field x' - k y, whose motions are
 * x + i y = exp(i w t) with w^2 + field w = k. The faster one has a twentieth and more of what moves: what has less than
 * a thousandth a map does not ask. */
typedef struct turning {
    double w; /* rad/s: how fast the faster one is */
    double mode[2];
    char text[700];
} turning;

/* `field_alone`: a circle about the origin. */
static turning turning_drawn(dice *d, bool field_alone) {
    const double scale = pow(10.0, dice_between(d, -2.0, 3.0));
    const double mass_kg = pow(10.0, dice_between(d, -3.0, 3.0));
    const double field = (dice_one_of(d, 2) == 0 ? 1.0 : -1.0) * dice_between(d, 0.3, 1.5) * scale;
    const double k =
        field_alone || dice_one_of(d, 3) == 0 ? 0.0 : dice_between(d, 0.2, 1.5) * scale * scale;
    turning t;
    const double root = sqrt(0.25 * field * field + k);
    t.mode[0] = -0.5 * field + root;
    t.mode[1] = -0.5 * field - root;
    t.w = 0.5 * fabs(field) + root;
    char field_text[300];
    if (dice_one_of(d, 2) == 0) { /* as forces, or as a term of the energy */
        snprintf(
            field_text, sizeof field_text,
            "Q(x) = %.17g [kg/s]*y'\nQ(y) = -%.17g [kg/s]*x'\nT = %.17g [kg]*(x'^2 + y'^2)/2\n",
            field * mass_kg, field * mass_kg, mass_kg);
    } else {
        snprintf(field_text, sizeof field_text,
                 "T = %.17g [kg]*(x'^2 + y'^2)/2 + %.17g [kg/s]*(x'*y - y'*x)/2\n", mass_kg,
                 -field * mass_kg);
    }
    snprintf(t.text, sizeof t.text,
             "mechanism turning\ncoordinate x [m]\ncoordinate y [m]\nparameter one = 1\n%s"
             "V = one*%.17g [N/m]*(x^2 + y^2)/2\n"
             "scene s { start x = 1 [m], y' = %.17g [m/s]; step %.17g [s]; until %.17g [s] }\n",
             field_text, k * mass_kg,
             field_alone ? -field : (field > 0.0 ? -1.0 : 1.0) * dice_between(d, 0.1, 0.5) * t.w,
             0.05 / t.w, 10.0 / t.w);
    return t;
}

/* How large either of its motions gets within the next steps: x + i y is the sum of both. Infinite where they fail. */
static void largest(motion *m, const turning *t, double most[2]) {
    most[0] = most[1] = 0.0;
    for (int i = 0; i < WINDOW; i++) {
        if (motion_step(m, 1) != WH_OK) {
            most[0] = most[1] = (double)INFINITY;
            return;
        }
        for (int k = 0; k < 2; k++) {
            const double other = t->mode[1 - k];
            const double re = motion_value(m, "x'") + other * motion_value(m, "y");
            const double im = motion_value(m, "y'") - other * motion_value(m, "x");
            most[k] = fmax(most[k], hypot(re, im) / (t->mode[0] - t->mode[1]));
        }
    }
}

/* By how much one of them grows in STEPS of them. */
static double grown(const turning *t, wh_method method, double hw) {
    motion m;
    double first[2];
    double last[2];
    motion_open_text(&m, t->text,
                     (stepping){.kind = &engine_double, .method = method, .step_s = hw / t->w});
    largest(&m, t, first);
    memcpy(last, first, sizeof last);
    for (int i = WINDOW; i < STEPS && last[0] + last[1] < 1e3; i += WINDOW) {
        largest(&m, t, last);
    }
    motion_close(&m);
    return last[0] + last[1] < 1e3 ? fmax(last[0] / first[0], last[1] / first[1])
                                   : (double)INFINITY;
}

/* The last field of the last row of its CSV. */
static double mapped_s(const turning *t, wh_method method, said *what) {
    char target[80];
    char step[100];
    snprintf(target, sizeof target, "%s", model_keep(t->text));
    snprintf(step, sizeof step, "step=%.17g..%.17g:2", 0.05 / t->w, 0.1 / t->w);
    const char *words[] = {
        target,  "--over", step,      "--over", "one=1..1:1", "--method", wh_methods[method].word,
        "--csv", "-",      "--quiet", NULL};
    command_say(command_map, words, what);
    const char *comma = strrchr(what->out, ',');
    TEST_ASSERT_TRUE_MESSAGE(what->status == 0 && comma != NULL, what->err);
    return strtod(comma + 1, NULL);
}

static void test_limits_of_what_turns(void) {
    static const wh_method methods[] = {WH_SEMI_IMPLICIT_EULER, WH_NYSTROEM3, WH_NYSTROEM5,
                                        WH_NYSTROEM4,           WH_RK4,       WH_HEUN};
    enum { METHODS = sizeof methods / sizeof methods[0] };
    dice d = dice_of("turning", 1431);
    const unsigned cases = dice_cases(few_or_all(1, 8) * METHODS);
    unsigned none = 0;
    for (unsigned i = 0; i < cases; i++) {
        const wh_method method = methods[i % METHODS];
        const turning t = turning_drawn(&d, false);
        said what;
        const double told = mapped_s(&t, method, &what) * t.w;
        char about[1000];
        snprintf(about, sizeof about, "%s: %.5g: %s", wh_methods[method].word, told, t.text);
        if (told == 0.0) { /* it grows, if slowly */
            TEST_ASSERT_TRUE_MESSAGE(grown(&t, method, 0.5) > 1.0 + NOTHING, about);
            none++;
        } else {
            TEST_ASSERT_TRUE_MESSAGE(grown(&t, method, 0.97 * told) < 1.0 + NOTHING, about);
            TEST_ASSERT_TRUE_MESSAGE(grown(&t, method, 1.01 * told) > 1.0 + NOTHING ||
                                         grown(&t, method, 1.03 * told) > 1.0 + NOTHING,
                                     about);
        }
    }
    model_drop();
    printf(
        "  %u limits of what turns: %u are none, the others within 3 %% of where runs of %d steps grow\n",
        cases, none, STEPS);
    TEST_ASSERT_TRUE(none > 0 && none < cases);
}

static void run_by(const turning *t, wh_method method, double step_s, said *what) {
    char target[80];
    char step[40];
    char until[40];
    snprintf(target, sizeof target, "%s", model_keep(t->text));
    snprintf(step, sizeof step, "%.17g", step_s);
    snprintf(until, sizeof until, "%.17g", 300.0 / t->w);
    const char *words[] = {target,    "--quiet", "--step",   step,
                           "--until", until,     "--method", wh_methods[method].word,
                           NULL};
    command_say(command_run, words, what);
}

/* Circles in a field, whose energy a method adds to or takes from: it is told, and the step that is named would do. */
static void test_what_is_told_of_circles(void) {
    dice d = dice_of("circles", 1432);
    const unsigned cases = dice_cases(few_or_all(10, 200));
    unsigned named = 0;
    for (unsigned i = 0; i < cases; i++) {
        const wh_method method = i % 2 == 0 ? WH_NYSTROEM5 : WH_NYSTROEM3;
        const turning t = turning_drawn(&d, true);
        const double hw = i % 2 == 0 ? dice_between(&d, 1.0, 1.4) : dice_between(&d, 0.4, 1.5);
        said what;
        run_by(&t, method, hw / t.w, &what);
        char about[SAID_SIZE + 1000];
        snprintf(about, sizeof about, "%s, h w = %.4g: %s%s", wh_methods[method].word, hw, what.err,
                 t.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, "[energy]"), about);
        const double step_s = said_named_step_s(what.err);
        if (step_s > 0.0 && strstr(what.err, "--method") == NULL) {
            run_by(&t, method, step_s, &what);
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, about);
            named++;
        }
    }
    model_drop();
    printf("  %u circles: lost energy is told; %u named steps do\n", cases, named);
    TEST_ASSERT_TRUE(named > cases / 4);
}

void suite_turning(void) {
    RUN_TEST(test_limits_of_what_turns);
    RUN_TEST(test_what_is_told_of_circles);
}

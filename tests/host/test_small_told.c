/* test_small_told.c: the figures of what is told of numbers that are small: an angle whose steps are a few of its units
 * (host/check/slow.h); and that a motion of a few of the least numbers is told. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "host/cli/commands.h"
#include "host/engine/engine.h"
#include "unity.h"

void suite_small_told(void);

static dice die;

static void expect_figure(double wanted, double is, const char *text) {
    TEST_ASSERT_TRUE_MESSAGE(fabs(is - wanted) <= 0.06 * wanted, text);
}

/* An angle goes by whole parts of 2^32 a turn: each step by the nearest number of them. */
static void test_slow_angles(void) {
    for (unsigned n = 0; n < dice_cases(usual_or(16, 6)); n++) {
        char text[400];
        double figure[3] = {0.0};
        said what;
        const double unit_rad = 2.0 * 3.14159265358979323846 / 4294967296.0;
        const double part = (double)(n % 4U) + dice_between(&die, n % 4U == 0 ? 0.15 : -0.45, 0.45);
        const double step_s = dice_between(&die, 0.001, 0.1);
        const unsigned steps = 200 + dice_one_of(&die, 300);
        const double off_rad = fabs(nearbyint(part) - part) * unit_rad * steps;
        const double span_rad = part * unit_rad * steps;
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\ncoordinate a [rad]\n"
            "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\n"
            "scene s { start a' = %.17g [rad/s], x' = 1 [m/s]; step %.17g [s]; until %.17g [s] }\n",
            part * unit_rad / step_s, step_s, step_s * steps);
        for (int compensated = 0; compensated < 2; compensated++) {
            const char *words[] = {model_keep(text),
                                   "--quiet",
                                   "--number",
                                   "float",
                                   compensated > 0 ? "--compensated" : NULL,
                                   NULL};
            command_say(command_run, words, &what);
            TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
            if (off_rad < 1.02e-3 * span_rad || off_rad < 3.1e-9 || compensated > 0) {
                continue;
            }
            const char *note = strstr(what.err, "whirl run: note:");
            TEST_ASSERT_NOT_NULL_MESSAGE(note, what.err);
            const char *at = said_exactly(
                note, "whirl run: note: 'a' turns so slowly that rounding its steps to 1.5e-9 "
                      "rad, as float does, put it off by up to ");
            at = said_exactly(said_number(at, &figure[0]), " rad, ");
            at = said_exactly(said_number(at, &figure[1]), " % of the ");
            at = said_exactly(said_number(at, &figure[2]),
                              " rad that it should cover\nhint: --compensated carries what is "
                              "rounded; a larger --step rounds less\n");
            TEST_ASSERT_TRUE_MESSAGE(
                *at == '\0' || strncmp(at, "whirl run: exit status 1 ", 25) == 0, at);
            expect_figure(off_rad, figure[0], what.err);
            expect_figure(100.0 * off_rad / span_rad, figure[1], what.err);
            expect_figure(span_rad, figure[2], what.err);
        }
        TEST_ASSERT_EQUAL_STRING("", what.err);
    }
    model_drop();
}

/* A body that goes some hundred least numbers of float away, or a few: what float rounds of that is told where it is more than a fiftieth
 * of the way, and not below a thousandth. A spring whose rates' products fall below the normal numbers likewise. */
static void test_small_numbers(void) {
    unsigned told = 0;
    for (unsigned n = 0; n < dice_cases(usual_or(40, 20)); n++) {
        char text[400];
        said what;
        const double size = exp(dice_between(&die, log(2e-44), log(n % 3U == 0 ? 1e-36 : 1e-42)));
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %.17g [N/m]*x^2/2\n"
                 "scene s { start x = %.17g [m]; step 10 [ms]; until 2 [s] }\n",
                 n % 2U == 0 ? 1.0 : 9.0, size);
        const char *words[] = {model_keep(text), "--quiet", "--number", "float", NULL};
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        void *run = engine_float.start(d.image);
        double off = 0.0;
        const double w = n % 2U == 0 ? 1.0 : 3.0;
        for (int i = 1; i <= 200; i++) {
            double real[2];
            TEST_ASSERT_EQUAL_INT(WH_OK, engine_float.step(run));
            engine_float.state(run, NULL, real);
            off = i <= 50 ? fmax(off, fabs(real[0] - size * cos(w * 0.01 * i)) / size) : off;
        }
        engine_float.stop(run);
        derived_free(&d);
        command_say(command_run, words, &what);
        const bool is_told = strstr(what.err, "[accuracy]") != NULL;
        TEST_ASSERT_TRUE_MESSAGE(off < 0.05 || is_told, what.err);
        TEST_ASSERT_TRUE_MESSAGE(off > 1e-4 || what.err[0] == '\0', what.err);
        told += is_told ? 1U : 0U;
    }
    TEST_ASSERT_TRUE(told > 3);
    model_drop();
}

void suite_small_told(void) {
    die = dice_of("small told", 90);
    RUN_TEST(test_slow_angles);
    RUN_TEST(test_small_numbers);
}

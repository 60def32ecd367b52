/* test_digits_told.c: the figures in a warning that a number has too few digits (host/run/digits.h): a free body far from its
 * origin goes by whole places of its number, so that each step's rounding is known, and what it comes to. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/commands/commands.h"
#include "unity.h"

void suite_digits_told(void);

static dice die;

typedef struct carried {
    bool is_float;
    const char *unit;
    double si; /* of that unit */
    double place_m;
    double start_m;
    double speed_mps;
    double step_s;
    unsigned steps;
} carried;

/* Between powers of two, where places are alike; `part` of a place a step. */
static carried draw(bool is_float, double part) {
    static const char *const units[] = {"m", "mm", "km"};
    static const double si[] = {1.0, 1e-3, 1e3};
    const unsigned unit = dice_one_of(&die, 3);
    const int exponent = (int)dice_one_of(&die, 9) - 3;
    const double far_m = ldexp(1.0, exponent);
    carried c = {.is_float = is_float,
                 .unit = units[unit],
                 .si = si[unit],
                 .place_m = ldexp(far_m, is_float ? -23 : -52),
                 .step_s = dice_between(&die, 0.001, 0.1),
                 .steps = 100 + dice_one_of(&die, 300)};
    /* a place of its own to begin with */
    c.start_m = far_m * 1.25 + c.place_m * floor(dice_between(&die, 0.0, 1e5));
    c.speed_mps = part * c.place_m / c.step_s;
    return c;
}

static void run(const carried *c, const char *more, said *what) {
    char text[400];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [%s]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
             "scene s { start x = %.17g [m], x' = %.17g [m/s], y' = 1 [m/s]; step %.17g [s]; until "
             "%.17g [s] }\n",
             c->unit, c->start_m, c->speed_mps, c->step_s, c->step_s * c->steps);
    const char *words[] = {
        model_keep(text), "--quiet", "--number", c->is_float ? "float" : "double", more, NULL};
    command_say(command_run, words, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, what->status, what->err);
}

static void expect_figure(double wanted, double is, const char *text) {
    TEST_ASSERT_TRUE_MESSAGE(fabs(is - wanted) <= 0.06 * wanted, text);
}

/* Each step goes on by the nearest whole number of places. */
static void test_figures(void) {
    for (unsigned n = 0; n < dice_cases(usual_or(16, 6)); n++) {
        const double part = n % 4U == 0 ? dice_between(&die, 0.1, 0.4)
                                        : (double)(n % 4U) + dice_between(&die, -0.4, 0.4);
        const carried c = draw(n % 2U == 0, part);
        double figure[3] = {0.0};
        char unit[10];
        said what;
        run(&c, NULL, &what);
        snprintf(unit, sizeof unit, " %s", c.unit);
        const double off = fabs(nearbyint(part) - part) / part;
        if (off < 0.008) {
            TEST_ASSERT_EQUAL_STRING("", what.err);
            continue;
        }
        if (off < 0.012) {
            continue;
        }
        const char *at = said_exactly(what.err, c.is_float ? "whirl run: warning: float"
                                                           : "whirl run: warning: double");
        at = said_exactly(at, " has too few digits for 'x': it rounds to ");
        at = said_exactly(said_number(at, &figure[0]), unit);
        at = said_number(said_exactly(at, " where it is, which puts it up to "), &figure[1]);
        at = said_number(said_exactly(said_exactly(at, unit), " off, "), &figure[2]);
        at = said_exactly(
            at, c.is_float ? " % of its range\nhint: --compensated or --number double would do"
                           : " % of its range\nhint: --compensated would do");
        at = said_exactly(
            at, "; coordinates whose origin is near to where they move need fewer digits\n");
        TEST_ASSERT_EQUAL_STRING("", at);
        expect_figure(c.place_m / c.si, figure[0], what.err);
        expect_figure(off * part * c.place_m * c.steps / c.si, figure[1], what.err);
        expect_figure(100.0 * off, figure[2], what.err);
        run(&c, "--compensated", &what);
        TEST_ASSERT_EQUAL_STRING("", what.err);
    }
    model_drop();
}

/* Where a step is many places it is silent. */
static void test_enough_digits(void) {
    for (unsigned n = 0; n < dice_cases(usual_or(6, 3)); n++) {
        const carried c = draw(n % 2U == 0, dice_between(&die, 80.0, 900.0));
        said what;
        run(&c, NULL, &what);
        TEST_ASSERT_EQUAL_STRING("", what.err);
    }
    model_drop();
}

void suite_digits_told(void) {
    die = dice_of("digits_told", 70);
    RUN_TEST(test_figures);
    RUN_TEST(test_enough_digits);
}

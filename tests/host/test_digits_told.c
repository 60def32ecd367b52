/* test_digits_told.c: the figures in a warning that a number has too few digits (host/run/digits.h): a free body far from its
 * origin goes by whole places of its number, so that each step's rounding is known, and what it comes to. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "blocks.h"
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
    bool second;          /* it is declared behind y, */
    double beside_mps[2]; /* which goes so, as z does: from the origin, either way */
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
                 .steps = 100 + dice_one_of(&die, 300),
                 .second = dice_one_of(&die, 2) == 0};
    for (int i = 0; i < 2; i++) {
        c.beside_mps[i] = (dice_one_of(&die, 2) == 0 ? -1.0 : 1.0) * dice_between(&die, 0.3, 3.0);
    }
    /* a place of its own to begin with */
    const double side = dice_one_of(&die, 2) == 0 ? -1.0 : 1.0;
    c.start_m = side * (far_m * 1.25 + c.place_m * floor(dice_between(&die, 0.0, 1e5)));
    c.speed_mps = (dice_one_of(&die, 2) == 0 ? -1.0 : 1.0) * part * c.place_m / c.step_s;
    return c;
}

static void run(const carried *c, const char *more, said *what) {
    char text[600];
    snprintf(text, sizeof text,
             "mechanism m\n%scoordinate x [%s]\n%scoordinate z [m]\n"
             "T = 1 [kg]*(x'^2 + y'^2 + z'^2)/2\n"
             "scene s { start x = %.17g [m], x' = %.17g [m/s], y' = %.17g [m/s], z' = %.17g [m/s]; "
             "step %.17g [s]; until %.17g [s] }\n",
             c->second ? "coordinate y [m]\n" : "", c->unit, c->second ? "" : "coordinate y [m]\n",
             c->start_m, c->speed_mps, c->beside_mps[0], c->beside_mps[1], c->step_s,
             c->step_s * c->steps);
    const char *words[] = {
        model_keep(text), "--quiet", "--number", c->is_float ? "float" : "double", more, NULL};
    command_say(command_run, words, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, what->status, what->err);
}

static void expect_figure(double wanted, double is, double beside, const char *text) {
    TEST_ASSERT_TRUE_MESSAGE(fabs(is - wanted) <= 0.06 * wanted + beside, text);
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
        if (c.is_float && part * c.steps < 70.0) { /* compensated, it is right to half a place */
            continue;
        }
        at = said_exactly(
            at, c.is_float ? " % of its range\nhint: --compensated or --number double would do"
                           : " % of its range\nhint: --compensated would do");
        at = said_exactly(
            at, "; coordinates whose origin is near to where they move need fewer digits\n");
        TEST_ASSERT_EQUAL_STRING("", at);
        /* what it is held against has places, too, and is off by half of one */
        expect_figure(c.place_m / c.si, figure[0], 0.0, what.err);
        expect_figure(off * part * c.place_m * c.steps / c.si, figure[1], 0.5 * c.place_m / c.si,
                      what.err);
        expect_figure(100.0 * off, figure[2], 50.0 / (part * c.steps), what.err);
        if (part * c.steps > 60.0) { /* of less, half a place is more than a hundredth */
            run(&c, "--compensated", &what);
            TEST_ASSERT_EQUAL_STRING("", what.err);
        }
    }
    model_drop();
}

/* What goes less than three ten-millionths of how far away it is does not move, whatever goes beside it: it may stand still. */
static void test_hardly_moves(void) {
    for (unsigned n = 0; n < dice_cases(usual_or(12, 8)); n++) {
        carried c = draw(true, 1.0);
        said what;
        double part = exp(dice_between(&die, log(1e-7), log(9e-7)));
        part = fabs(part - 3e-7) < 2e-8 ? 2.5e-7 : part;
        c.steps = 60 + dice_one_of(&die, 60);
        c.speed_mps = copysign(part * c.start_m / (c.step_s * c.steps), c.speed_mps);
        run(&c, NULL, &what);
        if (part < 3e-7) {
            TEST_ASSERT_EQUAL_STRING("", what.err);
        } else {
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, "float has too few digits for 'x'"),
                                         what.err);
            const char *off = strstr(what.err, " off, ");
            double figure = 0.0;
            TEST_ASSERT_NOT_NULL_MESSAGE(off, what.err);
            (void)said_number(off + strlen(" off, "), &figure);
            TEST_ASSERT_TRUE_MESSAGE(figure > 90.0 && figure < 110.0, what.err);
        }
    }
    model_drop();
}

/* Of float, in whole places a step, from between two: it is told that it starts elsewhere, which no sums mend. */
static void test_starts_between_places(void) {
    unsigned told = 0;
    for (unsigned n = 0; n < dice_cases(12); n++) {
        carried c = draw(true, 1.0 + (double)(n % 3U));
        double figure[3] = {0.0};
        char words[120];
        said what;
        const double between = dice_between(&die, 0.15, 0.48);
        c.steps = 6 + dice_one_of(&die, 20);
        c.start_m += between * c.place_m;
        const double part = between / ((1.0 + (double)(n % 3U)) * c.steps);
        run(&c, NULL, &what);
        if (part < 0.0098) {
            TEST_ASSERT_EQUAL_STRING("", what.err);
        }
        if (part < 0.0102) {
            continue;
        }
        snprintf(words, sizeof words, " %s where it is, which puts it up to ", c.unit);
        const char *at = said_exactly(
            what.err, "whirl run: warning: float has too few digits for 'x': it rounds to ");
        at = said_number(said_exactly(said_number(at, &figure[0]), words), &figure[1]);
        snprintf(words, sizeof words, " %s off, ", c.unit);
        at = said_number(said_exactly(at, words), &figure[2]);
        (void)said_exactly(at, " % of its range\nhint: --number double would do; coordinates");
        expect_figure(c.place_m / c.si, figure[0], 0.0, what.err);
        expect_figure(between * c.place_m / c.si, figure[1], 0.0, what.err);
        expect_figure(100.0 * part, figure[2], 0.0, what.err);
        told++;
    }
    model_drop();
    TEST_ASSERT_TRUE(told > 1U);
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

/* --- what would do ---------------------------------------------------------------------------------------------*/

/* A spring far from the origin, or a body that goes by, in float: of x = far + cos(w t) m, or + v t, the most that a row is off,
 * of its column's range. The centre is no float, but where it starts is one. */
typedef struct far_spring {
    double far_m;
    double w_radps; /* 0: none */
    double speed_mps;
    double step_s;
    unsigned steps;
} far_spring;

static double off_with(const far_spring *f, const char *file, const char *number, const char *sums,
                       said *what) {
    const char *words[] = {file, "--csv", "-", "--every", "160ms", "--number", number, sums, NULL};
    double low[2] = {(double)INFINITY, (double)INFINITY};
    double high[2] = {-(double)INFINITY, -(double)INFINITY};
    double off[2] = {0.0};
    unsigned rows = 0;
    command_say(command_run, words, what);
    double is[3];
    for (const char *row = what->out; (row = said_row(row, 3, is)) != NULL; rows++) {
        const double w = f->w_radps;
        const double should[] = {w > 0.0 ? f->far_m + cos(w * is[0])
                                         : f->far_m + f->speed_mps * is[0],
                                 w > 0.0 ? -w * sin(w * is[0]) : f->speed_mps};
        for (int i = 0; i < 2; i++) {
            low[i] = fmin(low[i], should[i]);
            high[i] = fmax(high[i], should[i]);
            off[i] = fmax(off[i], fabs(is[1 + i] - should[i]));
        }
    }
    TEST_ASSERT_EQUAL_UINT(f->steps / 8 + 1, rows);
    return fmax(off[0] / (high[0] - low[0]), high[1] > low[1] ? off[1] / (high[1] - low[1]) : 0.0);
}

/* What is named leaves next to nothing, and what is not named leaves something. */
static void test_what_would_do(void) {
    unsigned found[2] = {0};
    const long before = blocks_in_use();
    for (unsigned c = 0; c < dice_cases(usual_or(24, 16)); c++) {
        char text[600];
        said what;
        const far_spring f = {.far_m = exp(dice_between(&die, 9.0, 13.0)),
                              .w_radps = c % 4U == 3 ? 0.0 : dice_between(&die, 0.5, 3.0),
                              .speed_mps = dice_between(&die, 0.5, 3.0),
                              .step_s = 0.02,
                              .steps = 8 * (25 + dice_one_of(&die, 25))};
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
            "V = %.17g [N/m]*(x - %.17g [m])^2/2\n"
            "scene s { start x = %.17g [m], x' = %.17g [m/s]; step 20 [ms]; until %.2f [s] }\n",
            f.w_radps * f.w_radps, f.far_m, f.far_m + (f.w_radps > 0.0 ? 1.0 : 0.0),
            f.w_radps > 0.0 ? 0.0 : f.speed_mps, 0.02 * f.steps);
        const char *file = model_keep(text);
        const double plain = off_with(&f, file, "float", NULL, &what);
        const bool told = strstr(what.err, "float has too few digits") != NULL;
        const bool sums = told && strstr(what.err, "hint: --compensated") != NULL;
        const bool in_double = told && strstr(what.err, "--number double would do") != NULL;
        said other;
        const double with_sums = off_with(&f, file, "float", "--compensated", &other);
        const double with_double = off_with(&f, file, "double", NULL, &other);
        TEST_ASSERT_TRUE_MESSAGE(told ? plain > 2e-3 : plain < 1.5e-2, text);
        if (told) {
            TEST_ASSERT_TRUE_MESSAGE(sums ? with_sums < 9e-3 : with_sums > 6e-4, text);
            TEST_ASSERT_TRUE_MESSAGE(in_double && with_double < 1e-4, text);
            found[sums ? 1 : 0]++;
        }
    }
    model_drop();
    TEST_ASSERT_TRUE(blocks_in_use() == before); /* all is given back */
    TEST_ASSERT_TRUE(found[0] > 1U && found[1] > 1U);
}

void suite_digits_told(void) {
    die = dice_of("digits_told", 70);
    RUN_TEST(test_figures);
    RUN_TEST(test_hardly_moves);
    RUN_TEST(test_starts_between_places);
    RUN_TEST(test_enough_digits);
    RUN_TEST(test_what_would_do);
}

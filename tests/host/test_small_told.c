/* test_small_told.c: the figures of what is told of numbers that are small: an angle whose steps are a few of its units
 * (host/run/slow.h), a size of a few of the least numbers (faint.h), a product below the normal ones (narrow.h). */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "host/commands/commands.h"
#include "host/run/faint.h"
#include "host/run/narrow.h"
#include "host/run/watch.h"
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
            TEST_ASSERT_EQUAL_INT_MESSAGE(0, what.status, what.err);
            if (off_rad < 1.02e-3 * span_rad || off_rad < 3.1e-9 || compensated > 0) {
                continue;
            }
            const char *at = said_exactly(
                what.err, "whirl run: note: 'a' turns so slowly that rounding its steps to 1.5e-9 "
                          "rad, as float does, put it off by up to ");
            at = said_exactly(said_number(at, &figure[0]), " rad, ");
            at = said_exactly(said_number(at, &figure[1]), " % of the ");
            at = said_exactly(said_number(at, &figure[2]),
                              " rad that it should cover\nhint: --compensated carries what is "
                              "rounded; a larger --step rounds less\n");
            TEST_ASSERT_EQUAL_STRING("", at);
            expect_figure(off_rad, figure[0], what.err);
            expect_figure(100.0 * off_rad / span_rad, figure[1], what.err);
            expect_figure(span_rad, figure[2], what.err);
        }
        TEST_ASSERT_EQUAL_STRING("", what.err);
    }
    model_drop();
}

/* What stands a few hundred of the least numbers from zero: their roundings' root is told, of that. */
static void test_faint_sizes(void) {
    for (unsigned n = 0; n < dice_cases(usual_or(16, 6)); n++) {
        char text[400];
        double figure[2] = {0.0};
        said what;
        const bool is_float = n % 2U == 0;
        const double unit = is_float ? 0x1p-149 : 0x1p-1074;
        const double units =
            n % 4U < 2 ? 30.0 + dice_one_of(&die, 900) : 3.0 + dice_one_of(&die, 12);
        const unsigned steps = 100 + dice_one_of(&die, 900);
        const double part = 0.5 / units * sqrt((double)steps);
        snprintf(
            text, sizeof text,
            "mechanism m\nstate y [m]\nequation y' = 1 [m/s]\nstate x\nequation x' = 0 [1/s]*x\n"
            "scene s { start x = %.17g; step 1 [ms]; until %.17g [s] }\n",
            unit * units, 1e-3 * steps);
        const char *words[] = {model_keep(text), "--quiet", "--number",
                               is_float ? "float" : "double", NULL};
        command_say(command_run, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, what.status, what.err);
        const char *at = strstr(what.err, "whirl run: warning: 'x' is so small that ");
        TEST_ASSERT_NOT_NULL_MESSAGE(at, what.err);
        at = said_exactly(at + strlen("whirl run: warning: 'x' is so small that "),
                          is_float ? "float" : "double");
        at = said_exactly(at, " has no digits for it: steps round to ");
        at = said_exactly(said_number(at, &figure[0]), ", up to ");
        at = said_exactly(said_number(at, &figure[1]),
                          " % of its size over the run\nhint: smaller units make larger numbers");
        (void)said_exactly(at, is_float ? "; or --number double\n" : "\n");
        expect_figure(unit, figure[0], what.err);
        expect_figure(100.0 * fmin(part, 1.0), figure[1], what.err);
    }
    model_drop();
}

/* What is divided by a product beyond float's largest number is nothing there: all of it is told. */
static void test_large_products(void) {
    for (unsigned n = 0; n < dice_cases(usual_or(8, 4)); n++) {
        char text[400];
        said what;
        const bool told = n % 2U == 0;
        const double beyond = exp(dice_between(&die, log(1.1), log(1e5)));
        const double product = 0x1.fffffep127 * (told ? beyond : 1.0 / beyond);
        const double q = exp(dice_between(&die, log(1e15), log(1e25)));
        snprintf(
            text, sizeof text,
            "mechanism m\nstate x [m]\ninput p = %.17g\ninput q = %.17g\ninput c = %.17g [m/s]\ninput r = 1\n"
            "equation x' = c/(p*q + r)\nscene s { step 10 [ms]; until 1 [s] }\n",
            product / q, q, exp(dice_between(&die, log(1e30), log(1e37))));
        const char *words[] = {model_keep(text), "--quiet", "--number", "float", NULL};
        command_say(command_run, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, what.status, what.err);
        TEST_ASSERT_EQUAL_MESSAGE(
            told, strstr(what.err, "or beyond 3.4e+38 are cut or lost, up to 1e+02 % of") != NULL,
            what.err);
        TEST_ASSERT_TRUE_MESSAGE(told || what.err[0] == '\0', what.err);
    }
    model_drop();
}

/* A product of two inputs that float cuts: what a least normal number is rounded by is told, of it. */
static void test_small_products(void) {
    for (unsigned n = 0; n < dice_cases(usual_or(8, 4)); n++) {
        char text[400];
        double figure[2] = {0.0};
        said what;
        const double part = exp(dice_between(&die, log(1.3e-3), log(3.0)));
        const double product = 0x1p-24 * 0x1p-126 / part;
        const double p = exp(dice_between(&die, log(1e-22), log(1e-19)));
        const bool told = n % 4U < 3;
        snprintf(text, sizeof text,
                 "mechanism m\nstate x [m]\ninput p = %.17g [m/s]\ninput q = %.17g\n"
                 "input c = 1e%d\nequation x' = p*q*c\n"
                 "scene s { step 10 [ms]; until 1 [s] }\n",
                 p, told ? product / p : 1e-15, told ? 38 : 30);
        const char *words[] = {model_keep(text), "--quiet", "--number", "float", NULL};
        command_say(command_run, words, &what);
        const char *at = strstr(what.err, "whirl run: warning: float has no room for what '");
        TEST_ASSERT_EQUAL_MESSAGE(told, at != NULL, what.err);
        if (!told) {
            continue;
        }
        at = said_exactly(
            at + strlen("whirl run: warning: float has no room for what '"),
            "x' is made of: products below 1.2e-38 or beyond 3.4e+38 are cut or lost, up to ");
        at = said_number(said_exactly(said_number(at, &figure[0]), " % of its slope about t = "),
                         &figure[1]);
        (void)said_exactly(at, " s\nhint: --number double; float holds sizes from 1.2e-38 to "
                               "3.4e+38 in SI units\n");
        expect_figure(100.0 * fmin(part, 1.0), figure[0], what.err);
        TEST_ASSERT_TRUE(figure[1] >= 0.0 && figure[1] <= 1.0);
    }
    model_drop();
}

/* --- of records that are made up ----------------------------------------------------------------------------------------*/

enum { RECORDS = 7, ANGLES = 1, PLACES = 2, UNKNOWNS_OF = ANGLES + PLACES, ALL = 2 * UNKNOWNS_OF };

static const char *const three =
    "mechanism m\ncoordinate x [m]\ncoordinate a [rad]\ncoordinate y [m]\n"
    "input p = %.17g [N*s/m]\ninput q = %.17g\ninput c = 1e35\n"
    "T = 1 [kg]*(x'^2 + y'^2)/2 + 1 [kg*m^2]*a'^2/2\n"
    "Q(x) = p*q*c*x'*cos(a)\nQ(y) = p*q*c*y'*x/(1 [m]) + q^3*c*y*1 [N/m]\n"
    "Q(a) = p*q*a'*x'*c*y*1 [s]\n"
    "scene s { start a = 1 [rad], y = 1 [m], x' = 1 [m/s]; step 10 [ms]; until 1 [s] }\n";

/* The largest part that is lost of any slope's largest, whose it is and when: of those that move what is theirs. */
static narrow worst_of(const image *im, const watch *w, double state[RECORDS][ALL]) {
    const tape *t = im->list[IMAGE_STEP];
    double most[UNKNOWNS_OF] = {0.0};
    double lost[RECORDS][UNKNOWNS_OF];
    double input[3];
    narrow worst = {.component = -1};
    evaluator *e = evaluator_new(t);
    evaluator_wrap(e);
    image_inputs(im, input);
    TEST_ASSERT_EQUAL_INT(UNKNOWNS_OF, t->results);
    for (int k = 0; k < RECORDS; k++) {
        double value[UNKNOWNS_OF];
        double off[2][UNKNOWNS_OF];
        const double *places = state[k] + ANGLES;
        evaluator_run(e, w->record_s[k], state[k], places, places + PLACES, input, value);
        evaluator_rounding(e, state[k], 0.0, off[0]);
        evaluator_rounding(e, state[k], 0x1p-126, off[1]);
        for (int i = 0; i < UNKNOWNS_OF; i++) {
            most[i] = fmax(most[i], fabs(value[i]));
            lost[k][i] = 0x1p-24 * (off[1][i] - off[0][i]);
        }
    }
    evaluator_free(e);
    for (int k = 0; k < RECORDS; k++) {
        for (int i = 0; i < UNKNOWNS_OF; i++) {
            const int rate = UNKNOWNS_OF + i;
            const double until_s = (double)w->steps * w->step_s;
            const double size = fmax(fmax(fabs(w->low[i]), fabs(w->high[i])), w->range[i]);
            const bool moves = w->range[rate] > 0.0 ? most[i] * until_s > 1e-3 * w->range[rate]
                                                    : most[i] * until_s * until_s > 1e-3 * size;
            if (moves && most[i] > 0.0 && lost[k][i] / most[i] > worst.part) {
                worst = (narrow){lost[k][i] / most[i], rate, w->record_s[k]};
            }
        }
    }
    return worst;
}

static void test_small_products_of_records(void) {
    unsigned told[UNKNOWNS_OF + 1] = {0};
    for (unsigned n = 0; n < dice_cases(usual_or(60, 20)); n++) {
        char text[800];
        double state[RECORDS][ALL];
        const double p = exp(dice_between(&die, log(1e-22), log(1e-19)));
        snprintf(text, sizeof text, three, p, 0x1p-150 * exp(dice_between(&die, 0.0, 5.0)) / p);
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        const image *im = d.image;
        TEST_ASSERT_EQUAL_INT(ANGLES, im->angles);
        watch *w = watch_open(im, &engine_float);
        w->records = RECORDS;
        w->steps = 1U + dice_one_of(&die, 100);
        for (int k = 0; k < RECORDS; k++) {
            w->record_s[k] = 0.1 * k;
            for (int i = 0; i < ALL; i++) {
                state[k][i] = exp(dice_between(&die, -3.0, 3.0)) * (n % 2U == 0 ? 1.0 : -1.0);
                w->record[k * ALL + i] = state[k][i];
            }
        }
        for (int i = 0; i < ALL; i++) {
            const double size = exp(dice_between(&die, -30.0, 3.0));
            w->range[i] = dice_one_of(&die, 2) == 0 ? 0.0 : size;
            w->low[i] = -size * dice_between(&die, 0.0, 1.0);
            w->high[i] = size * dice_between(&die, 0.0, 1.0);
        }
        const narrow wanted = worst_of(im, w, state);
        const narrow found = narrow_of(w);
        TEST_ASSERT_EQUAL_INT(wanted.component, found.component);
        TEST_ASSERT_TRUE(fabs(wanted.part - found.part) <= 1e-12 * wanted.part);
        TEST_ASSERT_TRUE(wanted.time_s == found.time_s);
        told[wanted.component < 0 ? UNKNOWNS_OF : wanted.component - UNKNOWNS_OF]++;
        watch_close(w);
        derived_free(&d);
    }
    for (int i = 0; i <= UNKNOWNS_OF; i++) {
        TEST_ASSERT_TRUE(told[i] > 0);
    }
}

/* Of sizes that are made up: the one of which the steps' roundings are most is told, where that is more than a thousandth; what
 * started at something and is nothing has lost all of it. Angles are told elsewhere. */
static void test_faint_sizes_of_components(void) {
    static const char *const names[ALL] = {"a", "x", "y", "a'", "x'", "y'"};
    char text[800];
    snprintf(text, sizeof text, three, 1.0, 1.0);
    derived d = derived_scene(text, "s");
    derived_expect(&d, text);
    for (unsigned n = 0; n < dice_cases(usual_or(100, 40)); n++) {
        const engine_kind *kind = n % 3U == 0 ? &engine_double : &engine_float;
        const double unit = kind == &engine_double ? 0x1p-1074 : 0x1p-149;
        watch *w = watch_open(d.image, kind);
        w->steps = n % 10U == 9 ? 0 : 1U + dice_one_of(&die, 4000);
        double most = 1e-3;
        int worst = -1;
        for (int i = 0; i < ALL; i++) {
            double size[3] = {0.0};
            for (int k = 0; k < 3 && dice_one_of(&die, 8) > 0; k++) {
                size[k] = unit * floor(exp(dice_between(&die, 4.0, 16.0)));
            }
            w->low[i] = -size[0];
            w->high[i] = size[1];
            w->range[i] = size[2];
            const double furthest = fmax(fmax(size[0], size[1]), size[2]);
            const bool gone = i >= ANGLES && d.image->start_real[i - ANGLES] != 0.0;
            const double part = furthest > 0.0 ? 0.5 * sqrt((double)w->steps) / (furthest / unit)
                                               : (gone ? 1.0 : 0.0);
            if (i >= ANGLES && part > most) {
                most = part;
                worst = i;
            }
        }
        char wanted[500] = "";
        char *is = NULL;
        size_t length = 0;
        if (worst >= 0 && w->steps > 0) {
            const bool is_float = kind == &engine_float;
            snprintf(
                wanted, sizeof wanted,
                "whirl run: warning: '%s' is so small that %s has no digits for it: steps round "
                "to %.2g, up to %.2g %% of its size over the run\nhint: smaller units make "
                "larger numbers%s\n",
                names[worst], kind->name, unit, 100.0 * fmin(most, 1.0),
                is_float ? "; or --number double" : "");
        }
        FILE *out = open_memstream(&is, &length);
        faint_say(out, d.image, kind, w);
        fclose(out);
        TEST_ASSERT_EQUAL_STRING(wanted, is);
        free(is);
        watch_close(w);
    }
    derived_free(&d);
}

void suite_small_told(void) {
    die = dice_of("small_told", 71);
    RUN_TEST(test_slow_angles);
    RUN_TEST(test_faint_sizes);
    RUN_TEST(test_large_products);
    RUN_TEST(test_small_products);
    RUN_TEST(test_small_products_of_records);
    RUN_TEST(test_faint_sizes_of_components);
}

/* test_against_told.c: the words for whatever may be said against a run (host/run/belief.h, digits.h), of findings that are made
 * up: every sentence whole, and when there is something to say. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "host/run/digits.h"
#include "host/run/verdict.h"
#include "unity.h"

void suite_against_told(void);

static dice die;

enum { TEXT = 1500 };

static bool maybe(void) { return dice_one_of(&die, 2) == 0; }

static void expect_text(const char *wanted, FILE *out, char **is) {
    fclose(out);
    TEST_ASSERT_EQUAL_STRING(wanted, *is);
    free(*is);
}

/* --- the balance -----------------------------------------------------------------------------------------------------*/

static const engine_kind plain = {.name = "plain"};

static double no_unit(const void *run, int i) {
    (void)run;
    return (double)i;
}

static const engine_kind in_units = {.name = "in units", .unit = no_unit};

static void said_hint(const belief *b, const engine_kind *kind, wh_method method, const char *cure,
                      char text[TEXT]) {
    if (cure != NULL) {
        snprintf(text, TEXT, "hint: %s\n", cure);
    } else if (b->exact) {
        strcpy(text,
               "hint: the steps of --matrix exact are exact whatever their size: --number double "
               "tells what rounding does\n");
    } else if (b->saturated) {
        strcpy(text,
               "hint: values were held at an end of their range, which keeps no energy: widen "
               "it: range NAME = A .. B\n");
    } else if (b->slow && kind->unit != NULL) {
        strcpy(text,
               "hint: rounding took a share of what steps were to add: the note says of what\n");
    } else if (b->jump_s >= 0.0) {
        snprintf(
            text, TEXT,
            "hint: most of it was lost about t = %.9g s: a singular position was passed there, "
            "or the step is too coarse for what happens: a smaller --step tells which, since at "
            "a singular position none helps\n",
            b->jump_s);
    } else {
        snprintf(text, TEXT, "hint: the step is too coarse for this motion: a smaller --step%s%s\n",
                 method == WH_HEUN || method == WH_EULER ? ", or --method rk4" : "",
                 kind == &engine_float ? "; --number double tells what float's rounding does" : "");
    }
}

static void test_what_is_not_believed(void) {
    static const wh_method method[] = {WH_RK4, WH_HEUN, WH_RK38, WH_EULER};
    static const engine_kind *const kind[] = {&plain, &engine_float, &engine_double, &in_units};
    for (unsigned c = 0; c < dice_cases(usual_or(200, 60)); c++) {
        char wanted[TEXT];
        char hint[TEXT];
        char *is = NULL;
        size_t size = 0;
        const belief b = {.left_J = dice_between(&die, -3.0, 3.0),
                          .largest_J = dice_between(&die, 0.1, 5.0),
                          .ratio = dice_between(&die, 0.0, 1.0),
                          .saturated = dice_one_of(&die, 4) == 0,
                          .slow = maybe(),
                          .exact = dice_one_of(&die, 4) == 0,
                          .jump_s = maybe() ? dice_between(&die, 0.0, 9.0) : -1.0};
        const double way_J = maybe() ? 0.0 : fabs(b.left_J) * dice_between(&die, 1.0, 3.0);
        const char *cure = dice_one_of(&die, 4) == 0 ? "a word" : NULL;
        const wh_method by = method[dice_one_of(&die, 4)];
        const engine_kind *of = kind[dice_one_of(&die, 4)];
        said_hint(&b, of, by, cure, hint);
        if (way_J > 2.0 * fabs(b.left_J)) {
            snprintf(
                wanted, sizeof wanted,
                "who: this run cannot be believed: up to %.3g J of its energy was missing on the "
                "way, %.2e of the largest entry of its books\n%s",
                way_J, way_J / b.largest_J, hint);
        } else {
            snprintf(wanted, sizeof wanted,
                     "who: this run cannot be believed: %.3g J of its energy is left over, %.2e of "
                     "the largest entry of its books\n%s",
                     b.left_J, b.ratio, hint);
        }
        FILE *out = open_memstream(&is, &size);
        belief_say(out, "who", &b, of, by, way_J, cure);
        expect_text(wanted, out, &is);
    }
}

static void test_when_it_is_not_believed(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(200, 60)); c++) {
        const belief b = {.known = dice_one_of(&die, 5) > 0,
                          .exact = dice_one_of(&die, 5) == 0,
                          .rounded = maybe(),
                          .left_J = dice_between(&die, -1.0, 1.0),
                          .rounding_J = dice_between(&die, 0.0, 1.0),
                          .largest_J = maybe() ? 0.0 : dice_between(&die, 1.0, 400.0),
                          .ratio = dice_between(&die, 0.0, 3e-3)};
        const watch w = {.balanced = dice_one_of(&die, 4) > 0,
                         .doubts = dice_one_of(&die, 2),
                         .most_J = exp(dice_between(&die, -5.0, 2.0)),
                         .singular = {.done = maybe(), .off = dice_between(&die, 0.0, 6e-3)}};
        const bool left = b.known && fabs(b.left_J) > b.rounding_J && b.ratio > 1e-3;
        TEST_ASSERT_EQUAL(left, belief_lost(&b, 1e-3));
        const bool none_by_steps = w.balanced && w.doubts > 0 && w.most_J / 1e-3 < b.largest_J;
        const bool on_the_way = b.known && w.balanced && !b.exact && w.most_J > b.rounding_J &&
                                w.most_J / 3e-3 > b.largest_J;
        const judged j = judged_of(NULL, &engine_double, &w, &b);
        TEST_ASSERT_EQUAL((left && !none_by_steps) || on_the_way, judged_lost(&j));
        TEST_ASSERT_EQUAL(w.singular.done && w.singular.off >= 3e-3, judged_singular(&j));
        const double way = w.balanced && b.largest_J > 0.0 ? w.most_J / b.largest_J : 0.0;
        TEST_ASSERT_TRUE(fabs(fmax(b.ratio, way) - judged_missing(&j)) < 1e-15 + 1e-12 * way);
        char wanted[TEXT] = "";
        char *is = NULL;
        size_t size = 0;
        const char *entry = !b.rounded ? "the largest entry of the books"
                            : b.exact
                                ? "the least entry that rounding and the books' own integrals "
                                  "let one tell"
                                : "the least entry that rounding lets one tell";
        if (b.known) {
            snprintf(wanted, sizeof wanted, "energy left over   %.2e of %s, %.3g J\n", b.ratio,
                     entry, b.largest_J);
        }
        FILE *out = open_memstream(&is, &size);
        belief_print(out, &b);
        expect_text(wanted, out, &is);
    }
}

/* --- digits ------------------------------------------------------------------------------------------------------------*/

/* Twenty steps. */
static const char *const free_bodies =
    "mechanism m\ncoordinate q [deg]\ncoordinate y [mm]\ncoordinate x [cm]\n"
    "T = 1 [kg]*x'^2/2 + 1 [kg]*y'^2/2 + 1 [kg*m^2]*q'^2/2\n"
    "scene s { step 0.01 [s]; until 0.2 [s] }\n";

static void test_too_few_digits(void) {
    static const struct {
        const char *name;
        const char *unit[2];
        double of_si;
    } told[] = {{"x", {"cm", "cm/s"}, 1e2},
                {"y", {"mm", "mm/s"}, 1e3},
                {"q", {"deg", "deg/s"}, 180.0 / 3.14159265358979323846}};
    derived made = derived_scene(free_bodies, "s");
    derived_expect(&made, free_bodies);
    for (unsigned c = 0; c < dice_cases(usual_or(100, 40)); c++) {
        const unsigned k = dice_one_of(&die, 3);
        const unsigned primes = dice_one_of(&die, 2);
        const double last_place = exp(dice_between(&die, -9.0, -2.0));
        const digits d = {.component =
                              dice_one_of(&die, 4) > 0
                                  ? derived_component(made.image, told[k].name, (int)primes)
                                  : -1,
                          .place = last_place,
                          .off = last_place * 20.0 * exp(dice_between(&die, -2.0, 2.0)),
                          .range = dice_between(&die, 0.1, 9.0),
                          .energy = maybe(),
                          .left_J = dice_between(&die, -9.0, 9.0),
                          .part = dice_between(&die, 0.01, 1.0),
                          .compensated = maybe(),
                          .in_double = maybe(),
                          .in_both = maybe()};
        const double of_si = told[k].of_si;
        char wanted[TEXT] = "";
        char where[200] = "the terms that its slope is the small sum of";
        char *is = NULL;
        size_t size = 0;
        int at = 0;
        if (d.off <= 20.0 * last_place) {
            snprintf(where, sizeof where, "to %.2g %s where it is", of_si * last_place,
                     told[k].unit[primes]);
        }
        if (d.component >= 0) {
            at = snprintf(
                wanted, sizeof wanted,
                "whirl run: warning: few has too few digits for '%s%s': it rounds %s, which "
                "puts it up to %.2g %s off, %.2g %% of its range\n",
                told[k].name, primes > 0 ? "'" : "", where, of_si * d.off, told[k].unit[primes],
                100.0 * d.off / d.range);
        } else if (d.energy) {
            at =
                snprintf(wanted, sizeof wanted,
                         "whirl run: warning: float has too few digits for this run: rounding left "
                         "%.3g J of its energy over, %.2g of the largest entry of its books\n",
                         d.left_J, d.part);
        }
        if (at > 0) {
            char cure[100] = "";
            if (d.compensated && d.in_double) {
                strcpy(cure, "--compensated or --number double would do");
            } else if (d.compensated || d.in_double) {
                snprintf(cure, sizeof cure, "%s would do",
                         d.compensated ? "--compensated" : "--number double");
            } else if (d.energy && d.in_both) {
                strcpy(cure, "--number double --compensated would do");
            } else if (d.component < 0) {
                strcpy(cure, "more digits alone do not do: the step is too coarse, too");
            }
            snprintf(wanted + at, sizeof wanted - (size_t)at, "hint: %s%s%s\n", cure,
                     cure[0] != '\0' && d.component >= 0 ? "; " : "",
                     d.component < 0 ? ""
                                     : "coordinates whose origin is near to where they move need "
                                       "fewer digits");
        }
        const engine_kind few = {.name = "few"};
        FILE *out = open_memstream(&is, &size);
        digits_say(out, made.image, &few, &d);
        expect_text(wanted, out, &is);
    }
    derived_free(&made);
}

void suite_against_told(void) {
    die = dice_of("against_told", 93);
    RUN_TEST(test_what_is_not_believed);
    RUN_TEST(test_when_it_is_not_believed);
    RUN_TEST(test_too_few_digits);
}

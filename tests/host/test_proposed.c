/* test_proposed.c: what would do (host/run/advice.h), of findings that are made up about a run of two springs that is right: every
 * sentence whole, and the step that it names by closed form: that of a close look, or by the method's order. It does here, for
 * with it nothing is to be said; it cannot be tried where trying has taken all its time; and it does not where a run ends early. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/run/remedy.h"
#include "springs_told.h"
#include "unity.h"

void suite_proposed(void);

static dice die;

enum { TEXT = 1500 };

static bool maybe(void) { return dice_one_of(&die, 2) == 0; }

/* --- a singular place, and what happens at one go -----------------------------------------------------------------------*/

static watch_look drawn_look(const image *im, double step_s) {
    return (watch_look){.done = true,
                        .off = dice_between(&die, 0.004, 0.9),
                        .component = derived_component(im, maybe() ? "x" : "q", 0),
                        .resolved = dice_one_of(&die, 3) > 0,
                        .fine_step_s = step_s / (double)(4U << (2U * dice_one_of(&die, 3))),
                        .inertia = dice_between(&die, 1e-4, 0.1),
                        .singular = derived_component(im, maybe() ? "x" : "y", 1),
                        .singular_s = dice_between(&die, 0.0, 3.0),
                        .near = maybe() ? derived_component(im, maybe() ? "x" : "y", 0) : -1,
                        .near_at = dice_between(&die, -2.0, 2.0)};
}

/* That of a method of this order, where Runge-Kutta 4 resolves it in `fine_s`, or that one's where it would be 200 times as
 * fine; in float with compensated sums where it is ten times as fine. */
static void step_words(const springs *s, double fine_s, char word[100]) {
    char text[40];
    const double order = s->method == WH_HEUN ? 2.0 : 4.0;
    double step_s = springs_nice_s(s->step_s / pow(s->step_s / fine_s, 4.0 / order), text);
    const bool other = s->method == WH_HEUN && 200.0 * step_s <= s->step_s;
    step_s = other ? springs_nice_s(fine_s, text) : step_s;
    const bool sums = s->v->kind == &engine_float && 10.0 * step_s <= s->step_s;
    snprintf(word, 100, "%s--step %s%s", other ? "--method rk4 " : "", text,
             sums ? " --compensated" : "");
}

/* Small steps in float: with compensated sums, or where these are not enough in double. */
static void as_compensated(char *text, const char *step) {
    static const char in_double[] = " --number double";
    const char *compensated = strstr(step, " --compensated");
    compensated = compensated != NULL ? compensated : "";
    TEST_ASSERT_NOT_NULL(text);
    char *at = strstr(text, in_double);
    if (at != NULL) {
        memmove(at + strlen(compensated), at + strlen(in_double),
                strlen(at + strlen(in_double)) + 1);
        memcpy(at, compensated, strlen(compensated));
    }
}

static void test_singular_places(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(24, 8)); c++) {
        const double step_s = 0.001 * (double)(1U + dice_one_of(&die, 40));
        const engine_kind *kind = c % 3U == 0 ? &engine_float : &engine_double;
        springs s = springs_of(kind, c % 4U == 0 ? WH_HEUN : WH_RK4, step_s, 20, 1e-3);
        const image *im = s.d.image;
        const watch_look l = drawn_look(im, step_s);
        s.v->watch->singular = l;
        s.v->watch->singular.failed = c % 5U == 0;
        char wanted[TEXT];
        char step[100];
        char near[100] = "";
        char off[200];
        char *is = NULL;
        size_t size = 0;
        const bool near_x = l.near == derived_component(im, "x", 0);
        engine_kind failing;
        const trial t = springs_trial(&die, &s, &failing);
        step_words(&s, l.fine_step_s, step);
        if (l.near >= 0) {
            snprintf(near, sizeof near, ", nearest at %s = %.3g %s", near_x ? "x" : "y",
                     l.near_at * (near_x ? 1e2 : 1e3), near_x ? "cm" : "mm");
        }
        snprintf(off, sizeof off, "; the steps there put '%s' %.2g%s off",
                 im->unknown[image_component(im, l.component).unknown].name, l.off,
                 l.component == derived_component(im, "q", 0) ? " rad" : " of its range");
        if (c % 7U == 3) {
            s.v->watch->singular.component = -1;
            snprintf(off, sizeof off, "; the steps there put the rates %.2g %% off", 100.0 * l.off);
        }
        const bool failed = c % 5U == 0;
        const int at = snprintf(
            wanted, sizeof wanted,
            "%s: about t = %.6g s these coordinates are singular: the inertia of '%s' falls to %.2g of "
            "its largest%s%s\n",
            failed ? "hint" : "whirl run: warning", l.singular_s,
            l.singular == derived_component(im, "x", 1) ? "x" : "y", l.inertia, near,
            failed ? "" : off);
        if (l.resolved) {
            snprintf(
                wanted + at, sizeof wanted - (size_t)at,
                "hint: %s resolves it%s; coordinates that are not singular there need no smaller "
                "step\n",
                step,
                t == DOES        ? ""
                : t == NOT_TRIED ? " (not tried on all of the run: that takes long)"
                                 : " there, but is not all that it takes");
        }
        FILE *out = open_memstream(&is, &size);
        advice_say(out, &s.v->about);
        fclose(out);
        if (!l.resolved) { /* any step, not only a nice one */
            const char *hint = strstr(is, "\nhint: steps down to ");
            TEST_ASSERT_NOT_NULL_MESSAGE(hint, is);
            const char *from = hint + strlen("\nhint: steps down to ");
            char number[40];
            const char *rest = said_word(from, number, sizeof number);
            TEST_ASSERT_TRUE(fabs(said_step_s(number) / l.fine_step_s - 1.0) < 1e-9);
            TEST_ASSERT_EQUAL_STRING(
                " do not resolve it: take coordinates that are not singular there\n", rest);
            is[hint + 1 - is] = '\0';
        }
        as_compensated(is, step);
        TEST_ASSERT_EQUAL_STRING(wanted, is);
        free(is);
        /* and the balance's cure is that */
        char *cure = advice_cure(&s.v->about);
        if (l.resolved) {
            snprintf(wanted, sizeof wanted,
                     "these coordinates are singular about t = %.6g s; %s %s, or others",
                     l.singular_s, step, springs_done[t]);
            as_compensated(cure, step);
            TEST_ASSERT_EQUAL_STRING(wanted, cure);
        } else {
            TEST_ASSERT_NULL(cure);
        }
        free(cure);
        springs_end(&s);
    }
}

/* Where no motion explains what is missing and a look does. */
static void test_what_happens_at_one_go(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(24, 8)); c++) {
        const double step_s = 0.001 * (double)(1U + dice_one_of(&die, 40));
        springs s = springs_of(&engine_double, c % 4U == 0 ? WH_HEUN : WH_RK4, step_s, 20, 1e-3);
        watch_look l = drawn_look(s.d.image, step_s);
        char step[100];
        char wanted[TEXT];
        l.off = c % 3U == 2 ? 0.002 : l.off; /* which is resolved */
        s.v->watch->worst = l;
        s.v->balance.jump_s = dice_between(&die, 0.0, 1.0);
        s.v->balance.ratio = dice_between(&die, 0.05, 0.9);
        engine_kind failing;
        const trial t = springs_trial(&die, &s, &failing);
        step_words(&s, l.fine_step_s, step);
        char *cure = advice_cure(&s.v->about);
        if (l.off < 0.003 && t == FAILS) {
            TEST_ASSERT_NULL(cure);
        } else if (l.off < 0.003) {
            TEST_ASSERT_NOT_NULL(cure);
            (void)said_exactly(cure, "the step is too coarse for this motion; --");
        } else if (l.resolved) {
            snprintf(wanted, sizeof wanted,
                     "what happens about t = %.6g s is too fast for the step; %s %s",
                     s.v->balance.jump_s, step, springs_done[t]);
            TEST_ASSERT_EQUAL_STRING(wanted, cure);
        } else {
            TEST_ASSERT_NULL(cure);
        }
        free(cure);
        springs_end(&s);
    }
}

/* Beside it stands what tables may do, whatever the step would: twice the cells, if so many are to be had. */
static void expect_tables(springs *s, const char *cure) {
    image *im = s->d.image;
    char wanted[TEXT];
    const int cells[] = {0,
                         8,
                         (int)(10U + dice_one_of(&die, 400)),
                         IMAGE_CELLS_MOST / 2,
                         IMAGE_CELLS_MOST / 2 + 1,
                         IMAGE_CELLS_MOST};
    for (int i = 0; i < 6; i++) {
        char more[60] = "more --cells, or ";
        if (cells[i] > IMAGE_CELLS_MOST / 2) {
            more[0] = '\0';
        } else if (cells[i] > 0) {
            snprintf(more, sizeof more, "--cells %d, or ", 2 * cells[i]);
        }
        im->settings.tables = i % 2 == 0 ? TABLES_LINEAR : TABLES_CUBIC;
        im->settings.cells = cells[i];
        char *told = advice_cure(&s->v->about);
        snprintf(wanted, sizeof wanted,
                 "the tables may be too coarse (not tried): %sno --tables would tell%s%s", more,
                 cure != NULL ? "; if it is not they, " : "", cure != NULL ? cure : "");
        TEST_ASSERT_EQUAL_STRING(wanted, told);
        free(told);
    }
    im->settings.tables = TABLES_NONE;
    im->settings.cells = 0;
}

/* Nothing is found but that so much is missing: the step by the order's power; where a motion explains a part that counts, that
 * motion's. */
static void test_steps_by_order(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(24, 8)); c++) {
        const double step_s = 0.001 * (double)(1U + dice_one_of(&die, 40));
        const bool heun = c % 2U == 0;
        springs s = springs_of(&engine_double, heun ? WH_HEUN : WH_RK4, step_s, 20, 1e-3);
        const double ratio = exp(dice_between(&die, log(1e-3), log(2.0)));
        char word[40];
        s.v->balance.ratio = ratio;
        (void)springs_nice_s(step_s * pow(3e-5 / fmin(ratio, 1.0), heun ? 0.5 : 0.25), word);
        char *cure = advice_cure(&s.v->about);
        TEST_ASSERT_NOT_NULL(cure);
        (void)said_exactly(cure, "the step is too coarse for this motion; --");
        const char *named = strstr(cure, "--step ");
        TEST_ASSERT_NOT_NULL_MESSAGE(named, cure);
        TEST_ASSERT_EQUAL_STRING_LEN(word, named + strlen("--step "), strlen(word));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(cure, " would do"), cure);
        if (c < 4U) {
            expect_tables(&s, cure);
        }
        free(cure);
        s.v->balance.exact = c % 3U == 0;
        s.v->balance.saturated = c % 3U == 1;
        s.v->balance.slow = true;
        cure = advice_cure(&s.v->about);
        TEST_ASSERT_EQUAL(c % 3U == 2, cure != NULL);
        if (cure == NULL && c < 4U) {
            expect_tables(&s, NULL);
        }
        free(cure);
        springs_end(&s);
    }
}

/* --- finer than was proposed ------------------------------------------------------------------------------------------------*/

/* Runs that end early in steps longer than that. */
static double needs_s;
static double taken_s;

static void *start_picky(const image *im) {
    taken_s = im->step_s;
    return engine_double.start(im);
}

static wh_status step_picky(void *run) {
    return taken_s > needs_s * (1.0 + 1e-9) ? WH_E_DIVERGED : engine_double.step(run);
}

/* The next step of 1, 2 and 5 with which it does, in float with compensated sums from a tenth on. */
static void test_finer_until_it_does(void) {
    engine_kind picky = engine_double;
    picky.start = start_picky;
    picky.step = step_picky;
    for (unsigned c = 0; c < dice_cases(usual_or(24, 8)); c++) {
        const double step_s = 0.001 * (double)(1U + dice_one_of(&die, 40));
        const bool is_float = c % 2U == 0;
        springs s = springs_of(is_float ? &engine_float : &engine_double, WH_RK4, step_s, 20, 1e-3);
        char text[REMEDY_TEXT];
        char word[40];
        char wanted[100];
        watch_look l = drawn_look(s.d.image, step_s);
        l.fine_step_s = 0.25 * step_s;
        double named_s = springs_nice_s(l.fine_step_s, word);
        needs_s = named_s * exp(dice_between(&die, -5.0, 0.0));
        while (named_s > needs_s * (1.0 + 1e-9)) {
            named_s = springs_nice_s(0.7 * named_s, word);
        }
        s.v->about.cures.kind = &picky;
        const cure_outcome outcome =
            remedy_of_look(&s.v->about.judged, &s.v->about.cures, &l, text);
        TEST_ASSERT_EQUAL_INT(CURE_DOES, outcome);
        snprintf(wanted, sizeof wanted, "--step %s%s", word,
                 is_float && 10.0 * named_s <= step_s ? " --compensated" : "");
        TEST_ASSERT_EQUAL_STRING(wanted, text);
        springs_end(&s);
    }
}

void suite_proposed(void) {
    die = dice_of("proposed", 94);
    RUN_TEST(test_singular_places);
    RUN_TEST(test_what_happens_at_one_go);
    RUN_TEST(test_steps_by_order);
    RUN_TEST(test_finer_until_it_does);
}

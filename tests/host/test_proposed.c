/* test_proposed.c: what would do (host/run/advice.h), of findings that are made up about a run of two springs that is right: every
 * sentence whole, and the step that it names by closed form: that of a close look, or by the method's order. It does here, for
 * with it nothing is to be said; it cannot be tried where trying has taken all its time; and it does not where a run ends early. */
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "host/run/verdict.h"
#include "unity.h"

void suite_proposed(void);

static dice die;

enum { TEXT = 1500 };

static bool maybe(void) { return dice_one_of(&die, 2) == 0; }

/* 1, 2 or 5 times a power of ten, not beyond it, as it is written. */
static double nice_s(double most_s, char word[40]) {
    static const int leading[] = {5, 2, 1};
    for (long ns = 10000000000; ns > 0; ns /= 10) {
        for (int i = 0; i < 3; i++) {
            const long step_ns = ns * leading[i];
            if (1e-9 * (double)step_ns <= most_s * (1.0 + 1e-9)) {
                static const char *const units[] = {"ns", "us", "ms", "s"};
                int unit = 0;
                long count = step_ns;
                for (; count >= 1000 && unit < 3; count /= 1000) {
                    unit++;
                }
                snprintf(word, 40, "%ld%s", count, units[unit]);
                return 1e-9 * (double)step_ns;
            }
        }
    }
    TEST_FAIL_MESSAGE("too fine for this test");
    return 0.0;
}

static volatile sig_atomic_t stop_now; /* asked behind each step that is tried */

typedef struct springs {
    derived d;
    verdict *v;
    void *run;
    double step_s;
    int steps;
    wh_method method;
} springs;

/* Of 1 kg each, x with h w = `z`, y five times as slow; q turns evenly. */
static springs springs_of(const engine_kind *kind, wh_method method, double step_s, int steps,
                          double z) {
    char text[600];
    const double stiff = z * z / (step_s * step_s);
    snprintf(
        text, sizeof text,
        "mechanism m\ncoordinate q [deg]\ncoordinate y [mm]\ncoordinate x [cm]\n"
        "T = 1 [kg]*x'^2/2 + 1 [kg]*y'^2/2 + 1 [kg*m^2]*q'^2/2\n"
        "V = %.17g [N/m]*x^2/2 + %.17g [N/m]*y^2/2\n"
        "scene s { start x = 1 [m], y = 0.3 [m], q' = 2 [rad/s]; step %.9f [s]; until %.9f [s] }\n",
        stiff, stiff / 25.0, step_s, step_s * steps);
    springs s = {.d = derived_scene(text, "s"), .step_s = step_s, .steps = steps, .method = method};
    derived_expect(&s.d, text);
    s.d.image->settings.method = method;
    s.run = kind->start(s.d.image);
    s.v = verdict_open(s.d.image, kind);
    verdict_enter(s.v, s.run);
    for (int i = 0; i < steps; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, kind->step(s.run));
        verdict_enter(s.v, s.run);
    }
    stop_now = 0;
    verdict_end(s.v, s.run, false, &stop_now);
    return s;
}

static void springs_end(springs *s) {
    s->v->kind->stop(s->run);
    verdict_close(s->v);
    derived_free(&s->d);
}

/* A component of that name and so many primes. */
static int component_named(const image *im, const char *name, int primes) {
    for (int i = 0; i < im->angles + im->reals; i++) {
        const component c = image_component(im, i);
        if (c.primes == primes && strcmp(im->unknown[c.unknown].name, name) == 0) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE(name);
    return -1;
}

/* --- a singular place, and what happens at one go -----------------------------------------------------------------------*/

static watch_look drawn_look(const image *im, double step_s) {
    return (watch_look){.done = true,
                        .off = dice_between(&die, 0.004, 0.9),
                        .component = component_named(im, maybe() ? "x" : "q", 0),
                        .resolved = dice_one_of(&die, 3) > 0,
                        .fine_step_s = step_s / (double)(4U << (2U * dice_one_of(&die, 3))),
                        .inertia = dice_between(&die, 1e-4, 0.1),
                        .singular = component_named(im, maybe() ? "x" : "y", 1),
                        .singular_s = dice_between(&die, 0.0, 3.0),
                        .near = maybe() ? component_named(im, maybe() ? "x" : "y", 0) : -1,
                        .near_at = dice_between(&die, -2.0, 2.0)};
}

/* That of a method of this order, where Runge-Kutta 4 resolves it in `fine_s`, or that one's where it would be 200 times as
 * fine; in float with compensated sums where it is ten times as fine. */
static void step_words(const springs *s, double fine_s, char word[100]) {
    char text[40];
    const double order = s->method == WH_HEUN ? 2.0 : 4.0;
    double step_s = nice_s(s->step_s / pow(s->step_s / fine_s, 4.0 / order), text);
    const bool other = s->method == WH_HEUN && 200.0 * step_s <= s->step_s;
    step_s = other ? nice_s(fine_s, text) : step_s;
    const bool sums = s->v->kind == &engine_float && 10.0 * step_s <= s->step_s;
    snprintf(word, 100, "%s--step %s%s", other ? "--method rk4 " : "", text,
             sums ? " --compensated" : "");
}

/* What trying it comes to: it does, there is no time for it, or it ends early. */
typedef enum trial { DOES, NOT_TRIED, FAILS, TRIALS } trial;

static wh_status fail(void *run) {
    (void)run;
    return WH_E_DIVERGED;
}

static trial draw_trial(springs *s, engine_kind *failing) {
    const trial t = (trial)dice_one_of(&die, TRIALS);
    *failing = *s->v->kind;
    failing->step = fail;
    if (t == NOT_TRIED && maybe()) {
        stop_now = 1;
    } else if (t == NOT_TRIED) {
        s->v->about.cures.spent = 5e8;
    } else if (t == FAILS) {
        s->v->about.cures.kind = failing;
    }
    return t;
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

static const char *const done[TRIALS] = {"would do", "should do (not tried: that takes long)",
                                         "resolves that, but is not all that it takes"};

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
        const bool near_x = l.near == component_named(im, "x", 0);
        engine_kind failing;
        const trial t = draw_trial(&s, &failing);
        step_words(&s, l.fine_step_s, step);
        if (l.near >= 0) {
            snprintf(near, sizeof near, ", nearest at %s = %.3g %s", near_x ? "x" : "y",
                     l.near_at * (near_x ? 1e2 : 1e3), near_x ? "cm" : "mm");
        }
        snprintf(off, sizeof off, "; the steps there put '%s' %.2g%s off",
                 im->unknown[image_component(im, l.component).unknown].name, l.off,
                 l.component == component_named(im, "q", 0) ? " rad" : " of its range");
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
            l.singular == component_named(im, "x", 1) ? "x" : "y", l.inertia, near,
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
                     l.singular_s, step, done[t]);
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
        const trial t = draw_trial(&s, &failing);
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
                     s.v->balance.jump_s, step, done[t]);
            TEST_ASSERT_EQUAL_STRING(wanted, cure);
        } else {
            TEST_ASSERT_NULL(cure);
        }
        free(cure);
        springs_end(&s);
    }
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
        (void)nice_s(step_s * pow(3e-5 / fmin(ratio, 1.0), heun ? 0.5 : 0.25), word);
        char *cure = advice_cure(&s.v->about);
        TEST_ASSERT_NOT_NULL(cure);
        (void)said_exactly(cure, "the step is too coarse for this motion; --");
        const char *named = strstr(cure, "--step ");
        TEST_ASSERT_NOT_NULL_MESSAGE(named, cure);
        TEST_ASSERT_EQUAL_STRING_LEN(word, named + strlen("--step "), strlen(word));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(cure, " would do"), cure);
        free(cure);
        s.v->balance.exact = c % 3U == 0;
        s.v->balance.saturated = c % 3U == 1;
        s.v->balance.slow = true;
        cure = advice_cure(&s.v->about);
        TEST_ASSERT_EQUAL(c % 3U == 2, cure != NULL);
        free(cure);
        springs_end(&s);
    }
}

/* --- of a motion ----------------------------------------------------------------------------------------------------------*/

/* How much of an oscillator's amplitude steps take or give over a time, of what they have at w h. */
static double lost_by(wh_method method, double w, double step_s, double span_s) {
    const double z = w * step_s;
    const double growth_2 =
        method == WH_HEUN ? 1.0 + pow(z, 4) / 4.0 : 1.0 - pow(z, 6) / 72.0 + pow(z, 8) / 576.0;
    return fabs(pow(growth_2, 0.5 * span_s / step_s) - 1.0);
}

/* The largest nice step, not beyond it, at which no more than that is lost of the energy. */
static void nice_words(const springs *s, double w, double most_s, double share, double allowed,
                       char word[40]) {
    double step_s = nice_s(most_s, word);
    while (2.0 * share * lost_by(s->method, w, step_s, s->steps * s->step_s) > allowed) {
        step_s = nice_s(0.7 * step_s, word);
    }
}

static const char *title_of(const springs *s) {
    return s->method == WH_HEUN ? "Heun" : "Runge-Kutta 4";
}

/* Of a run that failed: the first motion that grows, or that is off; else none. */
static void test_failed_runs(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(32, 12)); c++) {
        const double step_s = 0.001 * (double)(1U + dice_one_of(&die, 40));
        const unsigned kind = c % 4U; /* what becomes of the motion */
        const double z = kind == 0   ? dice_between(&die, 2.95, 3.4)
                         : kind == 1 ? dice_between(&die, 0.4, 0.9)
                         : kind == 2 ? dice_between(&die, 0.9, 1.3)
                                     : 1e-3;
        springs s = springs_of(&engine_double, kind == 1 ? WH_HEUN : WH_RK4, step_s, 20, z);
        engine_kind failing;
        char step[40];
        char cure[100] = "";
        char wanted[TEXT];
        char *is = NULL;
        size_t size = 0;
        const trial t = draw_trial(&s, &failing);
        const double w = z / step_s;
        s.v->watch->singular.done = false;
        nice_words(&s, w, step_s, 1.0, 3e-6, step);
        if (t != FAILS) {
            snprintf(cure, sizeof cure, "%s--step %s %s", kind == 3 ? "" : "; ", step, done[t]);
        }
        int at =
            snprintf(wanted, sizeof wanted,
                     "hint: a smaller --step may carry it further; if it fails at the same time, "
                     "look for a singular position there\n");
        const size_t left = sizeof wanted - (size_t)at;
        char carried[200];
        snprintf(carried, sizeof carried,
                 "'x' about t = 0 s: %.3g rad/s (a period of %.3g s), h w = %.3g", w,
                 2.0 * 3.14159265358979323846 / w, z);
        if (kind == 0) {
            snprintf(wanted + at, left,
                     "hint: %s is more than Runge-Kutta 4 carries (2.83 in this direction)%s\n",
                     carried, cure);
        } else if (kind == 1) {
            snprintf(wanted + at, left,
                     "hint: %s: Heun lets such a motion grow at any step, less at a finer one%s\n",
                     carried, cure);
        } else if (kind == 2) {
            snprintf(wanted + at, left, "hint: the step is too coarse for %s%s\n", carried, cure);
        } else if (t != FAILS) {
            snprintf(wanted + at, left, "hint: %s\n", cure);
        }
        FILE *out = open_memstream(&is, &size);
        advice_say_diverged(out, &s.v->about);
        fclose(out);
        char *other = kind == 3 ? strstr(is, ", or --method ") : NULL;
        if (other != NULL) { /* which does as well */
            strcpy(other, "\n");
        }
        TEST_ASSERT_EQUAL_STRING(wanted, is);
        free(is);
        springs_end(&s);
    }
}

/* A motion that explains what is missing has its own step, one that explains a part of it that of the order as well; less is no
 * cause. */
static void test_a_part_of_what_is_missing(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(32, 12)); c++) {
        const double step_s = 0.001 * (double)(1U + dice_one_of(&die, 40));
        const double z = dice_between(&die, 0.35, 0.5);
        springs s = springs_of(&engine_double, WH_RK4, step_s, 20, z);
        const linear_motion *m = judged_motions(&s.v->about.judged)->worst;
        const double w = z / step_s;
        const double part = exp(dice_between(&die, log(0.04), log(0.9)));
        const double lost = lost_by(WH_RK4, w, step_s, 20.0 * step_s);
        const double ratio = 2.0 * m->share * lost / part;
        char step[40];
        char wanted[TEXT];
        TEST_ASSERT_TRUE(m->share > 0.5 && ratio < 0.3);
        if (fabs(part - 0.3) < 1e-3 || fabs(part - 0.1) < 1e-3) {
            springs_end(&s);
            continue;
        }
        s.v->balance.ratio = ratio;
        s.v->watch->balanced = false; /* nothing on the way */
        nice_words(&s, w, part > 0.3 ? step_s : step_s * pow(3e-5 / ratio, 0.25), m->share, 3e-5,
                   step);
        char *cure = advice_cure(&s.v->about);
        TEST_ASSERT_NOT_NULL(cure);
        if (part < 0.1) {
            strcpy(wanted, "the step is too coarse for this motion; --");
        } else {
            snprintf(
                wanted, sizeof wanted,
                "the step is too coarse for 'x' about t = %.6g s: %.3g rad/s (a period of %.3g "
                "s), h w = %.3g; %s takes %.3g %% of its energy over the run; --",
                m->time_s, w, 2.0 * 3.14159265358979323846 / w, z, title_of(&s),
                100.0 * (1.0 - (1.0 - lost) * (1.0 - lost)));
        }
        (void)said_exactly(cure, wanted);
        const char *named = strstr(cure, "--step ");
        TEST_ASSERT_NOT_NULL_MESSAGE(named, cure);
        TEST_ASSERT_EQUAL_STRING_LEN(step, named + strlen("--step "), strlen(step));
        free(cure);
        springs_end(&s);
    }
}

void suite_proposed(void) {
    die = dice_of("proposed", 94);
    RUN_TEST(test_singular_places);
    RUN_TEST(test_what_happens_at_one_go);
    RUN_TEST(test_steps_by_order);
    RUN_TEST(test_failed_runs);
    RUN_TEST(test_a_part_of_what_is_missing);
}

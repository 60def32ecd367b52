/* test_remedied.c: what would do for motions that a step is too coarse for (host/run/advice.h, remedy.h), of two springs: which motion
 * is told and as what, which step and which method, by closed form and by what the methods' rows leave of it; tried, not tried
 * and failing. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/run/remedy.h"
#include "host/run/step_text.h"
#include "springs_told.h"
#include "unity.h"

void suite_remedied(void);

static dice die;

enum { TEXT = 1500 };

/* --- of a motion ----------------------------------------------------------------------------------------------------------*/

static const char *title_of(const springs *s) {
    return s->method == WH_HEUN ? "Heun" : "Runge-Kutta 4";
}

/* Of a run that failed: the first motion that grows, or that is off; else none. */
static void test_failed_runs(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(32, 12)); c++) {
        const double step_s = 0.001 * (double)(1U + dice_one_of(&die, 40));
        const unsigned kind = c % 4U; /* what becomes of the motion */
        const double z = kind == 0   ? dice_between(&die, 2.95, 3.4)
                         : kind == 1 ? dice_between(&die, 0.4, 0.6)
                         : kind == 2 ? dice_between(&die, 0.9, 1.3)
                                     : 1e-3;
        springs s = springs_of(&engine_double, kind == 1 ? WH_HEUN : WH_RK4, step_s, 20, z);
        engine_kind failing;
        char step[40];
        char cure[100] = "";
        char wanted[TEXT];
        char *is = NULL;
        size_t size = 0;
        const trial t = springs_trial(&die, &s, &failing);
        const double w = z / step_s;
        s.v->watch->singular.done = false;
        springs_nice_words(&s, w, step_s, 1.0, 3e-6, step);
        if (t != FAILS) {
            snprintf(cure, sizeof cure, "%s--step %s %s", kind == 3 ? "" : "; ", step,
                     springs_done[t]);
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
        TEST_ASSERT_NOT_NULL(m);
        const double w = z / step_s;
        const double part = exp(dice_between(&die, log(0.04), log(0.9)));
        const double lost = springs_lost_by(WH_RK4, w, step_s, 20.0 * step_s);
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
        springs_nice_words(&s, w, part > 0.3 ? step_s : step_s * pow(3e-5 / ratio, 0.25), m->share,
                           3e-5, step);
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

/* --- methods and steps ----------------------------------------------------------------------------------------------------*/

/* Of a higher order, with the fewest stages, that leaves no more than that at the same step; -1: none. */
static int better_method(const springs *s, double allowed) {
    const linearised *l = judged_motions(&s->v->about.judged);
    int found = -1;
    for (int m = WH_METHODS - 1; m >= 0; m--) {
        const bool takes =
            wh_method_takes((wh_method)m, l->form) && wh_methods[m].takes != WH_NO_RATES;
        if (takes && wh_methods[m].order > wh_methods[s->method].order &&
            linearised_off(l, (wh_method)m, s->step_s) <= allowed &&
            (found < 0 || wh_methods[m].stages <= wh_methods[found].stages)) {
            found = m;
        }
    }
    return found;
}

/* A better method, and a finer step of the own one: which is named first is which takes less, five to one. */
static void test_methods_and_steps(void) {
    unsigned named[4] = {0};
    for (unsigned c = 0; c < dice_cases(usual_or(48, 16)); c++) {
        const double step_s = 0.001 * (double)(1U + dice_one_of(&die, 40));
        const wh_method own = c % 3U == 0 ? WH_RK4 : WH_HEUN;
        const double z = own == WH_RK4 ? dice_between(&die, 0.1, 0.5)
                                       : exp(dice_between(&die, log(0.01), log(0.4)));
        springs s = springs_of(&engine_double, own, step_s, 20, z);
        engine_kind failing;
        char wanted[REMEDY_TEXT];
        char text[REMEDY_TEXT];
        char step[40];
        const trial t = springs_trial(&die, &s, &failing);
        const bool saturated = dice_one_of(&die, 2) == 0;
        const double allowed = saturated ? 3e-6 : 3e-5;
        const linear_motion *m = judged_motions(&s.v->about.judged)->worst;
        TEST_ASSERT_NOT_NULL(m);
        const double named_s = springs_nice_words(&s, z / step_s, step_s, m->share, allowed, step);
        const int method = better_method(&s, allowed);
        const bool told =
            remedy_text(&s.v->about.judged, &s.v->about.cures, step_s, saturated, text);
        const char *word = method >= 0 ? wh_methods[method].word : "";
        if (t == FAILS) {
            strcpy(wanted, "");
        } else if (method < 0) {
            snprintf(wanted, sizeof wanted, "--step %s %s", step, springs_done[t]);
        } else if (t == DOES &&
                   5.0 * wh_methods[method].stages * named_s < wh_methods[own].stages * step_s) {
            snprintf(wanted, sizeof wanted, "--method %s would do, or --step %s", word, step);
            named[0]++;
        } else {
            snprintf(wanted, sizeof wanted, "--step %s %s, or --method %s%s", step, springs_done[t],
                     word, t == DOES ? "" : " (not tried)");
            named[t == DOES ? 1 : 2]++;
        }
        TEST_ASSERT_EQUAL_STRING(wanted, text);
        TEST_ASSERT_EQUAL(wanted[0] != '\0', told);
        named[3] += method < 0 ? 1U : 0U;
        springs_end(&s);
    }
    TEST_ASSERT_TRUE(named[0] + named[1] + named[2] > 0 && named[3] > 0);
}

/* Steps as they are named: read back to 14 digits, in the largest unit that they are not below; of less than a nanosecond,
 * in nanoseconds. */
static void test_steps_are_read_back(void) {
    static const char *const unit[] = {"s", "ms", "us", "ns"};
    for (unsigned c = 0; c < dice_cases(400); c++) {
        char text[STEP_WORD];
        char *end;
        const int wanted = (int)(c % 4U);
        const double size = pow(10.0, -3.0 * wanted);
        const double most = wanted == 0 ? 1e6 : 998.0;
        const double least = wanted == 3 ? 1e-9 : 1.0;
        const double number = least * pow(most / least, dice_between(&die, 0.0, 1.0));
        TEST_ASSERT_EQUAL_PTR(text, step_text(number * size, text));
        const double back = strtod(text, &end);
        TEST_ASSERT_EQUAL_STRING(unit[wanted], end);
        TEST_ASSERT_TRUE(fabs(back / number - 1.0) <= 2e-14);
    }
}

void suite_remedied(void) {
    die = dice_of("remedied", 96);
    RUN_TEST(test_failed_runs);
    RUN_TEST(test_a_part_of_what_is_missing);
    RUN_TEST(test_methods_and_steps);
    RUN_TEST(test_steps_are_read_back);
}

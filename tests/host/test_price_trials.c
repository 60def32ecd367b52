/* test_price_trials.c: trials of settings (host/study/trial.h): steps as exact fractions, the worst and the
 * dearest of several places against each place by itself. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/fixed/engine_fixed.h"
#include "priced.h"
#include "unity.h"

void suite_price_trials(void);

/* --- steps and times -----------------------------------------------------------------------------------*/

typedef unsigned __int128 wide;

/* By subtracting: the exact quotients' remainders take no part. */
static bool have_no_divisor(uint64_t a, uint64_t b) {
    while (a != b && a != 0 && b != 0) {
        while (a > b && b != 0) {
            const uint64_t times = a / b;
            a -= times > 1 ? (times - 1) * b : b;
        }
        while (b > a && a != 0) {
            const uint64_t times = b / a;
            b -= times > 1 ? (times - 1) * a : a;
        }
    }
    return (a > b ? a : b) == 1;
}

static uint64_t drawn_up_to(dice *d, unsigned bits) {
    return 1 + ((uint64_t)dice_one_of(d, 1U << 30U) << 30U | dice_one_of(d, 1U << 30U)) %
                   ((UINT64_C(1) << (1U + dice_one_of(d, bits))) - 1U);
}

/* spacing * records / steps, in lowest terms; or as near as a double where 64 bits do not hold it. */
static void test_steps_are_exact(void) {
    dice d = dice_of("price_trials steps", 11);
    int exact = 0;
    int rounded = 0;
    for (unsigned n = 0; n < dice_cases(few_or_all(3000, 300000)); n++) {
        trials t = {.wish.spacing = {drawn_up_to(&d, 50), drawn_up_to(&d, 59)}};
        const deviation_pace pace =
            dice_one_of(&d, 2) == 0 ? (deviation_pace){1, drawn_up_to(&d, 30)}
                                    : (deviation_pace){drawn_up_to(&d, n % 2 == 0 ? 10 : 40), 1};
        const whole_ratio s = t.wish.spacing;
        if (!have_no_divisor(s.numerator, s.denominator)) {
            continue;
        }
        const wide left = (wide)s.numerator * pace.records;
        const wide right = (wide)s.denominator * pace.steps;
        const bool fits = left >> 64U == 0 && right >> 64U == 0;
        const double value = (double)left / (double)right;
        if (value < 1e-12 || value > 1e12) {
            continue; /* no step */
        }
        const whole_ratio step = trial_step(&t, pace);
        if (fits) {
            TEST_ASSERT_TRUE(left % step.numerator == 0 && right % step.denominator == 0 &&
                             left / step.numerator == right / step.denominator);
            TEST_ASSERT_TRUE(have_no_divisor(step.numerator, step.denominator));
            exact++;
        } else {
            rounded++;
        }
        TEST_ASSERT_TRUE(fabs(ratio_times(1, step) / value - 1.0) < 1e-14);
    }
    printf("  %d steps exact, %d that may be rounded\n", exact, rounded);
    TEST_ASSERT_TRUE(exact > 300 && rounded > 30);
}

/* As a user would write it: no shorter number is the same fraction. */
static void test_times_have_as_few_digits_as_they_can(void) {
    dice d = dice_of("price_trials times", 12);
    for (unsigned n = 0; n < dice_cases(few_or_all(400, 100000)); n++) {
        const double value = (double)(1 + dice_one_of(&d, 500)) /
                             (double)(1 + dice_one_of(&d, n % 2 == 0 ? 40 : 99999));
        const whole_ratio time = ratio_of(value);
        char text[TRIAL_TIME];
        char shorter[TRIAL_TIME];
        TEST_ASSERT_EQUAL_PTR(text, trial_time(time, text));
        const whole_ratio back = ratio_of(strtod(text, NULL));
        TEST_ASSERT_EQUAL_UINT64(time.numerator, back.numerator);
        TEST_ASSERT_EQUAL_UINT64(time.denominator, back.denominator);
        int digits = 0;
        while (digits < 17) {
            digits++;
            snprintf(shorter, sizeof shorter, "%.*g", digits, value);
            const whole_ratio other = ratio_of(strtod(shorter, NULL));
            if (other.numerator == time.numerator && other.denominator == time.denominator) {
                break;
            }
        }
        TEST_ASSERT_EQUAL_STRING(shorter, text);
    }
}

/* --- scenes ----------------------------------------------------------------------------------------------*/

/* A spring and a pendulum, shown in mm and degrees, that differ in their numbers and in what a step computes. */
static const char *const places[] = {
    "mechanism m\ncoordinate x [mm]\ncoordinate a [deg]\noutput twice [mm] = 2*x\n"
    "output heard [mm] = x\nnoise heard deviation 1 [mm] seed 1\n"
    "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\nV = 9 [N/m]*x^2/2 - 8 [J]*cos(a)\n"
    "scene s { start x = 100 [mm], a = 60 [deg]; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\ncoordinate x [mm]\ncoordinate a [deg]\noutput twice [mm] = 2*x\n"
    "output heard [mm] = x\nnoise heard deviation 1 [mm] seed 1\n"
    "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\n"
    "V = 90 [N/m]*x^2/2 + 900 [N/m^3]*x^4/4 + 3 [N/m^2]*x^3 - 20 [J]*cos(a)\n"
    "scene s { start x = 100 [mm], a = 60 [deg]; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\ncoordinate x [mm]\ncoordinate a [deg]\noutput twice [mm] = 2*x\n"
    "output heard [mm] = x\nnoise heard deviation 1 [mm] seed 1\n"
    "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\nV = 30 [N/m]*x^2/2 - 4 [J]*cos(a)\n"
    "scene s { start x = 20 [mm], a = 60 [deg]; step 1 [ms]; until 1 [s] }\n"};
static const whole_ratio spacing = {1, 50};
enum { RECORDS = 25 };

static void test_operations_are_those_of_all_places(void) {
    priced p;
    priced_open(&p, places, 3);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
    const double each = p.trial.image[0]->list[IMAGE_STEP]->count + 1.0;
    const setting rk4 = priced_setting(WH_RK4, &engine_float);
    const setting heun = priced_setting(WH_HEUN, &engine_float);
    const setting in_fixed = priced_setting(WH_RK4, &engine_fixed);
    const deviation_pace fine = {7, 1};
    const deviation_pace coarse = {1, 5};
    TEST_ASSERT_TRUE(trial_operations(&p.trial, &rk4, fine) == 25.0 * 7.0 * each * 4.0 * 3.0);
    TEST_ASSERT_TRUE(trial_operations(&p.trial, &heun, coarse) == 5.0 * each * 2.0 * 3.0);
    TEST_ASSERT_TRUE(trial_operations(&p.trial, &in_fixed, coarse) == 2 * 5.0 * each * 4.0 * 3.0);
    TEST_ASSERT_TRUE(fabs(trial_horizon_s(&p.trial) - 0.5) < 1e-15);
    char text[TRIAL_TIME];
    TEST_ASSERT_EQUAL_STRING("0.5", trial_until(&p.trial, text));
    const double most = trial_operations(&p.trial, &in_fixed, fine);
    TEST_ASSERT_FALSE(trial_is_slow_to_plan(&p.trial, &in_fixed, fine)); /* any */
    p.trial.planned_most = most;
    TEST_ASSERT_FALSE(trial_is_slow_to_plan(&p.trial, &in_fixed, fine));
    p.trial.planned_most = most * 0.999;
    TEST_ASSERT_TRUE(trial_is_slow_to_plan(&p.trial, &in_fixed, fine));
    p.trial.planned_most = 1.0;
    TEST_ASSERT_FALSE(trial_is_slow_to_plan(&p.trial, &rk4, fine)); /* looks for no ranges */
    p.trial.planned_most = -1.0;
    TEST_ASSERT_FALSE(trial_is_slow_to_plan(&p.trial, &in_fixed, fine));
    bool own = false;
    p.trial.planned_most = 1.0;
    const int asked = p.asked;
    const cost c = trial_any_cost(&p.trial, &in_fixed, fine, &own);
    TEST_ASSERT_TRUE(own && c.instructions.basis == COST_NOT_KNOWN && asked == p.asked);
    TEST_ASSERT_NOT_NULL(strstr(c.why, "--effort"));
    priced_close(&p);
}

/* --- which component ------------------------------------------------------------------------------------*/

static void test_errors_have_the_unit_of_what_is_asked(void) {
    static const struct {
        const char *of;
        const char *unit;
        double si; /* an error of 1 */
    } rows[] = {{NULL, "", 1.0},       {"x", "mm", 1e-3},
                {"x'", "mm/s", 1e-3},  {"a", "deg", 0.017453292519943295},
                {"twice", "mm", 1e-3}, {"a'", "deg/s", 0.017453292519943295}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        priced p;
        priced_open(&p, places, 1);
        TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, rows[i].of));
        TEST_ASSERT_EQUAL_STRING(rows[i].unit, trial_unit(&p.trial));
        TEST_ASSERT_TRUE(fabs(trial_error_si(&p.trial, 3.0) / (3.0 * rows[i].si) - 1.0) < 1e-14);
        TEST_ASSERT_TRUE(p.trial.what.give_up == 1.0);
        TEST_ASSERT_EQUAL_INT(rows[i].of == NULL, p.trial.what.column < 0);
        if (rows[i].of != NULL) {
            char text[TRIAL_NAME];
            TEST_ASSERT_EQUAL_STRING(rows[i].of, trial_column(&p.trial, p.trial.what.column, text));
        }
        priced_close(&p);
    }
}

static int begin_of(int count, char **words) {
    (void)count;
    priced p;
    priced_open(&p, places, 2);
    const int status = priced_begin(&p, "mps2-an386", spacing, RECORDS, words[0]) ? 0 : 3;
    priced_close(&p);
    return status;
}

static void test_what_is_no_component_is_told(void) {
    said what;
    command_say(begin_of, (const char *const[]){"twise", NULL}, &what);
    TEST_ASSERT_EQUAL_INT(3, what.status);
    TEST_ASSERT_EQUAL_STRING("whirl: error: twise is no output, coordinate or rate of 's'\n"
                             "hint: did you mean 'twice'?\n",
                             what.err);
    command_say(begin_of, (const char *const[]){"x''", NULL}, &what);
    TEST_ASSERT_EQUAL_INT(3, what.status);
    TEST_ASSERT_NOT_NULL(strstr(what.err, "error: x'' is no output"));
    command_say(begin_of, (const char *const[]){"zzzzzzzzzz", NULL}, &what);
    TEST_ASSERT_EQUAL_INT(3, what.status);
    TEST_ASSERT_NULL(strstr(what.err, "hint"));
    command_say(begin_of, (const char *const[]){"heard", NULL}, &what);
    TEST_ASSERT_EQUAL_INT(3, what.status);
    TEST_ASSERT_NOT_NULL(strstr(what.err, "error: heard has noise of its own"));
    command_say(begin_of, (const char *const[]){"a'", NULL}, &what);
    TEST_ASSERT_EQUAL_INT(said_owes(what.err), what.status);
    TEST_ASSERT_EQUAL_STRING("", what.err);
}

/* --- the horizon -----------------------------------------------------------------------------------------*/

/* y' = y^2 from y(0) is over at 1/y(0): all places end where the first does. */
static void test_the_horizon_is_that_of_the_place_that_ends_first(void) {
    static const double from[] = {0.5, 1.25, 0.8};
    for (int turn = 0; turn < 3; turn++) {
        char text[3][200];
        const char *texts[3];
        for (int k = 0; k < 3; k++) {
            snprintf(text[k], sizeof text[k],
                     "mechanism m\nstate y\nequation y' - 1 [1/s]*y^2 = 0 [1/s]\n"
                     "scene s { start y = %g; step 1 [ms]; until 3 [s] }\n",
                     from[(k + turn) % 3]);
            texts[k] = text[k];
        }
        priced p;
        priced_open(&p, texts, 3);
        TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, 150, NULL));
        TEST_ASSERT_TRUE(p.trial.reliable);
        TEST_ASSERT_EQUAL_INT((4 - turn) % 3, p.trial.worst);
        /* 0.8 s: the pole itself is record 40 */
        TEST_ASSERT_TRUE(p.trial.records >= 37 && p.trial.records < 40);
        for (int k = 0; k < 3; k++) {
            TEST_ASSERT_EQUAL_INT(p.trial.records, p.trial.reference[k]->records);
        }
        priced_close(&p);
    }
}

/* Places where nothing moves are left out; if nothing moves at all, that is the report. */
static void test_places_where_nothing_moves_are_left_out(void) {
    static const char *const texts[] = {"mechanism m\nstate y\nequation y' + 1 [1/s]*y = 0 [1/s]\n"
                                        "scene s { start y = 1; step 1 [ms]; until 1 [s] }\n",
                                        "mechanism m\nstate y\nequation y' + 1 [1/s]*y = 0 [1/s]\n"
                                        "scene s { start y = 0; step 1 [ms]; until 1 [s] }\n"};
    for (unsigned still = 0; still < 8; still++) {
        const char *chosen[3];
        char left_out[80] = "";
        int moving = 0;
        int moved[3];
        for (int k = 0; k < 3; k++) {
            const unsigned rests = still >> (unsigned)k & 1U;
            chosen[k] = texts[rests];
            moved[moving] = k;
            moving += rests == 0;
            if (rests != 0) {
                snprintf(left_out + strlen(left_out), sizeof left_out - strlen(left_out),
                         " --set place=%d,", k);
            }
        }
        priced p;
        priced_open(&p, chosen, 3);
        TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
        TEST_ASSERT_EQUAL_INT(moving == 0 ? 3 : moving, p.trial.points);
        TEST_ASSERT_TRUE(p.trial.reliable == (moving > 0));
        for (int k = 0; k < moving; k++) {
            char name[20];
            snprintf(name, sizeof name, " --set place=%d", moved[k]);
            TEST_ASSERT_EQUAL_STRING(name, trial_place(&p.trial, k));
        }
        if (moving == 0 || moving == 3) {
            TEST_ASSERT_NULL(p.trial.still);
        } else {
            TEST_ASSERT_EQUAL_STRING(left_out, p.trial.still);
        }
        const setting rk4 = priced_setting(WH_RK4, &engine_double);
        TEST_ASSERT_TRUE(moving == 0 || trial_run(&p.trial, &rk4, (deviation_pace){1, 1}).usable);
        priced_close(&p);
    }
}

static void test_of_places_as_long_the_worst_agrees_least(void) {
    priced p;
    priced_open(&p, places, 3);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, NULL));
    TEST_ASSERT_EQUAL_INT(RECORDS, p.trial.records);
    TEST_ASSERT_TRUE(p.trial.reliable && !p.trial.stopped);
    for (int k = 0; k < 3; k++) {
        TEST_ASSERT_TRUE(reference_agreement(p.trial.reference[k]) <=
                         reference_agreement(p.trial.reference[p.trial.worst]));
    }
    priced_close(&p);
}

/* --- errors ----------------------------------------------------------------------------------------------*/

/* The same of each place by itself. */
static trial_result each_by_itself(priced *p, const setting *s, deviation_pace pace,
                                   double tolerated, int *looked_at) {
    trial_result r = {.ran = true, .usable = true, .error = -1.0};
    for (int k = 0; k < 3 && r.usable; k++) {
        const reference *ref = p->trial.reference[k];
        *looked_at = k + 1;
        char step[TRIAL_TIME];
        image *im = priced_image(p, k, s, trial_time(trial_step(&p->trial, pace), step));
        deviation_of_what what = {p->trial.what.column, 1.0};
        if (what.column >= 0) {
            what.give_up = fmax(tolerated, (double)ref->column[what.column].largest);
        }
        const deviation d = deviation_measure(ref, im, s->number, pace, what);
        image_free(im);
        const double error = d.error < 3.0 * d.known ? d.error + d.known : d.error;
        if (error > r.error || !(error <= r.error)) {
            r.error = error;
            r.bound = d.error < 3.0 * d.known;
            r.point = k;
            r.column = d.column;
        }
        r.evaluations = fmax(r.evaluations, d.evaluations);
        r.evaluations_most = fmax(r.evaluations_most, d.evaluations_most);
        r.usable = d.usable;
    }
    return r;
}

static void test_errors_are_the_worst_of_all_places(void) {
    static const wh_method methods[] = {WH_EULER, WH_HEUN, WH_RK4, WH_LEAPFROG};
    static const char *const of[] = {NULL, "x", "a'"};
    dice d = dice_of("price_trials errors", 13);
    int usable = 0;
    int useless = 0;
    int bounds = 0;
    int at[3] = {0};
    for (int n = 0; n < 3; n++) {
        priced p;
        priced_open(&p, places, 3);
        TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing, RECORDS, of[n]));
        for (unsigned i = 0; i < dice_cases(few_or_all(24, 400)); i++) {
            const setting s =
                priced_setting(methods[dice_one_of(&d, 4)],
                               dice_one_of(&d, 2) == 0 ? &engine_float : &engine_double);
            const deviation_pace pace = {1, i % 3 == 0 ? 5 : 1};
            /* references that know their columns less well than they do */
            for (int k = 0; k < 3; k++) {
                reference *r = p.trial.reference[k];
                for (int c = 1; c < r->columns; c++) {
                    r->column[c].off =
                        r->column[c].largest * (long double)pow(10.0, dice_between(&d, -9, -1));
                }
            }
            p.trial.tolerated = dice_one_of(&d, 2) == 0 ? 0.0 : 1e4;
            const double before = p.trial.operations;
            const int asked = p.asked;
            int looked_at;
            const trial_result r = trial_run(&p.trial, &s, pace);
            const trial_result want = each_by_itself(&p, &s, pace, p.trial.tolerated, &looked_at);
            TEST_ASSERT_EQUAL_INT(looked_at, p.asked - asked); /* none behind one of no use */
            TEST_ASSERT_TRUE(r.ran && r.usable == want.usable && r.bound == want.bound);
            TEST_ASSERT_TRUE(r.error == want.error && r.point == want.point);
            TEST_ASSERT_TRUE(r.column == want.column && r.evaluations == want.evaluations);
            TEST_ASSERT_TRUE(r.evaluations_most == want.evaluations_most);
            TEST_ASSERT_TRUE(p.trial.operations > before);
            usable += r.usable;
            useless += !r.usable;
            bounds += r.bound;
            at[r.point]++;
        }
        priced_close(&p);
    }
    printf("  %d of use, %d of none, %d bounds; worst at %d, %d, %d\n", usable, useless, bounds,
           at[0], at[1], at[2]);
    TEST_ASSERT_TRUE(usable > 0 && useless > 0 && bounds > 0 && at[0] > 0 && at[1] > 0 &&
                     at[2] > 0);
}

void suite_price_trials(void) {
    RUN_TEST(test_steps_are_exact);
    RUN_TEST(test_times_have_as_few_digits_as_they_can);
    RUN_TEST(test_operations_are_those_of_all_places);
    RUN_TEST(test_errors_have_the_unit_of_what_is_asked);
    RUN_TEST(test_what_is_no_component_is_told);
    RUN_TEST(test_the_horizon_is_that_of_the_place_that_ends_first);
    RUN_TEST(test_places_where_nothing_moves_are_left_out);
    RUN_TEST(test_of_places_as_long_the_worst_agrees_least);
    RUN_TEST(test_errors_are_the_worst_of_all_places);
}

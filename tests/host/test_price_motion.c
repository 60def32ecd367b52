/* test_price_motion.c: what runs are held against (host/study/extrapolation.h, reference_run.h) by closed forms and by their
 * order, and how far off it runs are (deviation.h) by a loop of its own. tests/host/test_price_reference.c asks the same of
 * long motions. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "command.h"
#include "derived.h"
#include "host/base/interrupts.h"
#include "host/study/deviation.h"
#include "host/study/extrapolation.h"
#include "host/study/long_list.h"
#include "host/study/reference_run.h"
#include "unity.h"

void suite_price_motion(void);

static const char *const spring =
    "mechanism m\ncoordinate x [mm]\noutput twice [mm] = 2*x\nT = 1 [kg]*x'^2/2\n"
    "V = 16 [N/m]*x^2/2\nscene s { start x = 250 [mm]; step 10 [ms]; until 1 [s] }\n";

static derived decay_of(double rate, double start) {
    char text[300];
    snprintf(text, sizeof text,
             "mechanism m\nstate y\nequation y' + %.17g [1/s]*y = 0 [1/s]\n"
             "scene s { start y = %.17g; step 1 [ms]; until 1 [s] }\n",
             rate, start);
    derived d = derived_scene(text, "s");
    derived_expect(&d, text);
    return d;
}

/* --- the extrapolation -----------------------------------------------------------------------------------*/

/* Off a decay's exponential after one second by no more than the tolerance allows, whatever the columns; with a finer
 * tolerance by less, and at more expense. */
static void test_decays_end_where_they_should(void) {
    dice d = dice_of("price_motion", 91);
    for (unsigned n = 0; n < dice_cases(few_or_all(12, 300)); n++) {
        const double rate = number_scaled(1.0, (int)dice_one_of(&d, 5) - 1);
        derived of = decay_of(rate, 3.0);
        double before = 0.0;
        for (int columns = 3; columns <= 6; columns += 3) {
            for (int digits = 6; digits <= 15; digits += 3) {
                const double tolerance = pow(10.0, -digits);
                extrapolation *e =
                    extrapolation_new(of.image, (extrapolation_setting){columns, tolerance}, 1e9);
                TEST_ASSERT_TRUE(extrapolation_state(e)[0] == 3.0L);
                TEST_ASSERT_TRUE(extrapolation_operations(e) == 0.0);
                TEST_ASSERT_EQUAL_INT(EXTRAPOLATION_OK, extrapolation_go(e, 0.375L));
                TEST_ASSERT_EQUAL_INT(EXTRAPOLATION_OK, extrapolation_go(e, 0.625L));
                const long double want = 3.0L * expl(-(long double)rate);
                const double off = (double)fabsl(extrapolation_state(e)[0] - want);
                TEST_ASSERT_TRUE(off <= 30.0 * tolerance);
                const double took = extrapolation_operations(e);
                TEST_ASSERT_TRUE(digits == 6 || took >= before);
                /* a step takes 1 + 1 + 3 + 5 + ... evaluations, and two spans take two steps at least */
                const double each = of.image->list[IMAGE_STEP]->count * (1.0 + columns * columns);
                TEST_ASSERT_TRUE(took >= 2.0 * each &&
                                 fabs(took / each - floor(took / each + 0.5)) < 1e-9);
                /* the finer it is to be, the shorter its steps, by the power of its order less one */
                const double finer = pow(tolerance, -1.0 / (2.0 * columns - 1.0));
                TEST_ASSERT_TRUE(took <= each * (4.0 + 0.25 * (0.3 + rate) * finer));
                before = took;
                extrapolation_free(e);
            }
        }
        derived_free(&of);
    }
}

/* One step of so many columns of y' = -y is a rational function of the step alone: by its power series, two columns more of
 * which are right with each further rule. */
static void test_a_step_is_of_twice_its_columns_order(void) {
    for (int columns = 2; columns <= 5; columns++) {
        double off[2];
        for (int half = 0; half < 2; half++) {
            derived of = decay_of(1.0, 1.0);
            /* a tolerance that any step keeps: one step */
            extrapolation *e =
                extrapolation_new(of.image, (extrapolation_setting){columns, 1e3}, 1e9);
            const long double h = half ? 0.5L : 1.0L;
            TEST_ASSERT_EQUAL_INT(EXTRAPOLATION_OK, extrapolation_go(e, h));
            off[half] = (double)fabsl(extrapolation_state(e)[0] - expl(-h));
            extrapolation_free(e);
            derived_free(&of);
        }
        const double order = log2(off[0] / off[1]) - 1.0;
        TEST_ASSERT_TRUE(fabs(order - 2.0 * columns) < 0.6);
    }
}

/* y' = y^2 from 1 is over at 1 s: no step is small enough there; and neither is what may be evaluated without an end. */
static void test_poles_and_limits_end_it(void) {
    derived d = derived_scene("mechanism m\nstate y\nequation y' - 1 [1/s]*y^2 = 0 [1/s]\n"
                              "scene s { start y = 1; step 1 [ms]; until 3 [s] }\n",
                              "s");
    derived_expect(&d, "a pole");
    extrapolation *e = extrapolation_new(d.image, (extrapolation_setting){4, 1e-12}, 1e9);
    TEST_ASSERT_EQUAL_INT(EXTRAPOLATION_OK, extrapolation_go(e, 0.5L));
    TEST_ASSERT_TRUE(fabsl(extrapolation_state(e)[0] - 2.0L) < 1e-10L);
    TEST_ASSERT_EQUAL_INT(EXTRAPOLATION_OK, extrapolation_go(e, 0.25L));
    TEST_ASSERT_TRUE(fabsl(extrapolation_state(e)[0] - 4.0L) < 1e-9L);
    TEST_ASSERT_EQUAL_INT(EXTRAPOLATION_SMALL, extrapolation_go(e, 0.5L));
    const double took = extrapolation_operations(e);
    extrapolation_free(e);
    e = extrapolation_new(d.image, (extrapolation_setting){4, 1e-12}, took / 50.0);
    TEST_ASSERT_EQUAL_INT(EXTRAPOLATION_LONG, extrapolation_go(e, 0.999L));
    TEST_ASSERT_TRUE(extrapolation_operations(e) > took / 50.0);
    const double each = d.image->list[IMAGE_STEP]->count * 17.0;
    TEST_ASSERT_TRUE(extrapolation_operations(e) <= took / 50.0 + each);
    extrapolation_free(e);
    extrapolation_free(NULL);
    derived_free(&d);
}

/* --- fine steps ------------------------------------------------------------------------------------------*/

/* Sixteen times as fine as the scene, rounded up to an even number, unless that takes more operations than there may be. */
static void test_fine_steps_are_as_fine_as_they_may(void) {
    dice d = dice_of("price_motion steps", 92);
    derived of = derived_scene(spring, "s");
    derived_expect(&of, spring);
    const int contacts = of.image->contacts;
    for (int n = 0; n < 500; n++) {
        const double spacing_s =
            (3 + 10 * dice_one_of(&d, 40)) / 1000.0; /* no whole number of steps */
        of.image->contacts = n % 2;
        const reference_wish w = {.image = of.image,
                                  .spacing = ratio_of(spacing_s),
                                  .records = 1 + (int)dice_one_of(&d, 90),
                                  .operations = pow(10.0, dice_between(&d, 1.0, 7.0))};
        const uint64_t have = fine_steps_of(&w);
        const double each = (n % 2 ? 12.0 : 4.0) * of.image->list[IMAGE_STEP]->count;
        uint64_t want = 2;
        while ((double)want * of.image->step_s < 16.0 * spacing_s * (1 - 1e-12) &&
               (double)(want + 2) * w.records * each <= w.operations) {
            want += 2;
        }
        TEST_ASSERT_EQUAL_UINT64(want, have);
    }
    of.image->contacts = contacts;
    derived_free(&of);
}

static void test_fine_steps_are_a_cosine(void) {
    derived of = derived_scene(spring, "s");
    derived_expect(&of, spring);
    const reference_wish w = {
        .image = of.image, .spacing = {1, 20}, .records = 20, .operations = 1e8};
    of.image->settings.method = WH_EULER; /* which they are not made by */
    records *shape = records_open(NULL, of.image, &engine_double);
    long double row[21 * 4];
    TEST_ASSERT_EQUAL_INT(4, shape->columns);
    TEST_ASSERT_EQUAL_INT(20, fine_steps_run(&w, shape, 100, row));
    for (int i = 0; i <= 20; i++) {
        const double t = i / 20.0;
        const long double *r = &row[(size_t)i * 4];
        TEST_ASSERT_TRUE(fabs((double)r[0] - t) < 1e-15);
        TEST_ASSERT_TRUE(fabs((double)r[1] - 250.0 * cos(4.0 * t)) < 1e-8);
        TEST_ASSERT_TRUE(fabs((double)r[2] + 1000.0 * sin(4.0 * t)) < 4e-8);
        TEST_ASSERT_TRUE(fabs((double)r[3] - 500.0 * cos(4.0 * t)) < 2e-8);
    }
    interrupted = 1;
    TEST_ASSERT_EQUAL_INT(0, fine_steps_run(&w, shape, 100, row));
    interrupted = 0;
    records_close(shape);
    derived_free(&of);
}

/* --- the reference, and runs against it ------------------------------------------------------------------*/

static reference *reference_of(const image *im, int count) {
    const reference_wish w = {.image = im, .spacing = {1, 20}, .records = count, .operations = 1e8};
    reference *r = reference_new(&w);
    TEST_ASSERT_EQUAL_INT(REFERENCE_EXTRAPOLATED, r->kind);
    TEST_ASSERT_EQUAL_INT(count, r->records);
    return r;
}

static void test_references_are_cut_and_their_columns_found(void) {
    derived of = derived_scene(spring, "s");
    derived_expect(&of, spring);
    reference *r = reference_of(of.image, 20);
    bool noisy = true;
    TEST_ASSERT_EQUAL_INT(1, reference_find(r, "x", &noisy));
    TEST_ASSERT_FALSE(noisy);
    TEST_ASSERT_EQUAL_INT(2, reference_find(r, "x'", &noisy));
    TEST_ASSERT_EQUAL_INT(3, reference_find(r, "twice", &noisy));
    TEST_ASSERT_EQUAL_INT(-1, reference_find(r, "x'y", &noisy));
    TEST_ASSERT_EQUAL_INT(-1, reference_find(r, "twic", &noisy));
    TEST_ASSERT_TRUE(r->column[1].counts && r->column[2].counts && !r->column[3].counts);
    for (int i = 0; i <= 20; i++) {
        const long double t = (long double)i / 20.0L;
        const long double *row = r->row + (size_t)i * (size_t)r->columns;
        TEST_ASSERT_TRUE(fabsl(row[1] - 250.0L * cosl(4.0L * t)) < 1e-11L);
        TEST_ASSERT_TRUE(fabsl(row[2] + 1000.0L * sinl(4.0L * t)) < 4e-11L);
        TEST_ASSERT_TRUE(fabsl(row[3] - 500.0L * cosl(4.0L * t)) < 2e-11L);
    }
    /* the largest rate is that of a quarter of a turn, at 0.39 s: later than the fifth record */
    TEST_ASSERT_TRUE(fabsl(r->column[2].largest - 1000.0L * sinl(1.6L)) < 1e-9L);
    r->column[1].off = r->column[1].largest / 8.0L;
    r->column[2].off = r->column[2].largest / 4.0L;
    r->column[3].off = r->column[3].largest / 2.0L;
    TEST_ASSERT_TRUE(fabs(reference_agreement(r) - 0.25) < 1e-15);
    reference_cut(r, 25);
    TEST_ASSERT_EQUAL_INT(20, r->records);
    reference_cut(r, 5);
    TEST_ASSERT_EQUAL_INT(5, r->records);
    TEST_ASSERT_TRUE(fabsl(r->column[2].largest - 1000.0L * sinl(1.0L)) < 1e-9L);
    reference_cut(r, 0); /* no rate has moved yet */
    TEST_ASSERT_TRUE(r->column[1].counts && !r->column[2].counts);
    reference_free(r);
    derived_free(&of);
}

static void test_deviations_are_the_largest_of_all_records(void) {
    static const deviation_pace paces[] = {{1, 1}, {3, 1}, {1, 2}, {1, 5}};
    static const wh_method methods[] = {WH_EULER, WH_HEUN, WH_RK4};
    derived of = derived_scene(spring, "s");
    derived_expect(&of, spring);
    reference *r = reference_of(of.image, 20);
    for (int column = -1; column < 4; column++) {
        for (int n = 0; n < 24 && column != 0; n++) {
            const deviation_pace pace = paces[n % 4];
            const engine_kind *kind = n < 12 ? &engine_float : &engine_double;
            image *im = of.image;
            im->settings.method = methods[n / 4 % 3];
            im->step = (whole_ratio){pace.records, 20 * pace.steps};
            im->step_s = (double)pace.records / (20.0 * (double)pace.steps);
            /* the same steps, and what each record is off; broken off where it is of no use */
            const double give_up = column < 0 ? 0.3 : 90.0;
            void *run = kind->start(im);
            double worst = -1.0;
            int at = 0;
            int taken = 0;
            for (int i = 0; i <= 20 && worst <= give_up; i += (int)pace.records) {
                double angle[1];
                double real[2];
                for (uint64_t k = 0; k < pace.steps && i > 0; k++, taken++) {
                    TEST_ASSERT_EQUAL_INT(WH_OK, kind->step(run));
                }
                kind->state(run, angle, real);
                for (int c = 1; c < 4; c++) {
                    const double shown = (c == 3 ? 2.0 * real[0] : real[c - 1]) * 1000.0;
                    const double is = (double)r->row[(size_t)i * (size_t)r->columns + (size_t)c];
                    const double off =
                        fabs(shown - is) / (column < 0 ? (double)r->column[c].largest : 1.0);
                    if ((column < 0 ? c < 3 : c == column) && off > worst) {
                        worst = off;
                        at = c;
                    }
                }
            }
            kind->stop(run);
            const deviation d =
                deviation_measure(r, im, kind, pace, (deviation_of_what){column, give_up});
            TEST_ASSERT_EQUAL_INT(worst <= give_up, d.usable);
            TEST_ASSERT_TRUE(fabs(d.error - worst) <= 1e-6 * worst + 1e-12);
            TEST_ASSERT_EQUAL_INT(at, d.column);
            const double unit = column < 0 ? (double)r->column[at].largest : 1.0;
            TEST_ASSERT_TRUE(fabs(d.known - (double)r->column[at].off / unit) < 1e-18);
            const double stages = wh_methods[im->settings.method].stages;
            TEST_ASSERT_TRUE(d.evaluations_most == stages);
            TEST_ASSERT_TRUE(d.operations == taken * stages * im->list[IMAGE_STEP]->count);
            TEST_ASSERT_TRUE(taken == 0 || fabs(d.evaluations * im->step_s / stages - 1) < 1e-9);
        }
    }
    interrupted = 1;
    const deviation none =
        deviation_measure(r, of.image, &engine_double, paces[0], (deviation_of_what){-1, 1.0});
    interrupted = 0;
    TEST_ASSERT_TRUE(none.operations == 0.0 && none.evaluations == 0.0);
    reference_free(r);
    derived_free(&of);
}

/* With contacts steps differ: told is the one that took most evaluations. */
static void test_the_step_with_most_evaluations_is_told(void) {
    derived of = derived_scene("mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                               "V = 1 [kg]*9.81 [m/s^2]*x\nstop x >= 0 [m] restitution 0.5\n"
                               "scene s { start x = 1 [m]; step 10 [ms]; until 1 [s] }\n",
                               "s");
    derived_expect(&of, "a ball");
    const reference_wish w = {
        .image = of.image, .spacing = {1, 20}, .records = 18, .operations = 1e7};
    reference *r = reference_new(&w);
    TEST_ASSERT_EQUAL_INT(REFERENCE_FINE_STEPS, r->kind);
    TEST_ASSERT_EQUAL_INT(18, r->records);
    void *run = engine_double.start(of.image);
    double most = 0.0;
    uint64_t before = 0;
    uint64_t declared;
    for (int i = 0; i < 18 * 5; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, engine_double.step(run));
        const uint64_t now = engine_double.evaluations(run, &declared);
        most = fmax(most, (double)(now - before));
        before = now;
    }
    engine_double.stop(run);
    const deviation d = deviation_measure(r, of.image, &engine_double, (deviation_pace){5, 1},
                                          (deviation_of_what){-1, 1.0});
    TEST_ASSERT_TRUE(d.usable && d.evaluations_most == most && most > 4.0);
    /* reading each of 19 records evaluates the accelerations once more, and the first how contacts begin: an expense, and none
     * of the steps' */
    const double evaluations = d.operations / of.image->list[IMAGE_STEP]->count;
    TEST_ASSERT_TRUE(evaluations == (double)before + 20.0);
    TEST_ASSERT_TRUE(fabs(d.evaluations - (double)before / 0.9) < 1e-6);
    /* as far as it may be off, and no further */
    const deviation same = deviation_measure(r, of.image, &engine_double, (deviation_pace){5, 1},
                                             (deviation_of_what){-1, d.error});
    TEST_ASSERT_TRUE(same.usable && same.error == d.error);
    reference_free(r);
    derived_free(&of);
}

void suite_price_motion(void) {
    RUN_TEST(test_the_step_with_most_evaluations_is_told);
    RUN_TEST(test_decays_end_where_they_should);
    RUN_TEST(test_a_step_is_of_twice_its_columns_order);
    RUN_TEST(test_poles_and_limits_end_it);
    RUN_TEST(test_fine_steps_are_as_fine_as_they_may);
    RUN_TEST(test_fine_steps_are_a_cosine);
    RUN_TEST(test_references_are_cut_and_their_columns_found);
    RUN_TEST(test_deviations_are_the_largest_of_all_records);
}

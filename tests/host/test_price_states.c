/* test_price_states.c: rows of the reference (host/study/reference_run.h), of fine steps, and which of them a
 * reference takes, until when, and in what words: against the records of a run, closed forms and a walk over the
 * rows. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "command.h"
#include "derived.h"
#include "host/base/interrupts.h"
#include "host/study/long_list.h"
#include "host/study/reference_run.h"
#include "priced.h"
#include "unity.h"

void suite_price_states(void);

enum { COMPONENTS = 3 * IMAGE_COMPONENTS_MAX };

/* --- rows ------------------------------------------------------------------------------------------------*/

/* Recovered coordinates, units that are not SI, angles, inputs, outputs of each. */
static const char *const models[] = {
    "thomson_a_conserved",
    "thomson_plane_conserved",
    "epicyclic_conserved",
    "spherical_flight",
    ("mechanism m\ncoordinate a [deg]\ncoordinate x [mm]\ninput u = 2 [N]\n"
     "output tip [cm] = x + 30 [mm]*sin(a)\noutput turn [deg/s] = a'\noutput push [N] = u\n"
     "T = 1 [kg]*x'^2/2 + 0.01 [kg*m^2]*a'^2/2\nV = 9 [N/m]*x^2/2 - 1 [J]*cos(a)\nQ(x) = u\n"
     "scene s { start a = 20 [deg], x = 5 [mm]; step 1 [ms]; until 1 [s] }\n"),
    ("mechanism m\nstate y\nstate z\nequation 1 [s^2]*y'' + y*z = 1\nequation 1 [s]*z' + z = y\n"
     "output sum = y + z\nscene s { start y = 2; step 1 [ms]; until 1 [s] }\n")};
enum { MODELS = sizeof models / sizeof models[0] };
/* Numbers behind a row, which nobody writes. */
enum { BEHIND = 4000 };

static derived model_of(int n) {
    derived d = strncmp(models[n], "mechanism", 9) == 0 ? derived_scene(models[n], "s")
                                                        : derived_builtin(models[n]);
    derived_expect(&d, models[n]);
    return d;
}

static void test_rows_are_the_records_of_a_run(void) {
    int recovered = 0;
    for (int n = 0; n < MODELS; n++) {
        derived d = model_of(n);
        const image *im = d.image;
        recovered += im->recovered;
        records *r = records_open(NULL, im, &engine_double);
        const long before = blocks_in_use();
        long_rows *rows = long_rows_new(r);
        long double *row = malloc((size_t)(r->columns + BEHIND) * sizeof *row);
        void *run = engine_double.start(im);
        for (int step = 0; step < 40; step++) {
            double angle[COMPONENTS];
            double real[COMPONENTS];
            long double state[COMPONENTS];
            const double time_s = (double)step * im->step_s + 0.125;
            engine_double.state(run, angle, real);
            for (int i = 0; i < im->angles + im->reals; i++) {
                state[i] = (long double)(i < im->angles ? angle[i] : real[i - im->angles]);
            }
            records_read(r, run, time_s);
            for (int i = 0; i < r->columns + BEHIND; i++) {
                row[i] = 77.0L;
            }
            long_rows_read(rows, state, (long double)time_s, row);
            TEST_ASSERT_TRUE(row[0] == (long double)time_s);
            for (int i = 0; i < BEHIND; i++) {
                TEST_ASSERT_TRUE(row[r->columns + i] == 77.0L);
            }
            for (int i = 1; i < r->columns; i++) {
                TEST_ASSERT_TRUE_MESSAGE(
                    fabs((double)row[i] - r->row[i]) <= 1e-11 * (1.0 + fabs(r->row[i])), models[n]);
            }
            TEST_ASSERT_EQUAL_INT(WH_OK, engine_double.step(run));
        }
        engine_double.stop(run);
        free(row);
        long_rows_free(rows);
        long_rows_free(NULL);
        TEST_ASSERT_EQUAL_INT_MESSAGE(before, blocks_in_use(), models[n]);
        records_close(r);
        derived_free(&d);
    }
    TEST_ASSERT_TRUE(recovered >= 4);
}

/* --- fine steps ------------------------------------------------------------------------------------------*/

static const char *const flight =
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
    "scene s { start x = 0.3 [m], x' = 0.1 [m/s]; step 1 [ms]; until 1 [s] }\n";

/* Steps of a flight without a force are off by their roundings alone, which compensated sums carry along; even if the scene's
 * own settings are others. */
static void test_fine_steps_keep_what_is_rounded_off(void) {
    derived d = derived_scene(flight, "s");
    derived_expect(&d, flight);
    const reference_wish w = {.image = d.image, .spacing = {1, 3}, .records = 4, .operations = 1e9};
    records *shape = records_open(NULL, d.image, &engine_double);
    d.image->settings.method = WH_EULER;
    long double row[5 * 3];
    const long before = blocks_in_use();
    TEST_ASSERT_EQUAL_INT(4, fine_steps_run(&w, shape, 30000, row));
    TEST_ASSERT_EQUAL_INT(before, blocks_in_use());
    for (int i = 0; i <= 4; i++) {
        const long double x = (long double)0.3 + (long double)0.1 * (long double)i / 3.0L;
        TEST_ASSERT_TRUE(fabsl(row[3 * i + 1] - x) <= 1.5e-16L);
        TEST_ASSERT_TRUE(row[3 * i + 2] == (long double)0.1);
    }
    TEST_ASSERT_EQUAL_INT(WH_EULER, d.image->settings.method); /* the scene's own are not touched */
    records_close(shape);
    derived_free(&d);
}

/* y' = y^2 from 1/t is over at t: records end before it, wherever it is. */
static void test_fine_steps_end_with_the_motion(void) {
    for (int tenths = 2; tenths <= 9; tenths++) {
        char text[300];
        snprintf(text, sizeof text,
                 "mechanism m\nstate y\nequation y' = 1 [1/s]*y^2\n"
                 "scene s { start y = %.17g; step 1 [ms]; until 3 [s] }\n",
                 1.0 / (0.1 * tenths - 0.05));
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        const reference_wish w = {
            .image = d.image, .spacing = {1, 10}, .records = 12, .operations = 1e9};
        records *shape = records_open(NULL, d.image, &engine_double);
        long double row[13 * 2];
        const int done = fine_steps_run(&w, shape, 2000, row);
        TEST_ASSERT_EQUAL_INT(tenths - 1, done);
        for (int i = 0; i <= done; i++) {
            const double y = 1.0 / (0.1 * tenths - 0.05 - 0.1 * i);
            TEST_ASSERT_TRUE(fabs((double)row[2 * i + 1] - y) < 1e-6 * y);
        }
        records_close(shape);
        derived_free(&d);
    }
}

/* --- the reference ---------------------------------------------------------------------------------------*/

/* Largest values by a walk; a column that is an output, or never anything, does not count. */
static void expect_columns(const reference *r) {
    for (int k = 1; k < r->columns; k++) {
        long double largest = 0.0L;
        for (int i = 0; i <= r->records; i++) {
            largest = fmaxl(largest, fabsl(r->row[(size_t)i * (size_t)r->columns + (size_t)k]));
        }
        const reference_column *c = &r->column[k];
        TEST_ASSERT_TRUE(c->largest == largest);
        TEST_ASSERT_TRUE(c->off >= 0.0L);
        TEST_ASSERT_TRUE(!c->counts || (largest > 0.0L && r->shape->column[k].unknown >= 0));
        TEST_ASSERT_TRUE(!c->counts || c->off <= (long double)r->limit * largest);
    }
}

static reference *reference_to(const image *im, int count, double operations) {
    const reference_wish w = {
        .image = im, .spacing = {1, 20}, .records = count, .operations = operations};
    return reference_new(&w);
}

typedef struct kind_row {
    const char *text;
    double operations;
    reference_kind kind;
    int least, most; /* records */
    const char *how; /* some of its words; NULL: any */
    const char *why; /* likewise; NULL: none are said */
} kind_row;

#define SCENE(start) "scene s { " start "step 1 [ms]; until 1 [s] }\n"
static const kind_row kind_rows[] = {
    /* smooth, and small */
    {"mechanism m\ncoordinate x [m]\noutput twice [m] = 2*x\nT = 1 [kg]*x'^2/2\n"
     "V = 40 [N/m]*x^2/2\n" SCENE("start x = 0.02 [m];"),
     1e8, REFERENCE_EXTRAPOLATED, 20, 20, "extrapolation of order 12", NULL},
    {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 40 [N/m]*x^2/2\n" SCENE(
         "start x = 0.02 [m];"),
     1e8, REFERENCE_EXTRAPOLATED, 20, 20, "held against order 10", NULL},
    /* a pole at 0.52 s */
    {"mechanism m\nstate y\nequation y' = 1 [1/s]*y^2\n" SCENE("start y = 1.923076923;"), 1e8,
     REFERENCE_EXTRAPOLATED, 10, 10, NULL, "behind 0.5 s no step is small enough"},
    /* nothing moves; and what moves is no coordinate */
    {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 40 [N/m]*x^2/2\n" SCENE(""), 1e8,
     REFERENCE_NONE, 0, 20, NULL, "nothing moves"},
    {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n" SCENE("start x = 2 [m];"), 1e8,
     REFERENCE_EXTRAPOLATED, 20, 20, NULL, NULL},
    /* with a contact, and a jump that no short step passes */
    {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [kg]*9.81 [m/s^2]*x\n"
     "stop x >= 0 [m] restitution 0.5\n" SCENE("start x = 0.5 [m];"),
     1e7, REFERENCE_FINE_STEPS, 1, 20, "rk4 in double with compensated sums", ""},
    {"mechanism m\nstate y\nstate z\nequation y' = 1 [1/s]*atan2(z - 0.47, -1)\n"
     "equation z' = 1 [1/s]\n" SCENE("start y = 1000;"),
     1e7, REFERENCE_FINE_STEPS, 20, 20, "a reference that shares the core's step", NULL},
    /* too dear, and by few steps nothing is known at all */
    {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 4000 [N/m]*x^2/2\n" SCENE(
         "start x = 0.02 [m];"),
     6000.0, REFERENCE_EXTRAPOLATED, 1, 19, NULL, "the reference took too long behind "}};

static void test_references_are_of_the_kind_that_can_be_trusted(void) {
    for (size_t n = 0; n < sizeof kind_rows / sizeof kind_rows[0]; n++) {
        const kind_row *row = &kind_rows[n];
        derived d = derived_scene(row->text, "s");
        derived_expect(&d, row->text);
        long before = 0;
        for (int round = 0; round < 2; round++) {
            before = blocks_in_use();
            reference *r = reference_to(d.image, 20, row->operations);
            TEST_ASSERT_EQUAL_INT_MESSAGE(row->kind, r->kind, row->text);
            TEST_ASSERT_TRUE_MESSAGE(r->records >= row->least && r->records <= row->most,
                                     row->text);
            TEST_ASSERT_EQUAL_INT(20, r->wanted);
            TEST_ASSERT_FALSE(r->stopped);
            TEST_ASSERT_TRUE_MESSAGE(row->how == NULL || strstr(r->how, row->how) != NULL,
                                     row->text);
            TEST_ASSERT_TRUE_MESSAGE(row->why != NULL || r->why == NULL, row->text);
            TEST_ASSERT_TRUE_MESSAGE(row->why == NULL || row->why[0] == '\0' ||
                                         strstr(r->why, row->why) != NULL,
                                     row->text);
            TEST_ASSERT_TRUE(r->limit == (row->kind == REFERENCE_FINE_STEPS ? 1e-6
                                          : LONG_IS_LONGER                  ? 1e-12
                                                                            : 1e-9));
            expect_columns(r);
            reference_free(r);
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(before, blocks_in_use(), row->text);
        derived_free(&d);
    }
    reference_free(NULL);
}

/* Where rounding might make anything of a slope, as of a root at zero, errors are still parts of the values. */
static void test_a_root_at_zero_does_not_hide_errors(void) {
    dice d = dice_of("price_states", 451);
    for (int n = 0; n < 6; n++) {
        char text[400];
        const double rate = dice_between(&d, 60.0, 300.0);
        snprintf(text, sizeof text,
                 "mechanism m\nstate y\nstate p\nstate q\nstate r\n"
                 "equation y' + %.17g [1/s]*y = 1 [1/s]*sqrt(p*q - r)\nequation p' = 0 [1/s]\n"
                 "equation q' = 0 [1/s]\nequation r' = 0 [1/s]\n"
                 "scene s { start y = 1, p = 0.5, q = 0.5, r = 0.25; step 1 [ms]; until 1 [s] }\n",
                 rate);
        derived of = derived_scene(text, "s");
        derived_expect(&of, text);
        reference *r = reference_to(of.image, 4, 1e8);
        TEST_ASSERT_EQUAL_INT(REFERENCE_EXTRAPOLATED, r->kind);
        TEST_ASSERT_EQUAL_INT(4, r->records);
        for (int i = 0; i <= 4; i++) {
            const long double y = expl(-(long double)rate * (long double)i / 20.0L);
            TEST_ASSERT_TRUE(fabsl(r->row[i * r->columns + 1] - y) < 1e-15L);
        }
        reference_free(r);
        derived_free(&of);
    }
}

/* What is stopped is of no use. */
static void test_references_are_stopped(void) {
    for (int n = 0; n < 2; n++) {
        derived d = derived_scene(n == 0 ? kind_rows[0].text : kind_rows[5].text, "s");
        derived_expect(&d, "a scene");
        interrupted = 1;
        const long before = blocks_in_use();
        reference *r = reference_to(d.image, 20, 1e7);
        interrupted = 0;
        TEST_ASSERT_TRUE(r->stopped);
        TEST_ASSERT_EQUAL_INT(0, r->records);
        reference_free(r);
        TEST_ASSERT_EQUAL_INT(before, blocks_in_use());
        derived_free(&d);
    }
}

void suite_price_states(void) {
    RUN_TEST(test_rows_are_the_records_of_a_run);
    RUN_TEST(test_fine_steps_keep_what_is_rounded_off);
    RUN_TEST(test_fine_steps_end_with_the_motion);
    RUN_TEST(test_references_are_of_the_kind_that_can_be_trusted);
    RUN_TEST(test_a_root_at_zero_does_not_hide_errors);
    RUN_TEST(test_references_are_stopped);
}

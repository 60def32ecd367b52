/* test_twins.c: a run and the finer one beside it (host/check/step_doubling.h), by themselves: what the finer one is made of, where
 * the two end, and what is told of them, of oscillators whose motion is known. */
#include "host/check/step_doubling.h"

#include <math.h>
#include <stdio.h>

#include "command.h"
#include "core/method.h"
#include "host/base/interrupts.h"
#include "motion.h"
#include "unity.h"

void suite_twins(void);

enum { TEXT = 600 };

/* A mass on a spring, from x = A at rest: x = A cos(w t). Its unit may be another than the SI's. */
static void write_spring(char *text, const char *unit, double a, double w, double step_s,
                         double until_s) {
    snprintf(text, TEXT,
             "mechanism m\ncoordinate x [%s]\nparameter k = %.17g [N/m]\nT = 1 [kg]*x'^2/2\n"
             "V = k*x^2/2\nscene s { start x = %.17g [m]\nstep %.17g [s]\nuntil %.17g [s] }\n",
             unit, w * w, a, step_s, until_s);
}

static step_doubling *twins_of(const motion *m, const image *im) {
    const step_doubling_wish w = {.image = im, .kind = m->kind, .plain = m->image};
    return step_doubling_run(&w);
}

/* --- what the finer run is ------------------------------------------------------------------------------ */

/* Exactly half, whatever the step is as a fraction; a matrix that is the motion itself is taken as it is. */
static void test_the_finer_run(void) {
    dice d = dice_of("twins", 31);
    for (unsigned method = 0; method < WH_METHODS; method++) {
        for (unsigned of = 0; of < 3U; of++) {
            char text[TEXT];
            motion m;
            const image_matrix_of matrix = of == 0   ? MATRIX_NONE
                                           : of == 1 ? MATRIX_RK4
                                                     : MATRIX_EXACT;
            if (of > 0 && method != (unsigned)WH_METHOD_DEFAULT) {
                continue;
            }
            write_spring(text, "m", 1.0, 2.0, 1e-3, 3e-3);
            motion_open_text(&m, text,
                             (stepping){.kind = &engine_double,
                                        .method = (wh_method)method,
                                        .compensated = of == 2,
                                        .matrix = matrix});
            image im = *m.image;
            const whole_ratio steps[] = {im.step,
                                         {1U + dice_one_of(&d, 1000), 1U + dice_one_of(&d, 1000)},
                                         {2U * (1U + dice_one_of(&d, 1000)), UINT64_C(1) << 61},
                                         {3, UINT64_C(1) << 58}};
            for (unsigned k = 0; k < sizeof steps / sizeof steps[0]; k++) {
                im.step = steps[k];
                step_doubling *t = twins_of(&m, &im);
                const bool halves = matrix != MATRIX_EXACT;
                const int order = wh_methods[method].order;
                const bool own = matrix == MATRIX_NONE && order >= 4;
                TEST_ASSERT_EQUAL(halves ? 2 : 1, t->each);
                TEST_ASSERT_TRUE(t->finer.settings.compensated);
                if (halves) {
                    TEST_ASSERT_EQUAL(MATRIX_NONE, t->finer.settings.matrix);
                    TEST_ASSERT_NULL(t->finer.list[IMAGE_MATRIX]);
                    TEST_ASSERT_EQUAL(own ? method : (unsigned)WH_RK4, t->finer.settings.method);
                    const long double twice = 2.0L * (long double)t->finer.step.numerator *
                                              (long double)steps[k].denominator;
                    TEST_ASSERT_TRUE(twice == (long double)t->finer.step.denominator *
                                                  (long double)steps[k].numerator);
                    TEST_ASSERT_EQUAL_DOUBLE(0.5 * (double)steps[k].numerator /
                                                 (double)steps[k].denominator,
                                             t->finer.step_s);
                    TEST_ASSERT_EQUAL_UINT64(2U * im.steps, t->finer.steps);
                }
                TEST_ASSERT_EQUAL_DOUBLE(halves && own ? 1.0 / (1.0 - pow(2.0, -order)) : 1.0,
                                         t->left_out);
                step_doubling_free(t);
            }
            motion_close(&m);
        }
    }
}

static void test_plain_settings(void) {
    for (unsigned i = 0; i < 24U; i++) {
        const image_settings of = {.tables = i % 2U == 0 ? TABLES_NONE : TABLES_CUBIC,
                                   .cells = i % 2U == 0 ? 0 : 64,
                                   .compensated = i / 2U % 2U == 1,
                                   .matrix = i / 4U % 3U == 0   ? MATRIX_NONE
                                             : i / 4U % 3U == 1 ? MATRIX_RK4
                                                                : MATRIX_EXACT,
                                   .method = i < 12U ? WH_RK4 : WH_LEAPFROG};
        image_settings plain;
        const bool sums = of.compensated || of.matrix == MATRIX_EXACT;
        const bool other = step_doubling_plain(&of, &plain);
        TEST_ASSERT_EQUAL(i % 2U == 1 || sums != of.compensated, other);
        TEST_ASSERT_EQUAL(TABLES_NONE, plain.tables);
        TEST_ASSERT_EQUAL(0, plain.cells);
        TEST_ASSERT_EQUAL(sums, plain.compensated);
        TEST_ASSERT_TRUE(plain.matrix == of.matrix && plain.method == of.method);
    }
}

/* --- what is told ---------------------------------------------------------------------------------------- */

/* Lowest and highest are the motion's, the difference at the end is what two runs of whirl's own differ by; what rounds a
 * rate moves its coordinate for all of the time. */
static void test_what_is_told(void) {
    static const struct {
        const char *name;
        double per_m;
    } units[] = {{"m", 1.0}, {"mm", 1e3}, {"km", 1e-3}};
    dice d = dice_of("twins", 32);
    for (unsigned i = 0; i < 12U; i++) {
        char text[TEXT];
        motion m;
        const double a = dice_between(&d, 0.5, 2.0);
        const double w = dice_between(&d, 5.0, 20.0);
        const double per_m = units[i % 3U].per_m;
        write_spring(text, units[i % 3U].name, a, w, 1e-3, 1.5);
        motion_open_text(
            &m, text,
            (stepping){.kind = i % 2U == 0 ? &engine_double : &engine_float, .method = WH_RK4});
        step_doubling *t = twins_of(&m, m.image);
        TEST_ASSERT_EQUAL(WH_OK, t->status);
        TEST_ASSERT_EQUAL_DOUBLE(1.5, t->end_s);
        TEST_ASSERT_TRUE(t->finer_failed_s < 0.0 && t->overrun_s < 0.0 && !t->stopped);
        TEST_ASSERT_EQUAL_INT(3, t->columns);
        const step_doubling_column *x = &t->column[1];
        const step_doubling_column *v = &t->column[2];
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * a * per_m, -a * per_m, x->low);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * a * per_m, a * per_m, x->high);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * a * w, -a * w, v->low / per_m);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * a * w, a * w, v->high / per_m);
        motion_step(&m, 1500);
        const double off = fabs(motion_value(&m, "x") - a * cos(1.5 * w)) * per_m;
        TEST_ASSERT_DOUBLE_WITHIN(0.1 * off + 1e-12 * a * per_m, off, x->last * t->left_out);
        const double unit = 0.5 * 0x1p-52;
        const double x_size = fmax(fabs(x->low), fabs(x->high));
        const double v_size = fmax(fabs(v->low), fabs(v->high));
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * x->rounding, v->rounding * t->end_s + unit * x_size,
                                  x->rounding);
        /* The acceleration is one product, rounded with its factors' roundings: some units of the largest. */
        const double pull = v->rounding - unit * v_size;
        TEST_ASSERT_TRUE(pull > 0.5 * unit * a * w * w * per_m * t->end_s);
        TEST_ASSERT_TRUE(pull < 20.0 * unit * a * w * w * per_m * t->end_s);
        step_doubling_free(t);
        motion_close(&m);
    }
}

/* Of 1200 steps: before the next one. */
static void test_an_end_from_outside(void) {
    char text[TEXT];
    motion m;
    write_spring(text, "m", 1.0, 3.0, 1e-3, 1.2);
    motion_open_text(&m, text, IN_DOUBLE);
    for (int i = 0; i < 2; i++) {
        interrupted = i;
        step_doubling *t = twins_of(&m, m.image);
        TEST_ASSERT_EQUAL(i == 1, t->stopped);
        TEST_ASSERT_EQUAL_DOUBLE(i == 1 ? 0.0 : 1.2, t->end_s);
        step_doubling_free(t);
    }
    interrupted = 0;
    motion_close(&m);
}

/* x'' = x^3 from x = s, x' = s^2/sqrt(2) is x = s/(1 - s t/sqrt(2)): beyond all bounds at a known moment. Behind it nothing
 * is told, of either run. */
static void test_runs_that_fail(void) {
    dice d = dice_of("twins", 33);
    for (unsigned i = 0; i < 6U; i++) {
        char text[TEXT];
        motion m;
        const double s = dice_between(&d, 1.0, 3.0);
        const double end_s = sqrt(2.0) / s;
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\nparameter k = 1 [N/m^3]\nT = 1 [kg]*x'^2/2\n"
                 "V = -k*x^4/4\nscene s { start x = %.17g [m], x' = %.17g [m/s]\nstep 1 [ms]\n"
                 "until 9 [s] }\n",
                 s, s * s / sqrt(2.0));
        motion_open_text(&m, text, i % 2U == 0 ? IN_DOUBLE : IN_FLOAT);
        step_doubling *t = twins_of(&m, m.image);
        TEST_ASSERT_NOT_EQUAL(WH_OK, t->status);
        TEST_ASSERT_TRUE(t->end_s > 0.99 * end_s && t->end_s < 1.05 * end_s + 0.02);
        step_doubling_free(t);
        motion_close(&m);
    }
}

/* What both runs take, told beforehand, is what they are then counted to have taken, but for their first step and the
 * looks at the state. */
static void test_what_they_take(void) {
    dice d = dice_of("twins", 34);
    for (unsigned i = 0; i < 2U * WH_METHODS; i++) {
        char text[TEXT];
        motion m;
        const wh_method method = (wh_method)(i / 2U);
        const uint64_t steps = 200U + dice_one_of(&d, 800);
        write_spring(text, "m", 1.0, dice_between(&d, 1.0, 10.0), 1e-3, 1e-3 * (double)steps);
        motion_open_text(
            &m, text,
            (stepping){.kind = i % 2U == 0 ? &engine_double : &engine_float, .method = method});
        const double told = step_doubling_operations(m.image, m.image);
        const int own = wh_methods[method].order >= 4 ? (int)method : (int)WH_METHOD_DEFAULT;
        const int methods[] = {(int)method, own, own}; /* the finer one takes two */
        double counted = 0.0;
        for (int k = 0; k < 3; k++) {
            motion run;
            motion_open_text(&run, text,
                             (stepping){.kind = &engine_double, .method = (wh_method)methods[k]});
            const uint64_t before = engine_operations;
            motion_step(&run, steps);
            counted += (double)(engine_operations - before);
            motion_close(&run);
        }
        TEST_ASSERT_TRUE(told >= 0.99 * counted && told <= 1.02 * counted);
        motion_close(&m);
    }
}

void suite_twins(void) {
    RUN_TEST(test_what_they_take);
    RUN_TEST(test_the_finer_run);
    RUN_TEST(test_plain_settings);
    RUN_TEST(test_what_is_told);
    RUN_TEST(test_an_end_from_outside);
    RUN_TEST(test_runs_that_fail);
}

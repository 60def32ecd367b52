/* test_divergence.c: a run that leaves all bounds stops, says which component it was, and keeps its
 * last good state; in float and in double, with every method. */
#include "motion.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/cli/commands.h"

#include "unity.h"

void suite_divergence(void);

/* x'' = 2 x^3 / m^2 from x = 1 m at 1 m/s: x = 1/(1 - t), infinite at 1 s. */
static const char blow_up[] = "mechanism blow_up\n"
                              "coordinate x [m]\n"
                              "parameter m = 1 [kg]\n"
                              "parameter c = 1 [N/m^3]\n"
                              "T = m*x'^2/2\n"
                              "V = -c*x^4/2\n"
                              "scene escape {\n"
                              "  start x = 1 [m], x' = 1 [m/s]\n"
                              "  step 1 [ms]\n"
                              "  until 2 [s]\n"
                              "}\n";

/* A free rotor that does just under, or just over, half a turn a step. */
static const char rotor[] = "mechanism rotor\n"
                            "coordinate theta [rad]\n"
                            "parameter I = 1 [kg*m^2]\n"
                            "T = I*theta'^2/2\n"
                            "scene spin {\n"
                            "  step 1 [ms]\n"
                            "}\n";

static const engine_kind *const kinds[] = {&engine_float, &engine_double};

/* Step until it fails, within `most` steps. The state must then be the one before the failed step,
 * and further steps must fail the same way. Returns the steps done. */
static uint64_t run_into_failure(motion *m, unsigned most) {
    const uint64_t first = m->kind->steps(m->run);
    uint64_t before = m->kind->hash(m->run);
    uint64_t done = 0;
    while (done < most && motion_step(m, 1) == WH_OK) {
        before = m->kind->hash(m->run);
        done++;
    }
    TEST_ASSERT_TRUE(done < most);
    const int fault = m->kind->fault(m->run);
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(WH_E_DIVERGED, motion_step(m, 1));
        TEST_ASSERT_TRUE(m->kind->hash(m->run) == before);
        TEST_ASSERT_TRUE(m->kind->steps(m->run) == first + done);
        TEST_ASSERT_EQUAL_INT(fault, m->kind->fault(m->run));
    }
    TEST_ASSERT_TRUE(fault >= 0 && fault < m->image->angles + m->image->reals);
    return done;
}

static void test_motion_that_ends_in_infinity(void) {
    for (unsigned k = 0; k < 2; k++) {
        for (unsigned compensated = 0; compensated < 2; compensated++) {
            motion m;
            motion_open_text(
                &m, blow_up,
                (stepping){.kind = kinds[k], .method = WH_RK4, .compensated = compensated != 0});
            motion_to(&m, 0.9);
            /* Right to 1e-4 of itself until then: the run is one, not noise. */
            TEST_ASSERT_DOUBLE_WITHIN(1e-3, 10.0, motion_value(&m, "x"));
            TEST_ASSERT_DOUBLE_WITHIN(2e-2, 100.0, motion_value(&m, "x'"));
            const uint64_t done = run_into_failure(&m, 2000);
            const double x = motion_value(&m, "x");
            printf("  %s%s: stopped after %u of 1000 steps to infinity, x = %.3g m\n",
                   kinds[k]->name, compensated ? ", compensated" : "", 900U + (unsigned)done, x);
            TEST_ASSERT_TRUE(isfinite(x) && x > 100.0 && x < 1e15);
            TEST_ASSERT_TRUE(isfinite(motion_value(&m, "x'")));
            motion_close(&m);
        }
    }
}

static void test_every_method_stops(void) {
    for (unsigned k = 0; k < 2; k++) {
        for (unsigned i = 0; i < WH_METHODS; i++) {
            motion m;
            motion_open_text(&m, blow_up, (stepping){.kind = kinds[k], .method = (wh_method)i});
            /* Lower orders lag behind the true motion, so they get there a little later. */
            const uint64_t done = run_into_failure(&m, 1100);
            TEST_ASSERT_TRUE(done >= 990);
            TEST_ASSERT_TRUE(fabs(motion_value(&m, "x")) < 1e15);
            motion_close(&m);
        }
    }
}

/* A motor that is told nonsense: the step is refused and the gear keeps turning once the torque is
 * sound again, as if nothing had been. */
static void test_an_input_that_is_no_number(void) {
    for (unsigned k = 0; k < 2; k++) {
        motion m;
        motion undisturbed;
        motion_open(&undisturbed, "epicyclic_from_rest",
                    (stepping){.kind = kinds[k], .method = WH_RK4});
        motion_open(&m, "epicyclic_from_rest", (stepping){.kind = kinds[k], .method = WH_RK4});
        motion_to(&m, 1.0);
        m.kind->set_input(m.run, 0, (double)NAN);
        TEST_ASSERT_TRUE(run_into_failure(&m, 2) == 0);
        m.kind->set_input(m.run, 0, (double)INFINITY);
        TEST_ASSERT_TRUE(run_into_failure(&m, 2) == 0);
        m.kind->set_input(m.run, 0, 2.0);
        motion_to(&m, 2.0);
        motion_to(&undisturbed, 2.0);
        TEST_ASSERT_TRUE(m.kind->hash(m.run) == undisturbed.kind->hash(undisturbed.run));
        motion_close(&m);
        motion_close(&undisturbed);
    }
}

/* Half a turn a step is where direction is lost: 3141.59 rad/s at 1 ms. */
static void test_an_angle_that_turns_too_fast_for_the_step(void) {
    for (unsigned k = 0; k < 2; k++) {
        stepping how = {.kind = kinds[k], .method = WH_RK4, .start = "theta'=-3141"};
        motion m;
        motion_open_text(&m, rotor, how);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1000));
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, -3141.0, motion_value(&m, "theta"));
        motion_close(&m);
        how.start = "theta'=-3142";
        motion_open_text(&m, rotor, how);
        TEST_ASSERT_TRUE(run_into_failure(&m, 2) == 0);
        TEST_ASSERT_EQUAL_INT(0, m.kind->fault(m.run));
        motion_close(&m);
    }
}

/* What starts beyond all bounds is told so, and no smaller step or other number is named for it. */
static void test_starts_beyond_all_bounds(void) {
    static const char *const units[] = {"m", "mm", "km"};
    static const double si[] = {1.0, 1e-3, 1e3};
    dice d = dice_of("starts beyond", 4141);
    for (unsigned i = 0; i < 40; i++) {
        const unsigned unit = dice_one_of(&d, 3);
        const bool rate = i % 2 == 0;
        const bool beyond = i % 4 < 2;
        const double size = pow(10.0, beyond ? dice_between(&d, 15.1, 30.0) : 3.0) / si[unit];
        char text[300];
        said what;
        snprintf(text, sizeof text,
                 "mechanism far\ncoordinate x [%s]\nT = 1 [kg]*x'^2/2\n"
                 "scene s { start x%s = %.17g [%s%s]; step 1 [ms]; until 1 [s] }\n",
                 units[unit], rate ? "'" : "", i % 3 == 0 ? -size : size, units[unit],
                 rate ? "/s" : "");
        const char *words[] = {model_keep(text), "--quiet", "--number",
                               dice_one_of(&d, 2) == 0 ? "float" : "double", NULL};
        command_say(command_run, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(beyond ? 1 : 0, what.status, text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(beyond, strstr(what.err, "it starts beyond them") != NULL,
                                      what.err);
        TEST_ASSERT_TRUE_MESSAGE(
            strstr(what.err, "would do") == NULL && strstr(what.err, "--step") == NULL, what.err);
    }
    model_drop();
}

void suite_divergence(void) {
    RUN_TEST(test_motion_that_ends_in_infinity);
    RUN_TEST(test_every_method_stops);
    RUN_TEST(test_an_input_that_is_no_number);
    RUN_TEST(test_an_angle_that_turns_too_fast_for_the_step);
    RUN_TEST(test_starts_beyond_all_bounds);
}

/* test_hard_cases.c: cases that are hard for an integrator (docs/hard, docs/hard_cases.md), each against a closed form or
 * the same energies in numbers (linkage.h): a motor too weak for the resonance that it must pass (Sommerfeld), an inertia
 * that all but vanishes, hops on a moving floor that come to an end, a table that falls away faster than what lies on
 * it, fast rotation. */
#include <math.h>
#include <stdio.h>

#include "linkage.h"
#include "motion.h"
#include "unity.h"

void suite_hard_cases(void);

#define HARD "docs/hard/"

/* --- resonance ------------------------------------------------------------------------------------------------- */

/* A carriage of 10 kg between springs, 20 rad/s by itself, and on it a rotor with an eccentric mass, which a motor of
 * so much torque would take to 60 rad/s. */
static linkage shaker(double torque_Nm) {
    linkage of = {.bodies = 2};
    of.body[0] = (linkage_body){.parent = -1,
                                .slides = true,
                                .mass_kg = 9.5,
                                .inertia_kgm2 = 1.0,
                                .stiffness = 4000.0,
                                .damping = 4.0,
                                .wave = 1.0};
    of.body[1] = (linkage_body){.parent = 0,
                                .mass_kg = 0.5,
                                .centre_m = 0.125,
                                .inertia_kgm2 = 0.0625,
                                .damping = torque_Nm / 60.0,
                                .drive = torque_Nm};
    return of;
}

/* The rotor's speed after 12 s, as the reference has it, */
static double reference_after(double torque_Nm) {
    const linkage of = shaker(torque_Nm);
    linkage_motion wanted;
    linkage_integrate(&of, 1e-3, 12000, &wanted);
    return (double)wanted.state[LINKAGE_BODIES + 1];
}

/* and as the program has it. */
static double speed_after(double torque_Nm, stepping how) {
    char stall[40];
    motion m;
    snprintf(stall, sizeof stall, "stall=%.17g", torque_Nm);
    how.set = stall;
    motion_open_file(&m, HARD "sommerfeld.whirl", "", "shaker_stays", how);
    motion_to(&m, 12.0);
    const double speed = motion_value(&m, "a'");
    motion_close(&m);
    return speed;
}

static void test_a_motor_at_a_resonance(void) {
    const double weak_reference = reference_after(0.25);
    const double strong_reference = reference_after(1.5);
    const double weak = speed_after(0.25, IN_DOUBLE);
    const double strong = speed_after(1.5, IN_DOUBLE);
    const double in_float = speed_after(0.25, IN_FLOAT_COMPENSATED);
    printf("  0.25 N m: %.4f rad/s, off by %.1e, in float by %.1e; 1.5 N m: %.4f, off by %.1e\n",
           weak, weak - weak_reference, in_float - weak_reference, strong,
           strong - strong_reference);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, weak_reference, weak);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, strong_reference, strong);
    TEST_ASSERT_DOUBLE_WITHIN(1e-2, weak_reference, in_float);
    TEST_ASSERT_TRUE(weak > 17.0 && weak < 21.0); /* it does not get past */
    TEST_ASSERT_TRUE(strong > 40.0);
}

/* --- almost no inertia ----------------------------------------------------------------------------------------- */

/* A disc on a pivot without friction at a pendulum's end: it goes on turning as it did, however small its inertia is
 * beside the pendulum's, whose coordinate takes part in its angle. */
static void test_a_disc_of_hardly_any_inertia(void) {
    double worst[2] = {0.0, 0.0};
    for (int k = 0; k <= 12; k += 3) {
        for (int real = 0; real < 2; real++) {
            linkage of = {.bodies = 2, .gravity_mps2 = {0.0, -9.875}};
            linkage_motion wanted;
            motion m;
            of.body[0] = (linkage_body){
                .parent = -1, .mass_kg = 2.0, .centre_m = 0.5, .inertia_kgm2 = 0.125, .wave = 1.0};
            of.body[1] = (linkage_body){.parent = 0,
                                        .relative = true,
                                        .at_m = 1.0,
                                        .mass_kg = 1.0,
                                        .inertia_kgm2 = pow(10.0, -k),
                                        .wave = 1.0};
            of.start_rate[1] = 5.0;
            char inertia[40];
            snprintf(inertia, sizeof inertia, "I=%.17g", of.body[1].inertia_kgm2);
            motion_open_file(&m, HARD "disc.whirl", "", "disc_swings",
                             (stepping){.kind = real == 0 ? &engine_double : &engine_float,
                                        .method = WH_RK4,
                                        .set = inertia});
            motion_to(&m, 2.0);
            linkage_integrate(&of, 1e-3, 2000, &wanted);
            const double spin = motion_value(&m, "q'") + motion_value(&m, "s'");
            const double swing = motion_value(&m, "q");
            worst[real] =
                fmax(worst[real], fmax(fabs(spin - 5.0), fabs(swing - (double)wanted.state[0])));
            motion_close(&m);
        }
    }
    printf("  inertia 1 to 1e-12 kg m^2: off by at most %.1e in double, %.1e in float\n", worst[0],
           worst[1]);
    TEST_ASSERT_TRUE(worst[0] < 1e-11);
    TEST_ASSERT_TRUE(worst[1] < 2e-3);
}

/* --- floors that move ------------------------------------------------------------------------------------------ */

static void open_table(motion *m, double A_m, double w_radps, double height_m, double restitution,
                       double step_s) {
    char more[400];
    snprintf(more, sizeof more,
             "scene drawn {\nset A = %.17g [m], w = %.17g [rad/s], h0 = %.17g [m], e = %.17g\n"
             "start f = -A, b = h0 - A\nuntil 5 [s]\n}\n",
             A_m, w_radps, height_m, restitution);
    motion_open_file(m, HARD "moving_floor.whirl", more, "drawn", IN_DOUBLE_STEP(step_s));
}

static void test_hops_on_a_moving_floor_end(void) {
    motion m;
    open_table(&m, 0.05, 10.0, 0.3, 0.5, 1e-3); /* 5 m/s^2: what lies on it stays there */
    motion_to(&m, 2.0);
    for (int k = 0; k < 3000; k++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, motion_value(&m, "b") - motion_value(&m, "f"));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, motion_value(&m, "b'") - motion_value(&m, "f'"));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, -0.05 * cos(50.0), motion_value(&m, "b"));
    motion_close(&m);
}

/* It leaves a ball behind when it falls faster than that: cos(w t) = -g/(A w^2). */
static void test_a_table_falls_away(void) {
    for (int k = 0; k < 5; k++) {
        const double A = 0.02 + 0.01 * k;
        const double w = 30.0;
        const double leaves = acos(-9.81 / (A * w * w)) / w;
        const double t = 0.02; /* of flight */
        const double at = leaves + t;
        const double wanted =
            -A * cos(w * leaves) + A * w * sin(w * leaves) * t - 9.81 * t * t / 2.0;
        motion m;
        const double step = at / 128.0; /* ends on the moment that is looked at */
        open_table(&m, A, w, 0.0, 0.0, step);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 128));
        TEST_ASSERT_TRUE(motion_value(&m, "b") > motion_value(&m, "f"));
        TEST_ASSERT_DOUBLE_WITHIN(1e-8, wanted, motion_value(&m, "b"));
        motion_close(&m);
    }
}

/* --- fast rotation --------------------------------------------------------------------------------------------- */

static void test_fast_rotation(void) {
    for (int k = 0; k < 5; k++) {
        const double rate = 600.0 * (k + 1) + 17.0 * k; /* up to 3068 rad/s: 0.49 turns a step */
        char start[60];
        motion m;
        snprintf(start, sizeof start, "th'=%.17g", rate);
        motion_open_file(&m, HARD "rotor.whirl", "", "rotor_fast",
                         (stepping){.kind = &engine_float, .method = WH_RK4, .start = start});
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 100000));
        /* a step's part of a turn is rounded to 2^-32, and its rate and length are floats */
        const double turned = rate * 100.0;
        TEST_ASSERT_DOUBLE_WITHIN(turned * 1.3e-7 + 1e-4, turned, motion_value(&m, "th"));
        motion_close(&m);
    }
}

void suite_hard_cases(void) {
    RUN_TEST(test_a_motor_at_a_resonance);
    RUN_TEST(test_a_disc_of_hardly_any_inertia);
    RUN_TEST(test_hops_on_a_moving_floor_end);
    RUN_TEST(test_a_table_falls_away);
    RUN_TEST(test_fast_rotation);
}

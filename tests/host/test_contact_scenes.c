/* test_contact_scenes.c: every scene with contacts against a reference that another program located event by
 * event (tests/reference/contacts.txt), and how its error falls with the step; several contacts at once on
 * one mechanism among them.
 *
 * The location is on a cubic and the method of fourth order, so an error falls with h^4; what is asked is
 * third order, taken over a step that is quartered, for at one step errors of many events may happen to
 * cancel. */
#include "contacts.h"

#include <math.h>
#include <stdio.h>

#include "unity.h"

void suite_contact_scenes(void);

/* The references' own digits: two runs of theirs differ by at most 5e-10 (contacts.py prints it). */
#define REFERENCE_ERROR 1e-9

typedef struct reference_case {
    const char *name;
    const char *time;
    double time_s;
    double step_s;     /* coarse; fine is a quarter */
    double error_most; /* at the fine step, in double */
    /* at the scene's own step, in float: what 24 bits leave of a state of this size after so many steps,
     * times what its events make of it */
    double error_float;
} reference_case;

static const reference_case CASES[] = {
    {"hopper_hops", "0.05", 0.05, 5e-3, 1e-8, 2e-4},
    {"table_slips", "5.0", 5.0, 8e-3, 1e-8, 2e-4},
    {"table_drifts", "5.0", 5.0, 8e-3, 1e-8, 2e-4},
    {"belt_stick_slip", "5.0", 5.0, 8e-3, 1e-7, 2e-4},
    {"belt_stiffening", "5.0", 5.0, 8e-3, 1e-7, 2e-4},
    {"plank_shaken", "5.0", 5.0, 4e-3, 1e-8, 1e-2},
    {"crash_cart", "3.0", 3.0, 8e-3, 1e-6, 2e-4},
    {"crash_both", "3.0", 3.0, 8e-3, 1e-6, 2e-4},
    {"shuttle_buffers", "5.0", 5.0, 8e-3, 1e-8, 2e-4},
    {"shuttle_clamped", "5.0", 5.0, 8e-3, 1e-8, 2e-4},
    {"escapement_ticks", "60.0", 60.0, 8e-3, 1e-5, 1e-2},
    {"carriage_stop", "5.0", 5.0, 4e-3, 1e-6, 1e-2},
    {"carriage_stop_smooth", "5.0", 5.0, 4e-3, 1e-6, 1e-2},
    {"carriage_stop_start", "5.0", 5.0, 4e-3, 2e-9, 1e-2},
    {"thomson_magnet", "5.0", 5.0, 1e-3, 1e-6, 1e-2},
    {"halvorson_ground", "1.0", 1.0, 4e-4, 1e-5, 1e-2},
    {"halvorson_smooth", "1.0", 1.0, 4e-4, 1e-5, 1e-2},
};

enum { CASE_COUNT = sizeof CASES / sizeof CASES[0] };

static double error_of(const reference_case *c, stepping how) {
    motion m;
    motion_open(&m, c->name, how);
    motion_to(&m, c->time_s);
    const double error = contacts_error(&m, c->name, c->time);
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, contacts_overruns(&m), c->name);
    motion_close(&m);
    return error;
}

static void test_every_scene_meets_its_reference(void) {
    for (unsigned i = 0; i < CASE_COUNT; i++) {
        const reference_case *c = &CASES[i];
        const double coarse = error_of(c, IN_DOUBLE_STEP(c->step_s));
        const double fine = error_of(c, IN_DOUBLE_STEP(c->step_s / 4.0));
        const double order = log2(coarse / fine) / 2.0;
        printf("  %-22s error %.2e at %g ms, %.2e at %g ms: order %.2f\n", c->name, coarse,
               1e3 * c->step_s, fine, 250.0 * c->step_s, order);
        TEST_ASSERT_TRUE_MESSAGE(fine <= c->error_most, c->name);
        TEST_ASSERT_TRUE_MESSAGE(coarse > 1e-14, c->name); /* an error there must be */
        TEST_ASSERT_TRUE_MESSAGE(order >= 3.0 || fine <= REFERENCE_ERROR, c->name);
    }
}

static void test_every_scene_runs_in_float(void) {
    for (unsigned i = 0; i < CASE_COUNT; i++) {
        const reference_case *c = &CASES[i];
        const double error = error_of(c, IN_FLOAT);
        printf("  %-22s error %.2e\n", c->name, error);
        TEST_ASSERT_TRUE_MESSAGE(error <= c->error_float, c->name);
        TEST_ASSERT_TRUE_MESSAGE(error > 1e-9, c->name);
    }
}

/* --- several contacts on one coordinate --------------------------------------------------------------------- */

/* While it is clamped it stands, friction or no friction, buffer or no buffer. */
static void check_clamp(stepping how) {
    motion m;
    unsigned held = 0;
    unsigned moved = 0;
    motion_open(&m, "shuttle_clamped", how);
    double before = motion_value(&m, "x");
    for (uint64_t i = 0; i < contacts_steps(&m); i++) {
        const bool clamped = cos(motion_value(&m, "phi")) > sqrt(0.5) + 1e-2;
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double x = motion_value(&m, "x");
        if (clamped && cos(motion_value(&m, "phi")) > sqrt(0.5) + 1e-2) {
            held++;
            TEST_ASSERT_TRUE(x == before && motion_value(&m, "x'") == 0.0);
        } else {
            moved += fabs(x - before) > 0.0;
        }
        TEST_ASSERT_TRUE(x >= -0.1 - 1e-7 && x <= 0.15 + 1e-7);
        before = x;
    }
    motion_close(&m);
    TEST_ASSERT_TRUE(held > 2000 && moved > 2000);
}

static void test_clamped_carriage_stands(void) {
    check_clamp(IN_DOUBLE);
    check_clamp(IN_FLOAT);
}

/* Restitution 0 on the right: it stays at the buffer, exactly, until the push turns and beats static
 * friction: F_0 sin(phi) = -mu_s m g. */
static void test_carriage_leaves_the_buffer_when_the_push_beats_friction(void) {
    motion m;
    double leaves_s = -1.0;
    motion_open(&m, "shuttle_buffers", IN_DOUBLE);
    motion_to(&m, 5.0);
    double before = motion_value(&m, "x");
    for (unsigned i = 1; i <= 1000; i++) {
        motion_to(&m, 5.0 + 1e-3 * i);
        const double x = motion_value(&m, "x");
        if (before == 0.15 && x < 0.15 && leaves_s < 0.0) {
            leaves_s = 1e-3 * i;
        }
        before = x;
    }
    motion_close(&m);
    /* closed form; the step's end follows within a step */
    const double closed = 0.5 + asin(0.3 * 9.81 / 8.0) / (2.0 * acos(-1.0));
    expect_between("leaves the buffer at, s into the turn", closed, closed + 1e-3, leaves_s);
}

/* A pendulum on a cart, dry friction under the cart and in the joint, a stop each: both come to rest, and stay
 * to the bit, the joint within the band that its friction holds. */
static const char TWO_FRICTIONS[] =
    "mechanism two\ncoordinate q [rad]\ncoordinate X [m]\nparameter g = 9.81 [m/s^2]\n"
    "T = 1 [kg]*((X' + 0.5 [m]*q'*cos(q))^2 + (0.5 [m]*q'*sin(q))^2)/2 + 2 [kg]*X'^2/2\n"
    "V = -1 [kg]*g*0.5 [m]*cos(q)\nfriction X static 0.2 kinetic 0.15 normal 3 [kg]*g\n"
    "friction q static 0.1 kinetic 0.05 normal 1 [N*m]\nstop X >= -0.02 [m] restitution 0.3\n"
    "stop q <= 0.7 restitution 0.6\nscene s {\n  start q = -1.2, X = 0\n  step 1 [ms]\n}\n";

static void rest_of_two(stepping how, double *q, double *X) {
    motion m;
    motion_open_text(&m, TWO_FRICTIONS, how);
    motion_to(&m, 20.0);
    *q = motion_value(&m, "q");
    *X = motion_value(&m, "X");
    const uint64_t events = contacts_events(&m);
    motion_to(&m, 30.0);
    TEST_ASSERT_TRUE(motion_value(&m, "q") == *q && motion_value(&m, "X") == *X);
    TEST_ASSERT_TRUE(motion_value(&m, "q'") == 0.0 && motion_value(&m, "X'") == 0.0);
    TEST_ASSERT_EQUAL_UINT64(events, contacts_events(&m));
    TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
    motion_close(&m);
}

static void test_two_frictions_come_to_rest(void) {
    double q[3];
    double X[3];
    rest_of_two(IN_DOUBLE, &q[0], &X[0]);
    rest_of_two(IN_DOUBLE_STEP(2.5e-4), &q[1], &X[1]);
    rest_of_two(IN_FLOAT, &q[2], &X[2]);
    expect_between("torque at rest over the joint's static friction", -1.0, 1.0,
                   9.81 * 0.5 * sin(q[0]) / 0.1);
    TEST_ASSERT_TRUE(X[0] > 0.2);
    /* the same with a quarter of the step: fourth order, 1e-8 at the places before they are stopped by
     * friction of 0.05 N m and more; in float what 24 bits leave */
    expect_between("joint, off the quarter step's, rad", 0.0, 1e-7, fabs(q[0] - q[1]));
    expect_between("cart, off the quarter step's, m", 0.0, 1e-7, fabs(X[0] - X[1]));
    expect_between("joint in float, rad", 0.0, 2e-5, fabs(q[2] - q[1]));
    expect_between("cart in float, m", 0.0, 2e-5, fabs(X[2] - X[1]));
}

/* Kick and drag agree: what is lost in a period is what a kick gives. */
static void test_escapement_reaches_its_amplitude(void) {
    const double d = 2e-5 / (2.0 * 1e-4);
    const double w = sqrt(0.01 / 1e-4 - d * d);
    const double settled = 0.5 / (1.0 - exp(-2.0 * acos(-1.0) * d / w));
    const double start_left = exp(-2.0 * acos(-1.0) * d / w * 95.0);
    motion m;
    double most = 0.0;
    motion_open(&m, "escapement_ticks", IN_DOUBLE);
    motion_to(&m, 59.0);
    for (unsigned i = 0; i < 1000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double theta = motion_value(&m, "theta");
        const double rate = motion_value(&m, "theta'");
        /* the rate at the crossing, from the spiral's invariant */
        const double x = w * theta;
        const double y = rate + d * theta;
        if (theta >= 0.0 && rate > 0.0) {
            most = fmax(most, hypot(x, y) * exp(d * atan2(x, y) / w));
        }
    }
    /* 95 kicks: the geometric series' rest */
    const double after = settled + (1.0 - settled) * start_left;
    expect_between("rate after a kick over the closed form", 1.0 - 1e-6, 1.0 + 1e-6, most / after);
    /* floor(60 w/(2 pi)), and none at the start */
    TEST_ASSERT_EQUAL_UINT64(95, contacts_events(&m));
    motion_close(&m);
}

void suite_contact_scenes(void) {
    RUN_TEST(test_every_scene_meets_its_reference);
    RUN_TEST(test_every_scene_runs_in_float);
    RUN_TEST(test_clamped_carriage_stands);
    RUN_TEST(test_carriage_leaves_the_buffer_when_the_push_beats_friction);
    RUN_TEST(test_two_frictions_come_to_rest);
    RUN_TEST(test_escapement_reaches_its_amplitude);
}

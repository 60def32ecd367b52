/* test_contact_devices.c: the devices of the dissertation that need a stop, friction or a hold: the carriage
 * beside a stop (row S18, test 3), Thomson's magnet (S10), Halvorson's vehicle (S12). */
#include "contacts.h"

#include <math.h>
#include <stdio.h>

#include "unity.h"

void suite_contact_devices(void);

/* What the project asks of a centre of mass that nothing pushes, m. */
#define DRIFT_MOST 1e-8

static double pi(void) { return acos(-1.0); }

/* --- S18, test 3 ----------------------------------------------------------------------------------------- */

#define LB 0.45359237
#define INCH 0.0254
#define ECCENTRIC_KG (2.0 * (0.152 + 0.15) * LB)
#define ALL_KG (4.0 * ECCENTRIC_KG)                                     /* weight ratio 1/3 */
#define MOMENT_KG_M (2.0 * LB * INCH * (0.152 * 7.25 / 2 + 0.15 * 6.5)) /* sum of m r */

/* Largest and least X over `turns` turns from now on. A turn is no whole number of steps, so that of twenty
 * turns some step comes within a twentieth of one to the swing's end: (0.05 w h)^2/2, 2e-6 of the swing. */
static void swing(motion *m, double turns, double *least, double *most) {
    const double until = motion_value(m, "theta") + turns * 2.0 * pi();
    *least = HUGE_VAL;
    *most = -HUGE_VAL;
    while (motion_value(m, "theta") < until) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(m, 1));
        *least = fmin(*least, motion_value(m, "X"));
        *most = fmax(*most, motion_value(m, "X"));
    }
}

static void check_walk(stepping how, double swing_bound, double speed_most) {
    motion m;
    double least;
    double most;
    motion_open(&m, "carriage_stop", how);
    double nearest = motion_value(&m, "X");
    for (unsigned i = 0; i < 55000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        nearest = fmin(nearest, motion_value(&m, "X"));
    }
    const double theta = motion_value(&m, "theta");
    const double x_cm = motion_value(&m, "x_cm");
    swing(&m, 20.0, &least, &most);
    const double w = motion_value(&m, "theta'");
    const double speed =
        (motion_value(&m, "x_cm") - x_cm) * w / (motion_value(&m, "theta") - theta);
    motion_close(&m);
    printf("  %s: at last between %.6f and %.6f m\n", how.kind->name, least, most);
    /* the stop: nothing is behind it; a float's location leaves some 2^-24 of the step's way */
    expect_between("  nearest to the stop, m", -1e-9, 1e-3, nearest);
    /* walked away: further than it swings */
    expect_between("  mean place at last, m", 10.0 * MOMENT_KG_M / ALL_KG, 10.0,
                   (least + most) / 2.0);
    /* the project's result, m r/(m + M), which holds without friction; friction is a 1/80 of the force
     * here, and its effect on the swing is of second order */
    const double free = MOMENT_KG_M / ALL_KG;
    expect_between("  swing over m r/(m + M)", 1.0 - 1e-3, 1.0 + 1e-3, (most - least) / 2.0 / free);
    /* closed form (Den Hartog, Forced vibrations with combined Coulomb and viscous friction, 1931, without a
     * spring): sqrt(1 - (pi f/2 F)^2) of it, f the friction, F the force's amplitude */
    const double ratio = 0.05 * ALL_KG * 9.80665 / (MOMENT_KG_M * w * w);
    const double closed = free * sqrt(1.0 - pi() * pi() * ratio * ratio / 4.0);
    expect_between("  swing over the closed form, less 1", -swing_bound, swing_bound,
                   (most - least) / 2.0 / closed - 1.0);
    /* friction brakes the mean motion at a rate of 2 mu g/(pi swing w) = 0.28 a second: exp(-15) of 2 m/s */
    expect_between("  mean velocity at last, m/s", -speed_most, speed_most, speed);
}

static void test_carriage_walks_away_from_the_stop_and_then_only_swings(void) {
    /* see swing(); the closed form's speed is constant, the motor's ripples by 1e-5 */
    check_walk(IN_DOUBLE, 2e-5, 1e-5);
    /* X near 6 m in 24 bits: 2^-22 m in each of half a turn's 90 sums, of 0.064 m, as a random walk */
    check_walk(IN_FLOAT, 1e-4, 1e-4);
}

static void test_without_friction_it_walks_on(void) {
    motion m;
    motion_open(&m, "carriage_stop_smooth", IN_DOUBLE);
    motion_to(&m, 5.0);
    TEST_ASSERT_EQUAL_UINT64(1, contacts_events(&m)); /* one impact turns it round */
    const double x_cm = motion_value(&m, "x_cm");
    const double p = motion_value(&m, "momentum");
    motion_to(&m, 10.0);
    TEST_ASSERT_EQUAL_UINT64(1, contacts_events(&m));
    /* the momentum stays what the stop made it, and the centre of mass goes with it; the project's bound */
    expect_between("S18: momentum's change, kg m/s", -DRIFT_MOST, DRIFT_MOST,
                   motion_value(&m, "momentum") - p);
    expect_between("S18: centre of mass off the momentum's way, m", -DRIFT_MOST, DRIFT_MOST,
                   motion_value(&m, "x_cm") - x_cm - 5.0 * p / ALL_KG);
    TEST_ASSERT_TRUE(p > 1.0);
    motion_close(&m);
}

static void test_started_at_the_stop_it_walks_away_too(void) {
    motion m;
    double least;
    double most;
    double nearest = 0.0;
    motion_open(&m, "carriage_stop_start", IN_DOUBLE);
    for (unsigned i = 0; i < 58000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        nearest = fmin(nearest, motion_value(&m, "X"));
    }
    swing(&m, 8.0, &least, &most);
    expect_between("S18, from rest: nearest to the stop, m", -1e-12, 0.0, nearest);
    expect_between("S18, from rest: swing over m r/(m + M)", 1.0 - 1e-3, 1.0 + 1e-3,
                   (most - least) / 2.0 / (MOMENT_KG_M / ALL_KG));
    TEST_ASSERT_TRUE(least > MOMENT_KG_M / ALL_KG);
    motion_close(&m);
}

/* --- S10 ------------------------------------------------------------------------------------------------- */

/* Kinetic energy of one unit with the spin of disc 33, from the velocities of the discs' centres. */
static double kinetic_J(const motion *m) {
    const double r = 0.3;
    const double a = motion_value(m, "theta1");
    const double b = motion_value(m, "theta2");
    const double w = motion_value(m, "theta1'");
    const double u = motion_value(m, "theta2'");
    const double X = motion_value(m, "X'");
    const double bx = X - 2 * r * w * sin(a);
    const double by = 2 * r * w * cos(a);
    const double dx = bx - 2 * r * w * sin(2 * a) - r * u * sin(b);
    const double dy = by + 2 * r * w * cos(2 * a) + r * u * cos(b);
    const double spin = 2.0 * r * r / 4.0 * (4 * w * w + u * u); /* I/2 each */
    return X * X + bx * bx + by * by + dx * dx + dy * dy + spin;
}

static void check_magnet(const char *which, double drift_most, double gain_most, stepping how) {
    motion m;
    motion_open(&m, which, how);
    const double x_cm = motion_value(&m, "x_cm");
    double drift = 0.0;
    double book = 0.0; /* energy less the motor's work */
    double gain = 0.0;
    double X_least = 0.0;
    double X_most = 0.0;
    unsigned held = 0;
    uint64_t events = 0;
    for (uint64_t i = 0; i < contacts_steps(&m); i++) {
        const double twice = 2.0 * motion_value(&m, "theta1");
        const double before = motion_value(&m, "theta2");
        const bool holds = fmin(sin(twice), cos(twice)) > 0.0;
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        if (holds && contacts_events(&m) == events) {
            held++;
            TEST_ASSERT_TRUE(motion_value(&m, "theta2") == before);
            TEST_ASSERT_TRUE(motion_value(&m, "theta2'") == 0.0);
        }
        events = contacts_events(&m);
        const double now = kinetic_J(&m) + 2.0 * motion_value(&m, "theta1"); /* M = -2 N m */
        gain = fmax(gain, now - book);
        book = now;
        drift = fmax(drift, fabs(motion_value(&m, "x_cm") - x_cm));
        X_least = fmin(X_least, motion_value(&m, "X"));
        X_most = fmax(X_most, motion_value(&m, "X"));
    }
    const double turns = -motion_value(&m, "theta1") / pi(); /* of the hinge */
    printf("  %s, %s: %.2f turns of the hinge, held for %u steps, %.3g J lost, X %.4f to %.4f m\n",
           which, how.kind->name, turns, held, -book, X_least, X_most);
    expect_between("  centre of mass, largest distance from its start, m", 0.0, drift_most, drift);
    /* captured and let go once a turn */
    expect_between("  captures and releases over turns", 2.0 * (turns - 1.0), 2.0 * turns + 1.0,
                   (double)events);
    /* a magnet that only holds gives no energy; the captures take some */
    expect_between("  energy gained in a step, most, J", 0.0, gain_most, gain);
    expect_between("  energy that captures took, J", 1.0, 100.0, -book);
    /* closed form of X with the centre of mass at rest: r/3 (6 - 4 cos - cos - cos), 0 to 1.2 m */
    TEST_ASSERT_TRUE(X_least > -1e-6 && X_most < 1.2 && X_most > 0.5);
    motion_close(&m);
}

static void test_magnet_moves_no_centre_of_mass(void) {
    check_magnet("thomson_magnet", DRIFT_MOST, 1e-9, IN_DOUBLE);
    check_magnet("thomson_magnet_conserved", 1e-14, 1e-9, IN_DOUBLE);
    /* 40000 sums of X rounded by 2^-24 of a metre, as a random walk: 1.2e-5 m; energy, 30 J: 2^-22 of it, and
     * of the velocities' roundings */
    check_magnet("thomson_magnet", 5e-5, 2e-4, IN_FLOAT);
}

/* --- S12 ------------------------------------------------------------------------------------------------- */

/* Mean velocity from 5 to 10 s. */
static double creep(double h) {
    motion m;
    motion_open(&m, "halvorson_ground", IN_DOUBLE_STEP(h));
    motion_to(&m, 5.0);
    const double X = motion_value(&m, "X");
    motion_to(&m, 10.0);
    const double speed = (motion_value(&m, "X") - X) / 5.0;
    motion_close(&m);
    return speed;
}

static void test_vehicle_creeps_on_the_ground(void) {
    const double reference = (contacts_reference("halvorson_ground", "10.0", "X") -
                              contacts_reference("halvorson_ground", "5.0", "X")) /
                             5.0;
    double before = 0.0;
    for (unsigned i = 0; i < 3; i++) {
        const double h = 4e-4 / (double)(1U << i);
        const double speed = creep(h);
        const double off = fabs(speed / reference - 1.0);
        printf("  %g ms: %.10g mm/s, off the reference by %.1e\n", 1e3 * h, 1e3 * speed, off);
        /* forwards, by millimetres a second, whatever the step */
        expect_between("S12: mean velocity on the ground, mm/s", 16.0, 18.0, 1e3 * speed);
        if (i > 0) {
            expect_between("  order", 3.0, 6.0, log2(before / off));
        }
        before = off;
    }
    expect_between("S12: off the reference at 0.1 ms", 0.0, 1e-7, before); /* own choice */
}

static void check_creep_in_float(void) {
    motion m;
    motion_open(&m, "halvorson_ground", IN_FLOAT);
    motion_to(&m, 10.0);
    /* X to 0.2 m in sums of 50000 steps: 2^-25 of 0.2 m each at the very worst is 3e-4 m */
    const double off = motion_value(&m, "X") - contacts_reference("halvorson_ground", "10.0", "X");
    expect_between("S12, float: X at 10 s off the reference, m", -3e-4, 3e-4, off);
    motion_close(&m);
}

static void test_ground_pushes_and_nothing_else(void) {
    motion m;
    motion_open(&m, "halvorson_smooth", IN_DOUBLE);
    const double start = motion_value(&m, "x_cm");
    double drift = 0.0;
    double momentum = 0.0;
    double X_least = 0.0;
    double X_most = 0.0;
    for (uint64_t i = 0; i < contacts_steps(&m); i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        drift = fmax(drift, fabs(motion_value(&m, "x_cm") - start));
        momentum = fmax(momentum, fabs(motion_value(&m, "momentum")));
        X_least = fmin(X_least, motion_value(&m, "X"));
        X_most = fmax(X_most, motion_value(&m, "X"));
    }
    motion_close(&m);
    expect_between("S12, smooth: centre of mass, largest distance, m", 0.0, DRIFT_MOST, drift);
    expect_between("S12, smooth: momentum, most, kg m/s", 0.0, DRIFT_MOST, momentum);
    /* it shakes all the same */
    expect_between("S12, smooth: X's span, mm", 0.1, 5.0, 1e3 * (X_most - X_least));
    check_creep_in_float();
}

/* The normal force pulsates round the weight, and the ground is never left. */
static void test_normal_force_pulsates_round_the_weight(void) {
    range r = {.name = "normal"};
    motion m;
    double sum = 0.0;
    unsigned looks = 0;
    motion_open(&m, "halvorson_ground", IN_DOUBLE);
    motion_to(&m, 5.0);
    const double turn = motion_value(&m, "theta") + 100.0 * 2.0 * pi();
    r.least = HUGE_VAL;
    r.most = 0.0;
    while (motion_value(&m, "theta") < turn) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double N = motion_value(&m, "normal");
        sum += N;
        looks++;
        r.least = fmin(r.least, N);
        r.most = fmax(r.most, N);
    }
    motion_close(&m);
    expect_between("S12: normal force, least, N", 0.1, 10.0, r.least);
    expect_between("S12: normal force, most, N", 15.0, 30.0, r.most);
    /* nothing moves up or down for good: its mean is the weight, 1.33 kg; a hundred turns, cut at a step */
    expect_between("S12: mean normal force over the weight", 1.0 - 1e-4, 1.0 + 1e-4,
                   sum / looks / (1.33 * 9.81));
}

void suite_contact_devices(void) {
    RUN_TEST(test_carriage_walks_away_from_the_stop_and_then_only_swings);
    RUN_TEST(test_without_friction_it_walks_on);
    RUN_TEST(test_started_at_the_stop_it_walks_away_too);
    RUN_TEST(test_magnet_moves_no_centre_of_mass);
    RUN_TEST(test_vehicle_creeps_on_the_ground);
    RUN_TEST(test_ground_pushes_and_nothing_else);
    RUN_TEST(test_normal_force_pulsates_round_the_weight);
}

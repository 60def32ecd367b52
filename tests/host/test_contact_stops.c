/* test_contact_stops.c: balls on stops (core/models/contacts.whirl), with closed forms. */
#include "contacts.h"

#include "command.h"
#include "host/cli/commands.h"

#define G 9.81

/* Finds the first moment of rest, then checks a minute of rest. */
static void check_rest(stepping how, double height_most) {
    motion m;
    double rest_s = 0.0;
    double worst = 0.0;
    double bounced = 1.0;
    unsigned bounces = 0;
    motion_open(&m, "ball_bounces", how);
    const uint64_t steps = contacts_steps(&m);
    uint64_t events = 0;
    for (uint64_t i = 1; i <= steps; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double z = motion_value(&m, "z");
        const double v = motion_value(&m, "z'");
        const bool rests = z == 0.0 && v == 0.0;
        if (rests && rest_s <= 0.0) {
            rest_s = (double)i * 1e-3;
        }
        TEST_ASSERT_TRUE_MESSAGE(rests || rest_s <= 0.0, "left the stop again");
        if (contacts_events(&m) != events && !rests) {
            /* energy gives the height of this bounce; closed form: e^2 of the previous height */
            TEST_ASSERT_EQUAL_UINT64_MESSAGE(1, contacts_events(&m) - events, "two bounces a step");
            bounced *= 0.25;
            bounces++;
            worst = fmax(worst, fabs(z + v * v / (2.0 * G) - bounced));
        }
        events = contacts_events(&m);
    }
    TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
    motion_close(&m);
    printf("  %s\n", how.kind->name);
    /* closed form: the bounces' times are a geometric series, sqrt(2 h/g) (1 + e)/(1 - e) */
    const double closed = 3.0 * sqrt(2.0 / G);
    expect_between("  at rest after, s", closed - 1e-3, closed + 1e-3, rest_s);
    expect_between("  bounces whose height was looked at", 8.0, 14.0, bounces);
    expect_between("  height after a bounce, off by, m", 0.0, height_most, worst);
}

TEST(contact_stops, ball_comes_to_rest_and_stays_for_a_minute) {
    check_rest(IN_DOUBLE, 1e-6); /* the project's bound */
    /* 450 sums of the first fall, each rounded by at most 2^-24 of 4.4 m/s: 1.2e-4 m/s, times v/g */
    check_rest(IN_FLOAT, 5.3e-5);
}

/* A curved stop: a particle slides down a frictionless dome of 1 m in Cartesian coordinates. It leaves the dome when
 * contact would need a pull. */
static const char DOME[] =
    "mechanism dome\ncoordinate x [m]\ncoordinate y [m]\nparameter g = 9.81 [m/s^2]\n"
    "T = 1 [kg]*(x'^2 + y'^2)/2\nV = 1 [kg]*g*y\nstop sqrt(x^2 + y^2) >= 1 [m] restitution 0\n"
    "scene slide {\n  start x = 0, y = 1 [m], x' = 0.5 [m/s], y' = 0\n  step 1 [ms]\n}\n";

static double check_dome(stepping how, double off_most, double speed_most) {
    motion m;
    double off = 0.0;
    motion_open_text(&m, DOME, how);
    while (contacts_events(&m) == 0) {
        off = fmax(off, fabs(hypot(motion_value(&m, "x"), motion_value(&m, "y")) - 1.0));
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
    }
    /* closed form: at cos = 2/3 + v0^2/(3 g R), with v^2 = g R cos; in flight x' = v cos is constant */
    const double c = 2.0 / 3.0 + 0.25 / (3.0 * G);
    const double vx = motion_value(&m, "x'");
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 50));
    TEST_ASSERT_TRUE(motion_value(&m, "x'") == vx);
    TEST_ASSERT_EQUAL_UINT64(1, contacts_events(&m));
    const double error = fabs(vx - sqrt(G * c) * c);
    printf("  %s, %g ms\n", how.kind->name, 1e3 * m.instance->step_s);
    expect_between("  dome: off it before lifting off, m", 0.0, off_most, off);
    expect_between("  dome: speed along x after lifting off, off by, m/s", 0.0, speed_most, error);
    motion_close(&m);
    return error;
}

TEST(contact_stops, particle_leaves_the_dome_where_the_force_turns) {
    /* the gap is zero after each step within round-off. RK4 with a rate constant sqrt(g/R) = 3.1: (3.1 h)^4/120, times
     * a second of it and the speed */
    const double coarse = check_dome(IN_DOUBLE_STEP(8e-3), 1e-12, 1e-7);
    const double fine = check_dome(IN_DOUBLE_STEP(2e-3), 1e-12, 1e-9);
    expect_between("  order", 3.0, 5.5, log2(coarse / fine) / 2.0);
    /* 2^-24 of 1 m; 500 sums of the speed rounded by it */
    check_dome(IN_FLOAT, 3e-7, 3e-5);
}

/* Two blocks dropped on each other: the lower one rattles between floor and upper one, with more bounces than a step
 * takes. Both come to rest in their correct places. */
static const char STACK[] =
    "mechanism stack\ncoordinate a [m]\ncoordinate b [m]\nparameter g = 9.81 [m/s^2]\n"
    "T = 1 [kg]*a'^2/2 + 2 [kg]*b'^2/2\nV = 1 [kg]*g*a + 2 [kg]*g*b\n"
    "stop a >= 0 [m] restitution 0.5\nstop b >= a + 0.1 [m] restitution 0.5\n"
    "scene s {\n  start a = 0.5 [m], b = 1 [m]\n  step 1 [ms]\n}\n";

static void check_stack(stepping how, double height_most) {
    motion m;
    motion_open_text(&m, STACK, how);
    motion_to(&m, 2.0);
    const uint64_t events = contacts_events(&m);
    const double height = motion_value(&m, "b");
    for (unsigned i = 0; i < 10000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        TEST_ASSERT_TRUE(motion_value(&m, "a") == 0.0 && motion_value(&m, "a'") == 0.0);
        TEST_ASSERT_TRUE(motion_value(&m, "b") == height && motion_value(&m, "b'") == 0.0);
    }
    TEST_ASSERT_EQUAL_UINT64(events, contacts_events(&m));
    expect_between("stack: overruns", 0.0, 5.0, (double)contacts_overruns(&m));
    expect_between("stack: upper block's height off 0.1 m", 0.0, height_most, fabs(height - 0.1));
    motion_close(&m);
}

TEST(contact_stops, stacked_blocks_come_to_rest) {
    check_stack(IN_DOUBLE, 1e-16); /* the last place of 0.1 m */
    check_stack(IN_FLOAT, 8e-9);
}

TEST(contact_stops, too_many_bounces_are_told_and_end) {
    motion m;
    motion_open(&m, "ball_between", IN_DOUBLE);
    const double start = motion_value(&m, "energy");
    for (uint64_t i = 0; i < contacts_steps(&m); i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double z = motion_value(&m, "z");
        TEST_ASSERT_TRUE(z >= -1e-12 && z <= 1e-3 + 1e-12);
        TEST_ASSERT_TRUE(motion_value(&m, "energy") <= start * (1.0 + 1e-9));
    }
    TEST_ASSERT_TRUE(contacts_overruns(&m) >= 1);
    motion_close(&m);
    /* a step short enough for its bounces handles all of them: 25 m/s over 1 mm are 25000 per second */
    motion_open(&m, "ball_between", IN_DOUBLE_STEP(2e-5));
    motion_to(&m, 0.1);
    TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
    /* closed form: E goes as v^2, and 1 mm of height takes 4e-4 m/s: 2500 to the bounce */
    expect_between("bounces in 0.1 s", 2498.0, 2502.0, (double)contacts_events(&m));
    expect_between("energy kept", 1.0 - 1e-9, 1.0 + 1e-9, motion_value(&m, "energy") / start);
    motion_close(&m);
}

/* The restitution of the balls depends on the impact speed. A warning must appear where it is outside 0 to 1, and only there. */
TEST(contact_stops, a_restitution_out_of_bounds_is_told) {
    dice d = dice_of("contact_stops", 5);
    const unsigned cases = dice_cases(24);
    unsigned told = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[400];
        const double height = dice_between(&d, 0.1, 2.0);
        const double speed = sqrt(2.0 * G * height);
        const double e = dice_between(&d, -0.6, 1.6);
        const double slope = dice_between(&d, -0.2, 0.2); /* it starts at e - slope speed */
        const double begin = e - slope * speed;
        snprintf(text, sizeof text,
                 "mechanism ball\ncoordinate z [m]\nT = 1 [kg]*z'^2/2\nV = 9.81 [N]*z\n"
                 "stop z >= 0 restitution %.17g + %.17g [s/m]*abs(z')\n"
                 "scene s {\n  start z = %.17g [m]\n  until %.17g [s]\n}\n",
                 begin, slope, height, speed / G + 0.01);
        said what;
        command_say_model(command_run, text, &what);
        const char *warning = strstr(what.err, "the restitution was outside 0 .. 1 in 1 impact");
        const bool outside = e < 0.0 || e > 1.0;
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        TEST_ASSERT_TRUE_MESSAGE((warning != NULL) == outside, text);
        if (warning != NULL) {
            double value;
            double begin_s;
            const char *rest = said_number(strstr(warning, "first ") + 6, &value);
            said_number(said_words(rest, "in the step after t ="), &begin_s);
            expect_between("restitution", e - 1e-5, e + 1e-5, value);
            expect_between("its step", speed / G - 1.001e-3, speed / G + 1e-6, begin_s);
            told++;
        }
    }
    TEST_ASSERT_TRUE(4 * told >= cases || cases < 24);
}

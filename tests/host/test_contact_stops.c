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
    const uint64_t steps = m.instance->steps;
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

TEST(contact_stops, too_many_bounces_are_told_and_end) {
    motion m;
    motion_open(&m, "ball_between", IN_DOUBLE);
    const double start = motion_value(&m, "energy");
    for (uint64_t i = 0; i < m.instance->steps; i++) {
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
        /* the body starts at the speed e - slope speed */
        const double slope = dice_between(&d, -0.2, 0.2);
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

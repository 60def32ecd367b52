/* test_contact_load.c: contacts that share one load (core/models/contacts_together.whirl), and resting contacts
 * that something other than a force disturbs: an assignment, an input. */
#include "contacts.h"

#include <math.h>
#include <stdio.h>

#include "unity.h"

void suite_contact_load(void);

#define G 9.81

static const stepping *each_number(int i) {
    static const stepping ways[] = {{.kind = &engine_double, .method = WH_RK4},
                                    {.kind = &engine_float, .method = WH_RK4},
                                    {.kind = &engine_float, .method = WH_RK4, .compensated = true}};
    return i < 3 ? &ways[i] : NULL;
}

/* --- who gives way ------------------------------------------------------------------------------------- */

/* The push is beyond the limit of either friction; but what the block's friction can pass on, 4.905 N, is less
 * than the plank's 5.886 N. */
static void test_the_weaker_friction_protects_the_other(void) {
    for (int i = 0; each_number(i) != NULL; i++) {
        motion m;
        motion_open(&m, "plank_stays", *each_number(i));
        motion_to(&m, 1.0);
        TEST_ASSERT_TRUE(motion_value(&m, "x") == 0.0 && motion_value(&m, "x'") == 0.0);
        /* closed form: (P/m - mk g) t^2/2; a thousand roundings of a sum */
        const double bound = each_number(i)->kind == &engine_float ? 1e-4 : 1e-12;
        expect_between("u over the closed form, less 1", -bound, bound,
                       motion_value(&m, "u") / (0.5 * (10.0 / 2.0 - 0.2 * G)) - 1.0);
        motion_close(&m);
    }
}

/* Three contacts on two coordinates: the forces are not unique, and no single split of the load may move what
 * the contacts can hold together. */
static void test_leaning_blocks_rest_exactly(void) {
    for (int i = 0; each_number(i) != NULL; i++) {
        motion m;
        motion_open(&m, "leaning_rests", *each_number(i));
        motion_to(&m, 2.0);
        const double x = motion_value(&m, "x");
        const double y = motion_value(&m, "y");
        const uint64_t events = contacts_events(&m);
        TEST_ASSERT_TRUE(motion_value(&m, "x'") == 0.0 && motion_value(&m, "y'") == 0.0);
        motion_to(&m, 60.0);
        TEST_ASSERT_TRUE(motion_value(&m, "x") == x && motion_value(&m, "y") == y);
        TEST_ASSERT_EQUAL_UINT64(events, contacts_events(&m));
        TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
        /* apart by the blocks' width, as near as its sum rounds */
        expect_between("y - x - w", -1e-7, 1e-7, y - x - 0.1);
        motion_close(&m);
    }
}

/* Frictions that only together carry what holds them together: capacities of 3.687 N each, load 6.710 N. */
static void test_frictions_add_up_through_a_hold(void) {
    static const char text[] =
        "mechanism coupled\ncoordinate x [m]\ncoordinate y [m]\nparameter m = 1 [kg]\n"
        "parameter g = 9.81 [m/s^2]\nparameter mu = 0.4\nparameter a = 20 [deg]\n"
        "T = m*(x'^2 + y'^2)/2\nV = -m*g*sin(a)*(x + y)\n"
        "hold y - x while y > -1 [m]\n"
        "friction x static mu kinetic 0.75*mu normal m*g*cos(a)\n"
        "friction y static mu kinetic 0.75*mu normal m*g*cos(a)\n"
        "scene s {\n  start x = 0, y = 10 [cm]\n  step 1 [ms]\n  until 10 [s]\n}\n";
    for (int i = 0; each_number(i) != NULL; i++) {
        motion m;
        stepping how = *each_number(i);
        motion_open_text(&m, text, how);
        motion_to(&m, 10.0);
        TEST_ASSERT_TRUE(motion_value(&m, "x") == 0.0);
        TEST_ASSERT_EQUAL_UINT64(0, contacts_events(&m));
        motion_close(&m);
        how.set = "mu=0.36"; /* 6.637 N together, kinetic 4.978 N: it slides */
        motion_open_text(&m, text, how);
        motion_to(&m, 10.0);
        const double slope = G * (sin(acos(-1.0) / 9.0) - 0.75 * 0.36 * cos(acos(-1.0) / 9.0));
        const double bound = how.kind == &engine_float ? 6e-4 : 1e-11;
        expect_between("x over the closed form, less 1", -bound, bound,
                       motion_value(&m, "x") / (50.0 * slope) - 1.0);
        motion_close(&m);
    }
}

/* --- corners --------------------------------------------------------------------------------------------- */

static const char *const GROOVES[][2] = {
    {"a=30 [deg]", "b=30 [deg]"}, {"a=45 [deg]", "b=45 [deg]"}, {"a=44 [deg]", "b=45 [deg]"},
    {"a=10 [deg]", "b=60 [deg]"}, {"a=60 [deg]", "b=60 [deg]"}, {"a=20 [deg]", "b=15 [deg]"}};

static void run_groove(const char *const slopes[2], const char *restitution,
                       const engine_kind *kind) {
    char more[300];
    motion m;
    snprintf(more, sizeof more,
             "scene groove_now {\n use groove\n with sides\n set %s, %s, %s\n"
             " start x = 5 [cm], y = 30 [cm]\n step 1 [ms]\n until 30 [s]\n}\n",
             slopes[0], slopes[1], restitution);
    motion_open_more(&m, "contacts_together.whirl", more,
                     (stepping){.kind = kind, .method = WH_RK4});
    motion_to(&m, 20.0);
    const uint64_t events = contacts_events(&m);
    printf("  %s, %s, %s, %s: %llu events, %llu overruns\n", slopes[0], slopes[1], restitution,
           kind->name, (unsigned long long)events, (unsigned long long)contacts_overruns(&m));
    /* at rest in the corner, where gravity and both sides leave nothing but what a product rounds */
    const double speed = hypot(motion_value(&m, "x'"), motion_value(&m, "y'"));
    TEST_ASSERT_TRUE(speed < 1e-15);
    TEST_ASSERT_TRUE(hypot(motion_value(&m, "x"), motion_value(&m, "y")) < 1e-15);
    TEST_ASSERT_TRUE(contacts_overruns(&m) <= 1);
    motion_to(&m, 30.0);
    TEST_ASSERT_EQUAL_UINT64(events, contacts_events(&m));
    motion_close(&m);
}

static void test_a_ball_comes_to_rest_in_a_groove(void) {
    for (unsigned i = 0; i < sizeof GROOVES / sizeof GROOVES[0]; i++) {
        run_groove(GROOVES[i], "e=0", &engine_double);
        run_groove(GROOVES[i], "e=0.5", &engine_double);
        run_groove(GROOVES[i], "e=0.5", &engine_float);
    }
}

/* Three carts, one after another, in plastic impacts, and nothing that presses them together. */
static void test_plastic_impacts_without_a_force(void) {
    static const char text[] =
        "mechanism carts\ncoordinate a [m]\ncoordinate b [m]\ncoordinate c [m]\n"
        "parameter m = 1 [kg]\nparameter w = 0.1 [m]\n"
        "T = m*(a'^2 + 2*b'^2 + 3*c'^2)/2\n"
        "stop b - a >= w restitution 0\nstop c - b >= w restitution 0\n"
        "scene s {\n  start a = 0, b = 0.4 [m], c = 0.8 [m], a' = 1 [m/s]\n"
        "  step 1 [ms]\n  until 10 [s]\n}\n";
    motion m;
    motion_open_text(&m, text, IN_DOUBLE);
    motion_to(&m, 10.0);
    TEST_ASSERT_EQUAL_UINT64(2, contacts_events(&m));
    TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
    expect_between("gap of a and b", -1e-12, 1e-12,
                   motion_value(&m, "b") - motion_value(&m, "a") - 0.1);
    expect_between("gap of b and c", -1e-12, 1e-12,
                   motion_value(&m, "c") - motion_value(&m, "b") - 0.1);
    expect_between("c' times 6, less 1", -1e-14, 1e-14, 6.0 * motion_value(&m, "c'") - 1.0);
    motion_close(&m);
}

/* --- what disturbs resting contacts ----------------------------------------------------------------------- */

#define FLOOR \
    "mechanism kicked\ncoordinate y [m]\ncoordinate c [rad]\nparameter m = 1 [kg]\n" \
    "parameter J = 1 [kg*m^2]\nparameter g = 9.81 [m/s^2]\ninput floor = 0 [m]\n" \
    "input e = 0.5\n" \
    "T = m*y'^2/2 + J*c'^2/2\nV = m*g*y\nstop y >= floor restitution e\n" \
    "scene s {\n  start y = 0, c' = 1 [rad/s]\n  with ledger\n  step 1 [ms]\n  until 4 [s]\n"

/* A ball at rest; when the clock c passes 0.5 s, `set`. Its height at `at_s`. */
static double height_after(const char *set, double at_s, const engine_kind *kind) {
    char text[600];
    motion m;
    snprintf(text, sizeof text, FLOOR "  when c crosses 0.5 rising { set %s }\n}\n", set);
    motion_open_text(&m, text, (stepping){.kind = kind, .method = WH_RK4});
    motion_to(&m, at_s);
    const double y = motion_value(&m, "y");
    motion_to(&m, 4.0);
    TEST_ASSERT_TRUE(motion_value(&m, "y") == 0.0 && motion_value(&m, "y'") == 0.0);
    TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
    motion_close(&m);
    return y;
}

static void test_an_assignment_lifts_or_throws_what_rests(void) {
    for (int i = 0; each_number(i) != NULL; i++) {
        const engine_kind *kind = each_number(i)->kind;
        const double bound = kind == &engine_float ? 1e-5 : 1e-9;
        expect_between("thrown up with 2 m/s, after 0.2 s", -bound, bound,
                       height_after("y' = 2 [m/s]", 0.7, kind) - (0.4 - 0.5 * G * 0.04));
        /* thrown down: back up with half of it */
        expect_between("thrown down with 4 m/s, after 0.2 s", -bound, bound,
                       height_after("y' = -4 [m/s]", 0.7, kind) - (0.4 - 0.5 * G * 0.04));
        expect_between("lifted by 1 m, after 0.2 s", -bound, bound,
                       height_after("y = 1 [m]", 0.7, kind) - (1.0 - 0.5 * G * 0.04));
        /* beyond the stop: put back onto it at once */
        expect_between("pushed through, after 0.2 s", 0.0, 0.0,
                       height_after("y = -1 [m]", 0.7, kind));
    }
}

static void test_an_input_moves_a_stop(void) {
    for (int i = 0; each_number(i) != NULL; i++) {
        motion m;
        motion_open_text(&m, FLOOR "}\n", *each_number(i));
        motion_to(&m, 0.5);
        m.kind->set_input(m.run, 0, -1.0);
        motion_to(&m, 0.7);
        const double bound = each_number(i)->kind == &engine_float ? 1e-5 : 1e-9;
        expect_between("fallen for 0.2 s", -bound, bound, motion_value(&m, "y") + 0.5 * G * 0.04);
        motion_to(&m, 3.0);
        TEST_ASSERT_TRUE(motion_value(&m, "y") == -1.0 && motion_value(&m, "y'") == 0.0);
        m.kind->set_input(m.run, 0, 0.5);
        motion_to(&m, 3.1);
        TEST_ASSERT_TRUE(motion_value(&m, "y") == 0.5 && motion_value(&m, "y'") == 0.0);
        motion_close(&m);
    }
}

/* Restitution beyond 0 ... 1, from an input, counts as the nearer end: no energy from nothing. */
static void test_restitution_has_its_range_while_running(void) {
    motion m;
    stepping how = IN_DOUBLE;
    how.start = "y=1";
    motion_open_text(&m, FLOOR "}\n", how);
    m.kind->set_input(m.run, 1, 1.5);
    double highest = 0.0;
    for (int i = 0; i < 4000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        highest = fmax(highest, motion_value(&m, "y"));
    }
    expect_between("highest", 0.99, 1.0 + 1e-12, highest);
    TEST_ASSERT_TRUE(contacts_events(&m) >= 4);
    motion_close(&m);
}

/* What a hold keeps is captured again, and booked: momentum m (2 - 0), energy m 2^2/2. */
static void test_a_hold_takes_what_an_assignment_gives(void) {
    static const char text[] =
        "mechanism held\ncoordinate x [m]\ncoordinate z [m]\ncoordinate c [rad]\n"
        "parameter m = 1 [kg]\nparameter J = 1 [kg*m^2]\nT = m*(x'^2 + z'^2)/2 + J*c'^2/2\n"
        "hold x - z while c < 2\n"
        "scene s {\n  with ledger\n  start c' = 1 [rad/s]\n"
        "  when c crosses 0.5 rising { set x' = 2 [m/s] }\n  step 1 [ms]\n  until 1 [s]\n}\n";
    motion m;
    double total[64] = {0.0};
    double left[8] = {0.0};
    motion_open_text(&m, text, IN_DOUBLE);
    motion_to(&m, 1.0);
    expect_between("x'", 1.0 - 1e-15, 1.0 + 1e-15, motion_value(&m, "x'"));
    expect_between("z'", 1.0 - 1e-15, 1.0 + 1e-15, motion_value(&m, "z'"));
    m.kind->ledger(m.run, total, left);
    expect_between("energy left over", -1e-14, 1e-14, left[0]);
    bool booked = false; /* what the capture took: half of what the assignment gave */
    for (int i = 0; i < 64; i++) {
        booked = booked || fabs(total[i] + 1.0) < 1e-14;
    }
    TEST_ASSERT_TRUE(booked);
    motion_close(&m);
}

/* Met exactly at a step's end, a crossing is located as well as anywhere: 0.5 = 32 steps of 1/64 s. */
static void test_a_crossing_at_a_steps_end_is_located(void) {
    static const char text[] =
        "mechanism clock\ncoordinate c [rad]\ncoordinate x [m]\nparameter J = 1 [kg*m^2]\n"
        "parameter m = 1 [kg]\nT = J*c'^2/2 + m*x'^2/2\n"
        "scene s {\n  start c' = 1 [rad/s], x' = 1 [m/s]\n"
        "  when x crosses 0.5 [m] rising { set x = 0 }\n  step 15.625 [ms]\n  until 0.875 [s]\n}\n";
    for (int i = 0; each_number(i) != NULL; i++) {
        motion m;
        motion_open_text(&m, text, *each_number(i));
        motion_to(&m, 0.875);
        const double bound = each_number(i)->kind == &engine_float ? 1e-7 : 1e-14;
        expect_between("x, less the closed form", -bound, bound, motion_value(&m, "x") - 0.375);
        motion_close(&m);
    }
}

void suite_contact_load(void) {
    RUN_TEST(test_the_weaker_friction_protects_the_other);
    RUN_TEST(test_leaning_blocks_rest_exactly);
    RUN_TEST(test_frictions_add_up_through_a_hold);
    RUN_TEST(test_a_ball_comes_to_rest_in_a_groove);
    RUN_TEST(test_plastic_impacts_without_a_force);
    RUN_TEST(test_an_assignment_lifts_or_throws_what_rests);
    RUN_TEST(test_an_input_moves_a_stop);
    RUN_TEST(test_restitution_has_its_range_while_running);
    RUN_TEST(test_a_hold_takes_what_an_assignment_gives);
    RUN_TEST(test_a_crossing_at_a_steps_end_is_located);
}

/* test_contact_friction.c: blocks that stick and slip (core/models/contacts.whirl). */
#include "contacts.h"
#include "test.h"

#define G 9.81

static double pi(void) { return acos(-1.0); }

static void check_incline_sticks(stepping how) {
    motion m;
    motion_open(&m, "incline_sticks", how);
    TEST_ASSERT_TRUE((double)contacts_steps(&m) * m.instance->step_s >= 600.0);
    for (uint64_t i = 0; i < contacts_steps(&m); i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        TEST_ASSERT_TRUE(motion_value(&m, "s") == 0.0 && motion_value(&m, "s'") == 0.0);
    }
    TEST_ASSERT_EQUAL_UINT64(0, contacts_events(&m));
    motion_close(&m);
}

TEST(contact_friction, block_sticks_for_ten_minutes) {
    check_incline_sticks(IN_DOUBLE);
    check_incline_sticks(IN_FLOAT);
    check_incline_sticks(IN_FLOAT_COMPENSATED);
}

/* Coefficients to either side of tan 10 degrees. */
TEST(contact_friction, block_sticks_up_to_the_slope) {
    for (int side = -1; side <= 1; side += 2) {
        motion m;
        char set[64];
        stepping how = IN_DOUBLE;
        snprintf(set, sizeof set, "mu=%.17g", tan(pi() / 18.0) * (1.0 + 1e-9 * side));
        how.set = set;
        motion_open(&m, "incline_slides", how);
        motion_to(&m, 10.0);
        if (side > 0) {
            TEST_ASSERT_TRUE(motion_value(&m, "s") == 0.0);
        } else {
            /* closed form: g sin 10 deg 1e-9 t^2/2, of a difference of two numbers rounded to 2e-16 */
            const double slides = G * sin(pi() / 18.0) * 1e-9 * 50.0;
            expect_between("slides by, just below, over the closed form", 1.0 - 1e-6, 1.0 + 1e-6,
                           motion_value(&m, "s") / slides);
        }
        motion_close(&m);
    }
}

static void check_incline_slides(stepping how, double bound) {
    motion m;
    const double slope = G * (sin(pi() / 18.0) - 0.15 * cos(pi() / 18.0));
    motion_open(&m, "incline_slides", how);
    motion_to(&m, 10.0);
    printf("  %s\n", how.kind->name);
    expect_between("  s' after 10 s over the closed form, less 1", -bound, bound,
                   motion_value(&m, "s'") / (slope * 10.0) - 1.0);
    expect_between("  s over the closed form, less 1", -bound, bound,
                   motion_value(&m, "s") / (slope * 50.0) - 1.0);
    motion_close(&m);
}

TEST(contact_friction, block_slides_with_the_closed_forms_acceleration) {
    /* 10^4 sums rounded by 2^-53: 1.1e-12 at the very worst; the same with 2^-24; a few round-offs of the
     * acceleration */
    check_incline_slides(IN_DOUBLE, 1e-12);
    check_incline_slides(IN_FLOAT, 6e-4);
    check_incline_slides(IN_FLOAT_COMPENSATED, 2e-6);
}

static void check_thrown(stepping how, double bound) {
    motion m;
    motion_open(&m, "incline_thrown", how);
    /* closed form: braked by g (sin + mu cos), over v^2/2 of that */
    const double brake = G * (sin(pi() / 18.0) + 0.5 * cos(pi() / 18.0));
    motion_to(&m, ceil(2.0 / brake * 1e3) * 1e-3);
    const double where = motion_value(&m, "s");
    TEST_ASSERT_TRUE(motion_value(&m, "s'") == 0.0);
    expect_between("thrown: where it stops, off the closed form, m", 0.0, bound,
                   fabs(where + 2.0 / brake));
    for (unsigned i = 0; i < 4000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        TEST_ASSERT_TRUE(motion_value(&m, "s") == where && motion_value(&m, "s'") == 0.0);
    }
    TEST_ASSERT_EQUAL_UINT64(1, contacts_events(&m));
    motion_close(&m);
}

TEST(contact_friction, thrown_block_stays_where_it_stops) {
    /* 215 sums rounded by 2^-53 (2^-24) of 2 m/s, which act over 0.2 s, and as many of s */
    check_thrown(IN_DOUBLE, 1e-12);
    check_thrown(IN_FLOAT, 4e-5);
}

static void check_table_sticks(stepping how) {
    motion m;
    motion_open(&m, "table_sticks", how);
    for (uint64_t i = 0; i < contacts_steps(&m); i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        TEST_ASSERT_TRUE(motion_value(&m, "s") == 0.0 && motion_value(&m, "s'") == 0.0);
    }
    motion_close(&m);
}

/* mu_s g/w^2 is the largest amplitude without slip. */
TEST(contact_friction, block_slips_from_the_closed_forms_amplitude_on) {
    const double w = 4.0 * pi();
    for (int side = -1; side <= 1; side += 2) {
        motion m;
        char set[64];
        stepping how = IN_DOUBLE;
        snprintf(set, sizeof set, "A=%.17g m", 0.4 * G / (w * w) * (1.0 + 1e-4 * side));
        how.set = set;
        motion_open(&m, "table_sticks", how);
        motion_to(&m, 1.0);
        TEST_ASSERT_TRUE((contacts_events(&m) > 0) == (side > 0));
        TEST_ASSERT_TRUE((fabs(motion_value(&m, "s")) > 0.0) == (side > 0));
        motion_close(&m);
    }
    check_table_sticks(IN_DOUBLE);
    check_table_sticks(IN_FLOAT);
}

/* Breaks loose at sin(w t) = mu_s g/(A w^2), then slides with the table's acceleration minus mu_k g. Its speed a step
 * later yields the time of that. */
TEST(contact_friction, slip_begins_where_the_closed_form_says) {
    const double w = 4.0 * pi();
    const double A = 0.040;
    const double onset = asin(0.4 * G / (A * w * w)) / w;
    motion m;
    motion_open(&m, "table_slips", IN_DOUBLE);
    while (contacts_events(&m) == 0) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
    }
    const double t = (double)m.kind->steps(m.run) * 1e-3;
    const double v = motion_value(&m, "s'");
    motion_close(&m);
    double low = t - 1e-3;
    double high = t;
    for (unsigned i = 0; i < 60; i++) {
        const double t0 = 0.5 * (low + high);
        const double speed = A * w * (cos(w * t0) - cos(w * t)) - 0.3 * G * (t - t0);
        low = speed > v ? t0 : low;
        high = speed > v ? high : t0;
    }
    /* the push is a sine of a linear phase, located exactly: some dozens of round-offs, of 1e-16 over the margin's
     * slope and of the speed over its acceleration */
    expect_between("slip begins off the closed form, s", 0.0, 1e-13, fabs(low - onset));
    /* and not at a step's end */
    TEST_ASSERT_TRUE(fabs(onset * 1e3 - floor(onset * 1e3 + 0.5)) > 0.01);
}

TEST(contact_friction, net_drift) {
    motion m;
    motion_open(&m, "table_slips", IN_DOUBLE);
    motion_to(&m, 5.0);
    const double s = motion_value(&m, "s");
    motion_to(&m, 10.0);
    /* closed form: the second half period mirrors the first */
    expect_between("even shaking: drift in ten periods, m", -1e-9, 1e-9, motion_value(&m, "s") - s);
    motion_close(&m);
    motion_open(&m, "table_drifts", IN_DOUBLE);
    motion_to(&m, 5.0);
    const double u = motion_value(&m, "s");
    motion_to(&m, 10.0);
    const double drift = motion_value(&m, "s") - u;
    const double wanted = contacts_reference("table_drifts", "10.0", "s") -
                          contacts_reference("table_drifts", "5.0", "s");
    printf("  uneven shaking: %.9g m in ten periods\n", drift);
    /* chosen here: a millionth */
    expect_between("uneven shaking: drift over the reference's", 1.0 - 1e-6, 1.0 + 1e-6,
                   drift / wanted);
    TEST_ASSERT_TRUE(wanted < -0.2);
    motion_close(&m);
}

/* Each sticking phase carries it along the belt between two spots; these are one period of the belt apart. From spot
 * `first` on: mean, least and largest distance, as times. */
static void periods(const char *which, stepping how, double *mean, double *least, double *most) {
    motion m;
    double spot[64];
    unsigned spots = 0;
    motion_open(&m, which, how);
    for (uint64_t i = 0; i < contacts_steps(&m); i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double s = motion_value(&m, "s");
        const bool sticks = motion_value(&m, "s'") == 0.0;
        if (sticks && (spots == 0 || s != spot[spots - 1]) && spots < 64) {
            spot[spots++] = s;
        }
    }
    motion_close(&m);
    TEST_ASSERT_TRUE(spots > 10);
    *least = HUGE_VAL;
    *most = 0.0;
    for (unsigned i = 2; i < spots; i++) { /* from the start to the second spot is no whole cycle */
        const double period = (spot[i - 1] - spot[i]) / 0.1;
        *least = fmin(*least, period);
        *most = fmax(*most, period);
    }
    *mean = (spot[1] - spot[spots - 1]) / 0.1 / (spots - 2);
}

static void check_belt(const char *which, double wanted, stepping how, double bound) {
    double mean;
    double least;
    double most;
    periods(which, how, &mean, &least, &most);
    printf("  %s, %s: period %.12g s (%.12g to %.12g), reference %.12g\n", which, how.kind->name,
           mean, least, most, wanted);
    expect_between("  mean period over the reference, less 1", -bound, bound, mean / wanted - 1.0);
    expect_between("  least", -bound, bound, least / wanted - 1.0);
    expect_between("  most", -bound, bound, most / wanted - 1.0);
}

TEST(contact_friction, stick_slip_period) {
    /* closed form: 2 D/v of sticking, then pi + 2 atan(v/(w D)) of the spring's cycle */
    const double D = 0.1 * G / 100.0;
    const double closed = 2.0 * D / 0.1 + (pi() + 2.0 * atan(0.1 / (10.0 * D))) / 10.0;
    const double reference = contacts_reference("belt_stick_slip", "period", "T");
    expect_between("reference against the closed form", -1e-12, 1e-12, reference / closed - 1.0);
    check_belt("belt_stick_slip", closed, IN_DOUBLE, 1e-4); /* the project's bound */
    check_belt("belt_stick_slip", closed, IN_FLOAT_COMPENSATED, 1e-4);
    /* without compensation the belt's own place, up to 1 m in sums of 0.1 mm, has errors up to 2^-25 m per step: 3e-4
     * of its speed */
    check_belt("belt_stick_slip", closed, IN_FLOAT, 3e-4);
    const double stiffer = contacts_reference("belt_stiffening", "period", "T");
    check_belt("belt_stiffening", stiffer, IN_DOUBLE, 1e-4);
    check_belt("belt_stiffening", stiffer, IN_FLOAT_COMPENSATED, 1e-4);
    check_belt("belt_stiffening", stiffer, IN_FLOAT, 3e-4);
    /* compensation is better: RK4 with w h = 0.01 (0.02) */
    check_belt("belt_stick_slip", closed, IN_DOUBLE, 1e-9);
    check_belt("belt_stiffening", stiffer, IN_DOUBLE, 1e-8);
}

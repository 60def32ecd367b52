/* test_contact_friction.c: blocks that stick and slip (core/models/contacts.whirl). */
#include "contacts.h"
#include "test.h"

#define G 9.81

static double pi(void) { return acos(-1.0); }

/* A block that sticks does not move, to the bit. */
static void check_sticks(const char *name, stepping how) {
    motion m;
    motion_open(&m, name, how);
    for (uint64_t i = 0; i < m.instance->steps; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        TEST_ASSERT_TRUE(motion_value(&m, "s") == 0.0 && motion_value(&m, "s'") == 0.0);
    }
    TEST_ASSERT_EQUAL_UINT64(0, contacts_events(&m));
    motion_close(&m);
}

/* The incline's scene lasts ten minutes. */
TEST(contact_friction, blocks_stick) {
    static const char *const scenes[] = {"incline_sticks", "table_sticks"};
    for (int i = 0; i < 2; i++) {
        check_sticks(scenes[i], IN_DOUBLE);
        check_sticks(scenes[i], IN_FLOAT);
        check_sticks(scenes[i], IN_FLOAT_COMPENSATED);
    }
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
}

/* test_slow_angles.c: float angles whose steps are too small for their units must cause a warning; no other angles
 * must. The reference is the same run in double. WH_SLOW=N sets the number of random rotors. */
#include "host/check/slow.h"
#include "motion.h"

#define UNIT_RAD (6.283185307179586477 / 4294967296.0)

static uint64_t seed_now;

static double random_share(void) { /* the random generator xorshift64 (Marsaglia, 2003) */
    seed_now ^= seed_now << 13;
    seed_now ^= seed_now >> 7;
    seed_now ^= seed_now << 17;
    return (double)(seed_now >> 11) * 0x1p-53;
}

typedef struct outcome {
    double way_rad;
    bool told;
} outcome;

static outcome run(const char *text, stepping how, uint64_t steps) {
    motion m;
    motion_open_text(&m, text, how);
    const double start = motion_value(&m, "a");
    TEST_ASSERT_EQUAL_INT(1, m.image->angles);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, steps));
    const outcome result = {motion_value(&m, "a") - start, slow_component(m.kind, m.run, 0)};
    double share;
    TEST_ASSERT_EQUAL_INT(result.told, slow_count(m.kind, m.image, m.run, &share));
    motion_close(&m);
    return result;
}

static stepping in_float(wh_method method, bool compensated, double step_s) {
    return (stepping){
        .kind = &engine_float, .method = method, .compensated = compensated, .step_s = step_s};
}

static const char rotor[] = "mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\n"
                            "scene s { start a = %.17g, a' = %.17g [rad/s] }\n";

/* Whether there is a warning must depend on the angle's error at the end. The limits allow for round-off of rates
 * and constants, and for a larger error before the end. */
TEST(slow_angles, only_slow_rates_are_warned_of) {
    const char *wanted = getenv("WH_SLOW");
    const int count = wanted != NULL ? (int)strtol(wanted, NULL, 10) : 300;
    int told = 0;
    int silent = 0;
    seed_now = UINT64_C(0x510a);
    printf("  %d rotors, seed %" PRIx64, count, seed_now);
    for (int i = 0; i < count; i++) {
        /* steps of 1e-13 to 1e-3 rad and 1 us to 1 s, in both directions */
        const double step_rad =
            (i % 2 != 0 ? -1.0 : 1.0) * pow(10.0, -13.0 + 10.0 * random_share());
        const double step_s = pow(10.0, -6.0 + 6.0 * random_share());
        const double start_rad = 6.0 * random_share();
        const uint64_t steps = (uint64_t)pow(10.0, 1.0 + 3.7 * random_share());
        char text[320];
        snprintf(text, sizeof text, rotor, start_rad, step_rad / step_s);
        const wh_method method = (wh_method)(i / 2 % WH_METHODS);
        const outcome plain = run(text, in_float(method, false, step_s), steps);
        const outcome cured = run(text, in_float(method, true, step_s), steps);
        const double way_rad = step_rad * (double)steps;
        const double off_rad = fabs(plain.way_rad - way_rad);
        char what[200];
        snprintf(what, sizeof what,
                 "%.3g rad a step, %" PRIu64 " steps: off by %.3g of %.3g rad, %s", step_rad, steps,
                 off_rad, way_rad, plain.told ? "told" : "not told");
        if (off_rad > 1.1e-3 * fabs(way_rad) && off_rad > 3 * UNIT_RAD) {
            TEST_ASSERT_TRUE_MESSAGE(plain.told, what);
        } else if (off_rad < 0.9e-3 * fabs(way_rad) || off_rad < 1.5 * UNIT_RAD) {
            TEST_ASSERT_FALSE_MESSAGE(plain.told, what);
        }
        told += plain.told;
        silent += !plain.told;
        TEST_ASSERT_FALSE_MESSAGE(cured.told, what);
        TEST_ASSERT_TRUE_MESSAGE(
            fabs(cured.way_rad - way_rad) < 1e-6 * fabs(way_rad) + 2 * UNIT_RAD, what);
    }
    printf(": %d told, %d not\n", told, silent);
    TEST_ASSERT_TRUE(told > count / 5 && silent > count / 5);
}

static const struct {
    const char *name;
    const char *text;
    double step_s;
    uint64_t steps;
    bool told;
} others[] = {
    {"at rest",
     "mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nV = -1 [J]*cos(a)\nscene s { }\n",
     1e-3, 100000, false},
    {"swings, and is slow at each end",
     "mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nV = -9 [J]*cos(a)\n"
     "scene s { start a = 0.5 }\n",
     1e-4, 100000, false},
    {"swings by a tenth of a milliradian",
     "mechanism m\ncoordinate a [rad]\n"
     "T = 1 [kg*m^2]*a'^2/2\nV = -9 [J]*cos(a)\nscene s { start a = 1e-4 }\n",
     1e-3, 20000, false},
    {"swings by less than a step can resolve",
     "mechanism m\ncoordinate a [rad]\n"
     "T = 1 [kg*m^2]*a'^2/2\nV = -9 [J]*cos(a)\nscene s { start a = 1e-7 }\n",
     1e-3, 20000, true},
    {"fast, then creeping to a stop",
     "mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nF = 5 [N*m*s]*a'^2/2\n"
     "scene s { start a' = 3 [rad/s] }\n",
     1e-3, 20000, false},
    {"fast, then creeping on for long",
     "mechanism m\ncoordinate a [rad]\ninput w = 5e-7 [rad/s]\nT = 1 [kg*m^2]*a'^2/2\n"
     "F = 500 [N*m*s]*(a' - w)^2/2\nscene s { start a' = 5e-2 [rad/s] }\n",
     1e-3, 300000, true},
    {"given by a first-order equation",
     "mechanism m\nstate a [rad]\nequation a' = 3e-7 [rad/s]*(2 + cos(a))\nscene s { }\n", 1e-3,
     20000, true},
    {"the same, ten thousand times as fast",
     "mechanism m\nstate a [rad]\nequation a' = 3e-3 [rad/s]*(2 + cos(a))\nscene s { }\n", 1e-3,
     20000, false},
    {"sliding, slowed by friction that it never feels again",
     "mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\n"
     "friction a static 2e-9 kinetic 1e-9 normal 1 [N*m]\n"
     "scene s { start a' = 4e-7 [rad/s] }\n",
     1e-3, 20000, true},
};

TEST(slow_angles, only_wrong_motions_are_warned_of) {
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        const outcome plain =
            run(others[i].text, in_float(WH_RK4, false, others[i].step_s), others[i].steps);
        const outcome cured =
            run(others[i].text, in_float(WH_RK4, true, others[i].step_s), others[i].steps);
        TEST_ASSERT_EQUAL_INT_MESSAGE(others[i].told, plain.told, others[i].name);
        TEST_ASSERT_FALSE_MESSAGE(cured.told, others[i].name);
    }
}

/* In a step with events, the run discards some tries, and only accepted tries must count. A second body crosses a
 * point in every third step, which must change nothing. */
TEST(slow_angles, steps_with_events_count_once) {
    static const char text[] = "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\n"
                               "T = 1 [kg*m^2]*a'^2/2 + 1 [kg]*x'^2/2\nV = 1e6 [N/m]*x^2/2\n"
                               "scene s { when x crosses 0 [m] { set x = 0 [m] }\n"
                               "start a' = %.17g [rad/s], x' = 1 [m/s]; step 1 [ms] }\n";
    static const double rates[] = {3e-7, 1e-6, 2e-6, 0.3};
    for (unsigned i = 0; i < 4; i++) {
        char filled[400];
        motion m;
        snprintf(filled, sizeof filled, text, rates[i]);
        motion_open_text(&m, filled, IN_FLOAT);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 2000));
        uint64_t overruns;
        TEST_ASSERT_TRUE(m.kind->events(m.run, &overruns) > 400);
        double span_rad;
        const double off_rad = m.kind->component_off(m.run, 0, &span_rad);
        const double way_rad = rates[i] * 2.0;
        TEST_ASSERT_TRUE(fabs(span_rad - way_rad) < 1e-5 * way_rad + UNIT_RAD);
        TEST_ASSERT_TRUE(fabs(off_rad - fabs(motion_value(&m, "a") - way_rad)) <
                         0.02 * off_rad + 1e-6 * way_rad);
        motion_close(&m);
    }
}

TEST(slow_angles, double_has_no_units) {
    char text[320];
    snprintf(text, sizeof text, rotor, 0.0, 1e-9);
    const outcome exact = run(text, IN_DOUBLE, 1000);
    TEST_ASSERT_FALSE(exact.told);
}

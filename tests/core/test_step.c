/* test_step.c: the step of every method in both forms: its order, with coupled rates, angles and lengths; and the
 * component that a refused step reports, for a fault at every stage. */
#include "core/scene.h"
#define WH_COORDS 4
#include "core/step.h"

#include "unity.h"

void suite_step(void);

enum { ANGLES = 2, COORDINATES = 4, VALUES = 6 };

static wh_angle angle[ANGLES];
static wh_real real[2 * COORDINATES];
static wh_real carry[3 * COORDINATES];
static wh_real input[COORDINATES];
static wh_state state = {.angle = angle, .real = real, .carry = carry, .input = input};

static void clear(void) {
    for (int i = 0; i < ANGLES; i++) {
        angle[i] = 0;
    }
    for (int i = 0; i < 2 * COORDINATES; i++) {
        real[i] = WH_R(0.0);
    }
    for (int i = 0; i < 3 * COORDINATES; i++) {
        carry[i] = WH_R(0.0);
    }
    for (int i = 0; i < COORDINATES; i++) {
        input[i] = WH_R(0.0);
    }
    state.fault = -1;
}

/* Computes the accelerations of a pendulum on a shaft and an oscillator coupled to it, with damping. All three parts of
 * the state are in both equations. */
static void swing(const void *model, const wh_phase *phase, const wh_real *linear,
                  const wh_real *rate, const wh_real *u, wh_real *accel) {
    wh_real sine;
    wh_real cosine;
    (void)model;
    (void)u;
    wh_sincos(phase[0], &sine, &cosine);
    accel[0] = -WH_R(2.0) * sine - WH_R(0.3) * rate[0] + linear[0] * cosine;
    accel[1] = -linear[0] + WH_R(0.5) * sine - WH_R(0.2) * rate[0] * rate[1];
    accel[2] = WH_R(0.7) * linear[0] - WH_R(2.0) * linear[1] - WH_R(0.3) * rate[1];
}

static void flow(const void *model, const wh_phase *phase, const wh_real *x, const wh_real *u,
                 wh_real *slope) {
    wh_real sine;
    wh_real cosine;
    (void)model;
    (void)u;
    wh_sincos(phase[0], &sine, &cosine);
    slope[0] = WH_R(1.0) + WH_R(0.5) * x[0] * sine;
    slope[1] = cosine - x[0] * x[0];
    slope[2] = x[0] - WH_R(0.5) * x[1];
}

static wh_status step(wh_form form, wh_method method, bool compensated, wh_real h) {
    return form == WH_SECOND_ORDER ? wh_step_second(NULL, swing, method, compensated, 1, 3,
                                                    (wh_two_part){h, WH_R(0.0)}, &state)
                                   : wh_step_first(NULL, flow, method, compensated, 1, 2,
                                                   (wh_two_part){h, WH_R(0.0)}, &state);
}

/* Computes the state after one second: angle in radians, then reals. */
static unsigned after_1s(wh_form form, wh_method method, bool compensated, unsigned count,
                         wh_real value[VALUES]) {
    const unsigned reals = form == WH_SECOND_ORDER ? 5 : 2;
    clear();
    angle[0] = wh_angle_from_rad(WH_R(0.7));
    for (unsigned i = 0; i < reals; i++) {
        real[i] = (i % 2 != 0 ? WH_R(0.4) : -WH_R(0.3)) + WH_R(0.1) * (wh_real)i;
    }
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(step(form, method, compensated, WH_R(1.0) / (wh_real)count) == WH_OK);
    }
    value[0] = wh_angle_to_rad(angle[0]);
    for (unsigned i = 0; i < reals; i++) {
        value[1 + i] = real[i];
    }
    return 1 + reals;
}

/* Returns the squared distance between a run with `count` steps and one with twice as many. */
static wh_real distance(wh_form form, wh_method method, bool compensated, unsigned count) {
    wh_real coarse[VALUES];
    wh_real fine[VALUES];
    wh_real sum = WH_R(0.0);
    const unsigned components = after_1s(form, method, compensated, count, coarse);
    after_1s(form, method, compensated, 2 * count, fine);
    for (unsigned i = 0; i < components; i++) {
        sum += (coarse[i] - fine[i]) * (coarse[i] - fine[i]);
    }
    return sum;
}

static void test_order_is_that_of_the_row_in_both_forms(void) {
    for (unsigned k = 0; k < 4 * WH_METHODS; k++) {
        const wh_method method = (wh_method)(k / 4);
        const wh_form form = k % 2 != 0 ? WH_FIRST_ORDER : WH_SECOND_ORDER;
        const bool compensated = k / 2 % 2 != 0;
        const unsigned order = wh_methods[method].order;
        /* In float, only coarse steps have errors above round-off. */
        const unsigned count = sizeof(wh_real) == 8 ? (order < 4 ? 512 : 64)
                               : order < 3          ? 32
                               : order < 4          ? 8
                               : order < 5          ? 4
                                                    : 2;
        const wh_real within = sizeof(wh_real) == 8 ? WH_R(1.1) : WH_R(2.5);
        if (form == WH_SECOND_ORDER && wh_methods[method].takes == WH_NO_RATES) {
            /* These accelerations depend on rates; tests/host/test_methods.c tests such methods. */
            continue;
        }
        if (!wh_method_takes(method, form)) {
            clear();
            real[0] = WH_R(0.25);
            TEST_ASSERT_TRUE(step(form, method, compensated, WH_R(0.125)) == WH_E_ARGUMENT);
            TEST_ASSERT_TRUE(real[0] == WH_R(0.25));
            continue;
        }
        const wh_real ratio = distance(form, method, compensated, count) /
                              distance(form, method, compensated, 2 * count);
        const wh_real wanted = (wh_real)(1U << (2 * order));
        TEST_ASSERT_TRUE_MESSAGE(ratio < within * wanted && wanted < within * ratio,
                                 wh_methods[method].word);
    }
}

static void pushed(const void *model, const wh_phase *phase, const wh_real *linear,
                   const wh_real *rate, const wh_real *u, wh_real *accel) {
    (void)model;
    (void)phase;
    (void)linear;
    (void)rate;
    for (int i = 0; i < COORDINATES; i++) {
        accel[i] = u[i];
    }
}

static void moved(const void *model, const wh_phase *phase, const wh_real *x, const wh_real *u,
                  wh_real *slope) {
    (void)model;
    (void)phase;
    (void)x;
    for (int i = 0; i < COORDINATES; i++) {
        slope[i] = u[i];
    }
}

/* Checks that the step is refused with this fault, or that it succeeds if `fault` is negative. A refused step leaves
 * the state unchanged. */
static void expect(wh_form form, wh_method method, bool compensated, wh_real h, int fault) {
    wh_angle angle_before[ANGLES];
    wh_real real_before[2 * COORDINATES];
    for (int i = 0; i < ANGLES; i++) {
        angle_before[i] = angle[i];
    }
    for (int i = 0; i < 2 * COORDINATES; i++) {
        real_before[i] = real[i];
    }
    const wh_status status =
        form == WH_SECOND_ORDER
            ? wh_step_second(NULL, pushed, method, compensated, ANGLES, COORDINATES,
                             (wh_two_part){h, WH_R(0.0)}, &state)
            : wh_step_first(NULL, moved, method, compensated, ANGLES, COORDINATES - ANGLES,
                            (wh_two_part){h, WH_R(0.0)}, &state);
    TEST_ASSERT_TRUE_MESSAGE(status == (fault < 0 ? WH_OK : WH_E_DIVERGED),
                             wh_methods[method].word);
    TEST_ASSERT_EQUAL_INT_MESSAGE(fault, state.fault, wh_methods[method].word);
    for (int i = 0; i < ANGLES && fault >= 0; i++) {
        TEST_ASSERT_TRUE(angle[i] == angle_before[i]);
    }
    for (int i = 0; i < 2 * COORDINATES && fault >= 0; i++) {
        TEST_ASSERT_TRUE(real[i] == real_before[i]);
    }
}

static void test_a_refused_step_of_second_order_names_the_component(void) {
    for (unsigned k = 0; k < 2 * WH_METHODS; k++) {
        const wh_method method = (wh_method)(k / 2);
        const bool compensated = k % 2 != 0;
        wh_real *linear = real;
        wh_real *rate = real + COORDINATES - ANGLES;
        for (int i = 0; i < ANGLES; i++) {
            /* an angle turns too fast, or only its acceleration is too large */
            clear();
            rate[i] = WH_R(3200.0);
            expect(WH_SECOND_ORDER, method, compensated, WH_R(0.001), i);
            clear();
            rate[i] = WH_R(3000.0);
            expect(WH_SECOND_ORDER, method, compensated, WH_R(0.001), -1);
            clear();
            input[i] = WH_R(1e9);
            const bool by_new_rates = wh_methods[method].order > 1 || method != WH_EULER;
            expect(WH_SECOND_ORDER, method, compensated, WH_R(0.001), by_new_rates ? i : -1);
        }
        for (int i = 0; i < COORDINATES - ANGLES; i++) {
            /* a position is out of bounds, or a rate */
            clear();
            linear[i] = WH_R(9e14);
            rate[ANGLES + i] = WH_R(9e14);
            expect(WH_SECOND_ORDER, method, compensated, WH_R(0.5), ANGLES + i);
            clear();
            rate[ANGLES + i] = WH_R(9.9e14);
            input[ANGLES + i] = WH_R(2e16);
            expect(WH_SECOND_ORDER, method, compensated, WH_R(0.001), COORDINATES + ANGLES + i);
        }
    }
}

static void test_a_refused_step_of_first_order_names_the_component(void) {
    for (unsigned k = 0; k < 2 * WH_METHODS; k++) {
        const wh_method method = (wh_method)(k / 2);
        const bool compensated = k % 2 != 0;
        for (int i = 0; i < COORDINATES && wh_method_takes(method, WH_FIRST_ORDER); i++) {
            clear();
            input[i] = i < ANGLES ? WH_R(3200.0) : WH_R(2e18);
            expect(WH_FIRST_ORDER, method, compensated, WH_R(0.001), i);
            clear();
            input[i] = i < ANGLES ? WH_R(3000.0) : WH_R(9e17);
            expect(WH_FIRST_ORDER, method, compensated, WH_R(0.001), -1);
        }
    }
}

void suite_step(void) {
    RUN_TEST(test_order_is_that_of_the_row_in_both_forms);
    RUN_TEST(test_a_refused_step_of_second_order_names_the_component);
    RUN_TEST(test_a_refused_step_of_first_order_names_the_component);
}

/* test_scene.c: starting and stepping hand-written scenes: a harmonic oscillator and a shaft. */
#include "core/scene.h"
#define WH_COORDS 2
#include "core/step.h"

#include "tests/suites.h"

/* x'' = -x + u. With u = 0, from x = 1 at rest: x = cos t. */
static void oscillator_accel(const void *model, const wh_phase *phase, const wh_real *linear,
                             const wh_real *rate, const wh_real *input, wh_real *accel) {
    (void)model;
    (void)phase;
    (void)rate;
    accel[0] = input[0] - linear[0];
}

static wh_status oscillator_advance(const wh_scene *scene, wh_state *state) {
    return wh_step_counted(wh_step_second(NULL, oscillator_accel, scene->method, scene->compensated,
                                          0, 1, (wh_two_part){scene->step_s, WH_R(0.0)}, state),
                           state);
}

/* A shaft that turns freely (angle) and a carriage whose acceleration is the input. */
static void shaft_accel(const void *model, const wh_phase *phase, const wh_real *linear,
                        const wh_real *rate, const wh_real *input, wh_real *accel) {
    (void)model;
    (void)phase;
    (void)linear;
    (void)rate;
    accel[0] = WH_R(0.0);
    accel[1] = input[0];
}

static wh_status shaft_advance(const wh_scene *scene, wh_state *state) {
    return wh_step_counted(wh_step_second(NULL, shaft_accel, scene->method, scene->compensated, 1,
                                          2, (wh_two_part){scene->step_s, WH_R(0.0)}, state),
                           state);
}

static const wh_angle shaft_angle[1] = {0};
/* x; rates of shaft and carriage */
static const wh_real shaft_real[3] = {WH_R(0.25), WH_R(100.0), WH_R(0.5)};
static const wh_real oscillator_real[2] = {WH_R(1.0), WH_R(0.0)};
static const wh_real no_input[1] = {WH_R(0.0)};

static wh_scene oscillator(wh_method method, bool compensated, wh_real step_s) {
    const wh_scene scene = {.name = "oscillator",
                            .form = WH_SECOND_ORDER,
                            .method = method,
                            .reals = 2,
                            .inputs = 1,
                            .compensated = compensated,
                            .step_s = step_s,
                            .start_real = oscillator_real,
                            .start_input = no_input,
                            .advance = oscillator_advance};
    return scene;
}

static wh_scene shaft(wh_method method) {
    const wh_scene scene = {.name = "shaft",
                            .form = WH_SECOND_ORDER,
                            .method = method,
                            .angles = 1,
                            .reals = 3,
                            .inputs = 1,
                            .step_s = WH_R(0.001),
                            .start_angle = shaft_angle,
                            .start_real = shaft_real,
                            .start_input = no_input,
                            .advance = shaft_advance};
    return scene;
}

static uint64_t memory[WH_STATE_WORDS(1, 3, 1)];
static wh_state state;

static bool start(const wh_scene *scene) {
    return wh_scene_start(scene, &state, memory, sizeof memory) == WH_OK;
}

static bool steps(const wh_scene *scene, unsigned count) {
    for (unsigned i = 0; i < count; i++) {
        if (wh_scene_step(scene, &state) != WH_OK) {
            return false;
        }
    }
    return true;
}

/* Many steps in one call give the same state as single steps, up to the last good one. */
TEST(scene, many_steps_are_steps) {
    const wh_scene scene = oscillator(WH_RK4, true, WH_R(0.25));
    TEST_ASSERT_TRUE(start(&scene));
    for (unsigned i = 0; i < 17; i++) {
        TEST_ASSERT_TRUE(wh_scene_step(&scene, &state) == WH_OK);
    }
    const uint64_t wanted = wh_scene_hash(&scene, &state);
    TEST_ASSERT_TRUE(start(&scene));
    TEST_ASSERT_TRUE(wh_scene_steps(&scene, &state, 0) == WH_OK && state.steps == 0);
    TEST_ASSERT_TRUE(wh_scene_steps(&scene, &state, 16) == WH_OK && state.steps == 16);
    TEST_ASSERT_TRUE(wh_scene_steps(&scene, &state, 1) == WH_OK);
    TEST_ASSERT_TRUE(wh_scene_hash(&scene, &state) == wanted);
    /* With this input a few steps exceed the bounds. */
    state.input[0] = WH_R(8e14);
    TEST_ASSERT_TRUE(wh_scene_steps(&scene, &state, 1000) == WH_E_DIVERGED);
    TEST_ASSERT_TRUE(state.steps > 17 && state.steps < 1000);
    const uint64_t last = state.steps;
    TEST_ASSERT_TRUE(wh_scene_steps(&scene, &state, 1000) == WH_E_DIVERGED && state.steps == last);
}

/* x' = u + 1. A first-order system has no rates, so methods that move the rates first are refused. */
static void constant_slope(const void *model, const wh_phase *phase, const wh_real *real,
                           const wh_real *input, wh_real *slope) {
    (void)model;
    (void)phase;
    (void)real;
    slope[0] = input[0] + WH_R(1.0);
}

static wh_status first_order_advance(const wh_scene *scene, wh_state *of) {
    return wh_step_counted(wh_step_first(NULL, constant_slope, scene->method, scene->compensated, 0,
                                         1, (wh_two_part){scene->step_s, WH_R(0.0)}, of),
                           of);
}

TEST(scene, unavailable_methods_are_refused) {
    for (unsigned i = 0; i < WH_METHODS; i++) {
        wh_scene scene = oscillator(WH_RK4, false, WH_R(0.25));
        scene.form = WH_FIRST_ORDER;
        scene.reals = 1;
        scene.advance = first_order_advance;
        TEST_ASSERT_TRUE(start(&scene));
        /* The method is checked even if it changes after the start. */
        scene.method = (wh_method)i;
        const bool has = wh_methods[i].takes == WH_ANY_SYSTEM;
        TEST_ASSERT_TRUE(has == (i != WH_SEMI_IMPLICIT_EULER && i != WH_LEAPFROG));
        const uint64_t before = wh_scene_hash(&scene, &state);
        TEST_ASSERT_TRUE(wh_scene_step(&scene, &state) == (has ? WH_OK : WH_E_ARGUMENT));
        TEST_ASSERT_TRUE((wh_scene_hash(&scene, &state) == before) == !has);
        state.steps = 77;
        TEST_ASSERT_TRUE(wh_scene_start(&scene, &state, memory, sizeof memory) ==
                         (has ? WH_OK : WH_E_ARGUMENT));
        TEST_ASSERT_TRUE((state.steps == 77) == !has);
    }
}

/* A number that is no method, for example from corrupted memory, is refused. */
TEST(scene, invalid_methods_are_refused) {
    for (unsigned i = 0; i < 3; i++) {
        wh_scene scene = oscillator(WH_RK4, false, WH_R(0.25));
        scene.method = (wh_method)(i == 0 ? (unsigned)WH_METHODS : 77U + 99U * i);
        state.steps = 5;
        TEST_ASSERT_TRUE(wh_scene_start(&scene, &state, memory, sizeof memory) == WH_E_ARGUMENT);
        TEST_ASSERT_TRUE(state.steps == 5);
        TEST_ASSERT_TRUE(wh_tableau_of(scene.method) == wh_tableau_of(WH_RK4));
    }
}

TEST(scene, start_restores_the_start_values) {
    const wh_scene scene = shaft(WH_RK4);
    TEST_ASSERT_TRUE(start(&scene));
    const uint64_t fresh = wh_scene_hash(&scene, &state);
    state.input[0] = WH_R(3.0);
    TEST_ASSERT_TRUE(steps(&scene, 10));
    TEST_ASSERT_TRUE(wh_scene_hash(&scene, &state) != fresh);
    TEST_ASSERT_TRUE(start(&scene));
    TEST_ASSERT_TRUE(wh_scene_hash(&scene, &state) == fresh);
    TEST_ASSERT_TRUE(state.input[0] == WH_R(0.0));
    TEST_ASSERT_TRUE(wh_scene_rates(&scene, &state) == state.real + 1);
}

TEST(scene, time_is_steps_times_step) {
    const wh_scene scene = oscillator(WH_RK4, false, WH_R(0.001));
    TEST_ASSERT_TRUE(start(&scene));
    TEST_ASSERT_TRUE(steps(&scene, 5000));
    TEST_ASSERT_TRUE(state.steps == 5000);
    TEST_ASSERT_TRUE(wh_scene_time_s(&scene, &state) == WH_R(5000.0) * WH_R(0.001));
}

TEST(scene, inputs_act_from_the_next_step_on) {
    const wh_scene scene = shaft(WH_SEMI_IMPLICIT_EULER);
    TEST_ASSERT_TRUE(start(&scene));
    TEST_ASSERT_TRUE(steps(&scene, 1));
    TEST_ASSERT_TRUE(state.real[2] == WH_R(0.5));
    state.input[0] = WH_R(2.0);
    TEST_ASSERT_TRUE(steps(&scene, 1));
    TEST_ASSERT_TRUE(state.real[2] == WH_R(0.5) + WH_R(0.001) * WH_R(2.0));
}

TEST(scene, angle_is_precise_after_many_turns) {
    const wh_scene scene = shaft(WH_RK4);
    TEST_ASSERT_TRUE(start(&scene));
    TEST_ASSERT_TRUE(steps(&scene, 10000));
    /* 100 rad/s for 10 s. Each step's 0.1 rad is rounded once to a real: that bounds the sum. */
#if WH_DOUBLE
    const double error = state.angle[0] - 1000.0;
    TEST_ASSERT_TRUE(WH_ABS(error) < 5.7e-10); /* 10000 sums; each has an error of up to 2^-44 */
#else
    const int64_t wanted = INT64_C(683565275576); /* 1000 rad * 2^32 / (2 pi), rounded */
    const int64_t error = state.angle[0] - wanted;
    /* 1000 rad * 2^-23, for the round-off of each step */
    TEST_ASSERT_TRUE(error < 81487 && error > -81487);
#endif
}

#if !WH_DOUBLE
/* Returns the error after 10 s in steps of 2^-10 s (exact in float). Round-off far exceeds RK4's own error of 1e-13. */
static wh_real error_at_10s(bool compensated) {
    const wh_scene scene = oscillator(WH_RK4, compensated, 1.0f / 1024.0f);
    if (!start(&scene) || !steps(&scene, 10240)) {
        return 1e9f;
    }
    const float x = state.real[0] - -0.83907152907645245f;
    const float v = state.real[1] - 0.54402111088936981f;
    return WH_SQRT(x * x + v * v);
}

static void test_compensated_sums_beat_plain_ones(void) {
    const float plain = error_at_10s(false);
    const float compensated = error_at_10s(true);
    TEST_ASSERT_TRUE(compensated < 2.4e-7f); /* two ulps of 1 */
    TEST_ASSERT_TRUE(20.0f * compensated < plain);
}
#endif

TEST(scene, hash_sees_every_part_of_the_state) {
    const wh_scene scene = shaft(WH_RK4);
    TEST_ASSERT_TRUE(start(&scene));
    state.real[0] = WH_R(0.0);
    const uint64_t before = wh_scene_hash(&scene, &state);
    state.real[0] = -WH_R(0.0);
    TEST_ASSERT_TRUE(wh_scene_hash(&scene, &state) != before);
    state.real[0] = WH_R(0.0);
    state.steps++;
    TEST_ASSERT_TRUE(wh_scene_hash(&scene, &state) != before);
    state.steps--;
    state.angle[0] += 1;
    TEST_ASSERT_TRUE(wh_scene_hash(&scene, &state) != before);
    state.angle[0] -= 1;
    TEST_ASSERT_TRUE(wh_scene_hash(&scene, &state) == before);
}

TEST(scene, statuses_have_unique_words) {
#define NAME(name, value, words) name,
    static const wh_status all[] = {WH_STATUS_ROWS(NAME)};
    for (unsigned i = 0; i < sizeof all / sizeof all[0]; i++) {
        TEST_ASSERT_TRUE(wh_status_text(all[i])[0] != '\0');
        for (unsigned j = 0; j < i; j++) {
            TEST_ASSERT_TRUE(wh_status_text(all[i]) != wh_status_text(all[j]));
        }
        TEST_ASSERT_TRUE(wh_status_text(all[i]) != wh_status_text((wh_status)1));
        TEST_ASSERT_TRUE(wh_status_text((wh_status)1)[0] != '\0');
    }
}

SUITE(scene) {
#if !WH_DOUBLE
    RUN_TEST(test_compensated_sums_beat_plain_ones);
#endif
}

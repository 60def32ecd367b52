/* test_stage_turn_ledger.c: ledgers of steps with rotated sines (core/step/stage_turn_ledger.h), and stages unrolled by
 * hand. A run with a ledger has the same bits as one without. The work of a torque equals the change of energy. A
 * refused step makes no entry. */
#include "core/scene.h"
#define WH_COORDS 2
#define WH_WAVES 1
#define WH_LEDGER_MAX 4
#define WH_ACCOUNTS_MAX 3
#define WH_UNROLL
#include "core/step/stage_turn_ledger.h"

#include "tests/suites.h"

enum { STEPS = 128 };
#define STEP_S WH_R(0.0078125)

/* A pendulum of 1 kg m^2 under a torque, and a carriage that a force pulls. */
static void turned_accel(const void *model, const wh_wave *pair, const wh_real *linear,
                         const wh_real *rate, const wh_real *input, wh_real *accel) {
    (void)model;
    (void)linear;
    (void)rate;
    accel[0] = input[0] - pair[0].sine;
    accel[1] = input[1];
}

static void powers(const void *model, const wh_phase *phase, const wh_real *linear,
                   const wh_real *rate, const wh_real *input, wh_real *power) {
    wh_real sine;
    wh_real cosine;
    (void)model;
    (void)linear;
    wh_sincos(phase[0], &sine, &cosine);
    power[0] = input[0] * rate[0];
    power[1] = input[0] - sine; /* force on the momentum */
    power[2] = input[1] * rate[1];
    power[3] = input[1];
}

static void levels(const void *model, const wh_angle *angle, const wh_real *linear,
                   const wh_real *rate, const wh_real *input, wh_real *level) {
    wh_real sine;
    wh_real cosine;
    (void)model;
    (void)linear;
    (void)input;
    wh_sincos(wh_phase_of(angle[0]), &sine, &cosine);
    level[0] = WH_R(0.5) * (rate[0] * rate[0] + rate[1] * rate[1]) - cosine;
    level[1] = rate[0];
    level[2] = rate[1];
}

static const uint8_t account[] = {0, 1, 0, 2};
static const wh_ledger_form books = {.powers = powers,
                                     .levels = levels,
                                     .account = account,
                                     .smooth = 4,
                                     .entries = 4,
                                     .accounts = 3,
                                     .coordinates = 2,
                                     .angles = 1};

static void sines(const void *model, const wh_phase *phase, wh_sine_parts *parts) {
    (void)model;
    wh_sincos_parts(phase[0], parts);
}

static void rates(const void *model, wh_real scale, const wh_real *rate, wh_real *result) {
    (void)model;
    result[0] = scale * rate[0];
}

static const wh_waves waves = {NULL, sines, rates, 1};
static bool with_books;

static wh_status advance(const wh_scene *scene, wh_state *state) {
    const wh_two_part h = {scene->step_s, WH_R(0.0)};
    return wh_step_counted(with_books ? wh_turn_ledger(&books, NULL, turned_accel, &waves,
                                                       scene->method, scene->compensated, h, state)
                                      : wh_turn_second(NULL, turned_accel, &waves, scene->method,
                                                       scene->compensated, 1, 2, h, state),
                           state);
}

static uint64_t memory[WH_STATE_WORDS(1, 3, 2) + WH_LEDGER_WORDS(4, 3)];
static wh_state state;
static const wh_angle start_angle[1] = {1};
static const wh_real start_real[3] = {WH_R(0.0), WH_R(1.25), WH_R(-0.5)};
static const wh_real start_input[2] = {WH_R(0.25), WH_R(2.0)};

static wh_scene scene_of(wh_method method, bool compensated) {
    return (wh_scene){.name = "books",
                      .form = WH_SECOND_ORDER,
                      .method = method,
                      .angles = 1,
                      .reals = 3,
                      .inputs = 2,
                      .compensated = compensated,
                      .step_s = STEP_S,
                      .start_angle = start_angle,
                      .start_real = start_real,
                      .start_input = start_input,
                      .ledger = &books,
                      .advance = advance};
}

static void run(const wh_scene *scene, bool books_too) {
    with_books = books_too;
    TEST_ASSERT_TRUE(wh_scene_start(scene, &state, memory, sizeof memory) == WH_OK);
    TEST_ASSERT_TRUE(wh_scene_steps(scene, &state, STEPS) == WH_OK);
}

/* Returns the allowed residual of the ledger, the method's error: of order h for Euler's method, round-off for the best
 * methods. */
static wh_real allowed(wh_method method) {
    const wh_real rounding = WH_DOUBLE ? WH_R(1e-9) : WH_R(2e-5);
    const unsigned order = wh_methods[method].order;
    return order == 1   ? WH_R(0.05)
           : order == 2 ? WH_R(2e-4)
           : order == 3 ? WH_R(2e-6) + rounding
                        : rounding;
}

TEST(stage_turn_ledger, ledger_with_rotated_sines) {
    for (unsigned m = 0; m < 2 * WH_METHODS; m++) {
        const wh_method method = (wh_method)(m / 2);
        const wh_scene scene = scene_of(method, m % 2 == 1);
        wh_real level[3];
        if (!wh_method_turns(method)) {
            continue;
        }
        run(&scene, false);
        const uint64_t wanted = wh_scene_hash(&scene, &state);
        run(&scene, true);
        TEST_ASSERT_TRUE(wh_scene_hash(&scene, &state) == wanted);
        /* The work of a constant force is force times distance, its impulse force times time. */
        const wh_real rad = wh_angle_to_rad(state.angle[0]) - wh_angle_to_rad(start_angle[0]);
        const wh_real near = allowed(method);
        TEST_ASSERT_TRUE(WH_ABS(state.ledger[0] - WH_R(0.25) * rad) < near);
        TEST_ASSERT_TRUE(WH_ABS(state.ledger[2] - WH_R(2.0) * state.real[0]) < near);
        TEST_ASSERT_TRUE(WH_ABS(state.ledger[3] - WH_R(2.0)) <
                         (WH_DOUBLE ? WH_R(1e-14) : WH_R(1e-6)));
        for (unsigned k = 0; k < 3; k++) {
            const wh_real error = wh_ledger_error(&books, &state, k, level);
            TEST_ASSERT_TRUE_MESSAGE(WH_ABS(error) < near, wh_methods[method].word);
        }
    }
}

TEST(stage_turn_ledger, refused_step_has_no_entry) {
    for (unsigned m = 0; m < WH_METHODS; m++) {
        const wh_scene scene = scene_of((wh_method)m, false);
        wh_real before[4];
        if (!wh_method_turns((wh_method)m)) {
            continue;
        }
        run(&scene, true);
        wh_copy(state.ledger, 4, before);
        const uint64_t hash = wh_scene_hash(&scene, &state);
        state.input[0] = WH_R(1e30);
        TEST_ASSERT_TRUE(wh_scene_step(&scene, &state) == WH_E_DIVERGED);
        TEST_ASSERT_TRUE(wh_scene_hash(&scene, &state) == hash);
        for (unsigned i = 0; i < 4; i++) {
            TEST_ASSERT_TRUE(state.ledger[i] == before[i]);
        }
    }
}

static void slope(const void *model, const wh_phase *phase, const wh_real *x, const wh_real *input,
                  wh_real *result) {
    wh_real sine;
    wh_real cosine;
    (void)model;
    (void)x;
    wh_sincos(phase[0], &sine, &cosine);
    result[0] = input[0];
    result[1] = cosine;
}

static void turned_slope(const void *model, const wh_wave *pair, const wh_real *x,
                         const wh_real *input, wh_real *result) {
    (void)model;
    (void)x;
    result[0] = input[0];
    result[1] = pair[0].cosine;
}

/* th' = 1/2, x' = cos th, so x = 2 sin(t/2), for a second. A step of half a turn is refused, whichever stage reaches
 * it. */
TEST(stage_turn_ledger, first_order_unrolled_by_hand) {
    for (unsigned m = 0; m < 2 * WH_METHODS; m++) {
        const wh_method method = (wh_method)(m / 2);
        wh_angle angle[1] = {wh_angle_from_rad(WH_R(0.0))};
        wh_real real[1] = {WH_R(0.0)};
        wh_real input[1] = {WH_R(0.5)};
        wh_state of = {.angle = angle, .real = real, .input = input, .fault = -1};
        const wh_two_part h = {STEP_S, WH_R(0.0)};
        const bool turns = m % 2 == 1 && wh_method_turns(method);
        if (!wh_method_takes(method, WH_FIRST_ORDER)) {
            continue;
        }
        for (unsigned i = 0; i < STEPS; i++) {
            TEST_ASSERT_TRUE(
                (turns ? wh_turn_first(NULL, turned_slope, &waves, method, false, 1, 1, h, &of)
                       : wh_step_first(NULL, slope, method, false, 1, 1, h, &of)) == WH_OK);
        }
        TEST_ASSERT_TRUE(WH_ABS(real[0] - WH_R(0.958851077208406)) < allowed(method));
        for (unsigned i = 0; i < 3; i++) {
            input[0] = i == 0 ? WH_R(410.0) : i == 1 ? WH_R(-1e6) : (wh_real)__builtin_nan("");
            const wh_real before = real[0];
            TEST_ASSERT_TRUE(
                (turns ? wh_turn_first(NULL, turned_slope, &waves, method, false, 1, 1, h, &of)
                       : wh_step_first(NULL, slope, method, false, 1, 1, h, &of)) == WH_E_DIVERGED);
            TEST_ASSERT_TRUE(of.fault == 0 && real[0] == before);
        }
    }
}

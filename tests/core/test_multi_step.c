/* test_multi_step.c: many steps in one call give the same bits as single steps, also if a step fails. Closed forms are the
 * reference of steps by a constant matrix, and of float steps with a two-part length. */
#include "core/scene.h"
#define WH_COORDS 3
#include "core/step.h"
#include "core/step/matrix_step.h"

#include "tests/suites.h"

enum { STEPS = WH_TEST_SMALL ? 256 : 4096 };

/* True if double has enough precision for a reference (on an AVR it is a float). */
#define HAS_REFERENCE (__DBL_MANT_DIG__ >= 53)

static uint64_t memory[WH_STATE_WORDS(1, 3, 1)];
static wh_state state;
static wh_real length[2]; /* step length and its correction */

static double size_of(double x) { return x < 0.0 ? -x : x; }

/* The accelerations of a driven pendulum and of a mass on a spring. */
static void accel(const void *model, const wh_phase *phase, const wh_real *linear,
                  const wh_real *rate, const wh_real *input, wh_real *result) {
    wh_real sine;
    wh_real cosine;
    (void)model;
    wh_sincos(phase[0], &sine, &cosine);
    result[0] = input[0] - sine - WH_R(0.1) * rate[0];
    result[1] = cosine - WH_R(4.0) * linear[0];
}

static wh_status advance(const wh_scene *scene, wh_state *of) {
    return wh_step_counted(wh_step_second(NULL, accel, scene->method, scene->compensated, 1, 2,
                                          (wh_two_part){scene->step_s, length[1]}, of),
                           of);
}

static wh_status multi_step(const wh_scene *scene, wh_state *of, uint32_t steps) {
    return wh_multi_step(scene, advance, 1, 3, scene->compensated, of, steps);
}

static const wh_angle start_angle[1] = {0};
static const wh_real start_real[3] = {WH_R(0.5), WH_R(1.5), WH_R(-0.25)};
static const wh_real start_input[1] = {WH_R(0.0)};

static wh_scene scene_of(wh_method method, bool compensated) {
    return (wh_scene){.name = "multi_step",
                      .form = WH_SECOND_ORDER,
                      .method = method,
                      .angles = 1,
                      .reals = 3,
                      .inputs = 1,
                      .compensated = compensated,
                      .step_s = length[0],
                      .start_angle = start_angle,
                      .start_real = start_real,
                      .start_input = start_input,
                      .advance = advance};
}

typedef struct ending {
    wh_status status;
    uint64_t hash;
    uint64_t steps;
    int fault;
    wh_real carry;
} ending;

static ending end_of(const wh_scene *scene, uint32_t some, uint32_t more, wh_real input) {
    TEST_ASSERT_TRUE(wh_scene_start(scene, &state, memory, sizeof memory) == WH_OK);
    TEST_ASSERT_TRUE(wh_scene_steps(scene, &state, some) == WH_OK);
    state.input[0] = input;
    ending end = {.status = wh_scene_steps(scene, &state, more)};
    end.hash = wh_scene_hash(scene, &state);
    end.steps = state.steps;
    end.fault = state.fault;
    end.carry = scene->compensated ? state.carry[3] : WH_R(0.0);
    return end;
}

TEST(multi_step, multi_steps_are_steps) {
    /* Three inputs: a usual one; one that accelerates the shaft to half a turn per step; NaN. */
    const wh_real inputs[] = {WH_R(2.0), WH_R(300.0), (wh_real)__builtin_nan("")};
    length[0] = WH_R(0.0625);
    length[1] = WH_R(0.0);
    for (unsigned m = 0; m < WH_METHODS; m++) {
        for (unsigned i = 0; i < 6; i++) {
            const wh_scene plain = scene_of((wh_method)m, i % 2 == 1);
            wh_scene quick = plain;
            quick.multi_step = multi_step;
            for (uint32_t some = 0; some < 3; some++) {
                const ending one = end_of(&plain, some, 40, inputs[i / 2]);
                const ending all = end_of(&quick, some, 40, inputs[i / 2]);
                TEST_ASSERT_TRUE((one.status == WH_OK) == (i < 2));
                TEST_ASSERT_TRUE(one.status == all.status && one.hash == all.hash);
                TEST_ASSERT_TRUE(one.steps == all.steps && one.carry == all.carry);
                TEST_ASSERT_TRUE(one.fault == all.fault);
                TEST_ASSERT_TRUE(i / 2 != 1 || (one.steps > some && one.fault == 0));
            }
        }
    }
}

#if HAS_REFERENCE
/* Tangent of half the angle of a small rotation. */
#define HALF_TANGENT (1.0 / 1024.0)
static const double turn_sine = 2.0 * HALF_TANGENT / (1.0 + HALF_TANGENT * HALF_TANGENT);
static const double turn_less =
    -2.0 * HALF_TANGENT * HALF_TANGENT / (1.0 + HALF_TANGENT * HALF_TANGENT); /* cosine minus 1 */

/* Returns the error of a constant that is rounded to a real. */
static wh_real lack(double constant) {
    volatile wh_real kept = (wh_real)constant;
    return (wh_real)(constant - (double)kept);
}

/* Computes x+ = cos x + sin v, v+ = cos v - sin x. */
static void rotate(const void *model, const wh_phase *phase, const wh_real *real,
                   const wh_real *rate, const wh_real *input, wh_real *given) {
    (void)model;
    (void)phase;
    (void)rate;
    (void)input;
    given[0] = (wh_real)(1.0 + turn_less) * real[0] + (wh_real)turn_sine * real[1];
    given[1] = (wh_real)(1.0 + turn_less) * real[1] - (wh_real)turn_sine * real[0];
}

static void rotate_by_changes(const void *model, const wh_phase *phase, const wh_real *real,
                              const wh_real *rate, const wh_real *input, wh_real *given) {
    (void)model;
    (void)phase;
    (void)rate;
    (void)input;
    given[0] = (wh_real)turn_less * real[0] + (wh_real)turn_sine * real[1];
    given[1] = (wh_real)turn_less * real[1] - (wh_real)turn_sine * real[0];
    given[2] = lack(turn_less) * real[0] + lack(turn_sine) * real[1];
    given[3] = lack(turn_less) * real[1] - lack(turn_sine) * real[0];
}

/* Returns the error of x after STEPS steps from (1, 0). The reference is a power of the rotation, computed in double by
 * squaring. */
static double rotation_error(bool compensated) {
    wh_real real[2] = {WH_R(1.0), WH_R(0.0)};
    wh_real carry[2] = {WH_R(0.0), WH_R(0.0)};
    wh_state of = {.real = real, .carry = carry};
    double cosine = 1.0 + turn_less;
    double sine = turn_sine;
    for (unsigned i = 0; i < STEPS; i++) {
        TEST_ASSERT_TRUE(wh_step_matrix(NULL, compensated ? rotate_by_changes : rotate, compensated,
                                        0, 2, 1, (wh_two_part){WH_R(1.0), WH_R(0.0)},
                                        &of) == WH_OK);
    }
    for (unsigned power = 1; power < STEPS; power *= 2) {
        const double doubled = cosine * cosine - sine * sine;
        sine = 2.0 * sine * cosine;
        cosine = doubled;
    }
    const double low = compensated ? (double)carry[0] : 0.0;
    return size_of(((double)real[0] - cosine) + low);
}

static void test_a_matrix_turns_as_far_as_its_power(void) {
    const double plain = rotation_error(false);
    const double compensated = rotation_error(true);
    TEST_ASSERT_TRUE(plain < (WH_DOUBLE ? 3e-12 : 3e-4));
    TEST_ASSERT_TRUE(compensated < (WH_DOUBLE ? 1e-13 : 3e-7));
    TEST_ASSERT_TRUE(WH_DOUBLE || WH_TEST_SMALL || 4.0 * compensated < plain);
}

#endif

/* The input u accelerates a shaft. The list gives the mean rate r + u h/2 and the end rate r + u h of a step h = 1/64
 * s; with compensated sums, the change u h in place of the end rate. */
static bool changes_only;
static void speed_up(const void *model, const wh_phase *phase, const wh_real *real,
                     const wh_real *rate, const wh_real *input, wh_real *given) {
    (void)model;
    (void)phase;
    (void)real;
    given[0] = rate[0] + input[0] * WH_R(0.0078125);
    given[1] = (changes_only ? WH_R(0.0) : rate[0]) + input[0] * WH_R(0.015625);
    given[2] = WH_R(0.0);
}

TEST(multi_step, a_matrix_moves_angles) {
    for (unsigned k = 0; k < 2; k++) {
        wh_angle angle[1] = {wh_angle_from_rad(WH_R(0.0))};
        wh_real real[1] = {WH_R(1.0)};
        wh_real carry[2] = {WH_R(0.0), WH_R(0.0)};
        wh_real input[1] = {WH_R(2.0)};
        wh_state of = {.angle = angle, .real = real, .carry = carry, .input = input};
        changes_only = k == 1;
        for (unsigned i = 0; i < 64; i++) { /* one second */
            TEST_ASSERT_TRUE(wh_step_matrix(NULL, speed_up, k == 1, 1, 1, 0,
                                            (wh_two_part){WH_R(0.015625), WH_R(0.0)},
                                            &of) == WH_OK);
        }
        TEST_ASSERT_TRUE(real[0] == WH_R(3.0));
        TEST_ASSERT_TRUE(size_of((double)wh_angle_to_rad(angle[0]) - 2.0) <
                         (WH_DOUBLE ? 1e-14 : 1.3e-7));
    }
}

/* The fault is the first invalid component, and the state stays unchanged. */
static wh_real spoilt[6];
static void spoil(const void *model, const wh_phase *phase, const wh_real *real,
                  const wh_real *rate, const wh_real *input, wh_real *given) {
    (void)model;
    (void)phase;
    (void)real;
    (void)rate;
    (void)input;
    wh_copy(spoilt, 6, given);
}

TEST(multi_step, diverging_steps_are_refused) {
    const wh_real bad[] = {WH_R(2e15), WH_R(-1e30), (wh_real)__builtin_nan(""),
                           (wh_real)__builtin_inf()};
    for (unsigned k = 0; k < 4 * 3 * 3; k++) {
        const unsigned angles = k % 3 == 0 ? 0U : 1U;
        const unsigned component = k / 3 % 3;
        wh_angle angle[1] = {77};
        wh_real real[3] = {WH_R(1.0), WH_R(2.0), WH_R(3.0)};
        wh_real carry[4] = {WH_R(0.0)};
        wh_state of = {.angle = angle, .real = real, .carry = carry, .fault = -1};
        for (unsigned i = 0; i < 6; i++) {
            spoilt[i] = i == component ? bad[k / 9] : WH_R(0.5);
        }
        TEST_ASSERT_TRUE(wh_step_matrix(NULL, spoil, k % 3 == 2, angles, 3 - angles, 0,
                                        (wh_two_part){WH_R(1.0), WH_R(0.0)}, &of) == WH_E_DIVERGED);
        TEST_ASSERT_EQUAL_INT((int)component, of.fault);
        TEST_ASSERT_TRUE(angle[0] == 77 && real[0] == WH_R(1.0) && real[1] == WH_R(2.0));
        TEST_ASSERT_TRUE(real[2] == WH_R(3.0) && carry[0] == WH_R(0.0));
    }
}

#if HAS_REFERENCE
static void pull(const void *model, const wh_phase *phase, const wh_real *linear,
                 const wh_real *rate, const wh_real *input, wh_real *result) {
    (void)model;
    (void)phase;
    (void)linear;
    (void)rate;
    result[0] = input[0];
    result[1] = input[0];
}

/* Computes the relative errors of a body and of a shaft after STEPS milliseconds. Both start with the rate `rest` and
 * have the acceleration `push`. */
static void errors_after(wh_method method, wh_real rest, wh_real push, double *line, double *turn) {
    const double milli_s = 0.001;
    const double end_s = milli_s * STEPS;
    wh_angle angle[1] = {wh_angle_from_rad(WH_R(0.0))};
    wh_real real[3] = {WH_R(0.0), WH_R(1.0), WH_R(1.0)};
    wh_real carry[4] = {WH_R(0.0)};
    wh_real input[1] = {push};
    wh_state of = {.angle = angle, .real = real, .carry = carry, .input = input};
    for (unsigned i = 0; i < STEPS; i++) {
        TEST_ASSERT_TRUE(wh_step_second(NULL, pull, method, true, 1, 2,
                                        (wh_two_part){(wh_real)milli_s, rest}, &of) == WH_OK);
    }
    /* Euler's method uses the rate at the begin as the mean, its semi-implicit form the rate at the end */
    const double ends = method == WH_EULER ? -1.0 : method == WH_SEMI_IMPLICIT_EULER ? 1.0 : 0.0;
    const double way = end_s + (double)push * 0.5 * end_s * (end_s + ends * milli_s);
    *line = size_of((double)real[0] + (double)carry[1] - way) / way;
    *turn = size_of((double)wh_angle_to_rad(angle[0]) - way) / way;
}

/* No float equals a millisecond: the relative error is 5e-8. With a two-part length, many steps cover the right time,
 * for positions and angles; with a one-part length they do not. Accelerations add the round-off of their products. */
static void test_a_length_in_two_parts_lasts_as_long_as_it_should(void) {
    for (unsigned m = 0; m < WH_METHODS; m++) {
        double line;
        double turn;
        errors_after((wh_method)m, lack(0.001), WH_R(0.0), &line, &turn);
        TEST_ASSERT_TRUE(line < (WH_DOUBLE ? 1e-13 : 2e-9));
        TEST_ASSERT_TRUE(turn < (WH_DOUBLE ? 1e-12 : 6e-8)); /* half of a float's last place */
        errors_after((wh_method)m, WH_R(0.0), WH_R(0.0), &line, &turn);
        TEST_ASSERT_TRUE(WH_DOUBLE || (line > 4.7e-8 && line < 4.8e-8));
        errors_after((wh_method)m, lack(0.001), WH_R(0.5), &line, &turn);
        TEST_ASSERT_TRUE(line < (WH_DOUBLE ? 1e-12 : 6e-8));
        TEST_ASSERT_TRUE(turn < (WH_DOUBLE ? 1e-12 : 1.2e-7));
    }
}

#endif

SUITE(multi_step) {
#if HAS_REFERENCE
    RUN_TEST(test_a_matrix_turns_as_far_as_its_power);
    RUN_TEST(test_a_length_in_two_parts_lasts_as_long_as_it_should);
#endif
}

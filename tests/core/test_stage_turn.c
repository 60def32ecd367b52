/* test_stage_turn.c: steps that rotate their sines (core/step/stage_turn.h). To the method's order they are as accurate
 * as steps with lookups, for every method, form and speed, and they are refused in the same cases. Also: the round-off
 * of a small rotation. */
#include "core/scene.h"
#define WH_COORDS 4
#define WH_WAVES 3
#include "core/step/stage_turn.h"

#include "tests/suites.h"

enum { ANGLES = 3, LINEARS = 1, COORDINATES = 4, REALS = 5, VALUES = 8 };

static wh_angle angle[ANGLES];
static wh_real real[REALS];
static wh_real carry[ANGLES + REALS];
static wh_real input[1];
static wh_state state = {.angle = angle, .real = real, .carry = carry, .input = input};

/* The sines of three waves of two angles: a, 2 a - b and a + b. The third angle is in no wave. */
static void sines(const void *model, const wh_phase *phase, wh_sine_parts *parts) {
    (void)model;
    wh_sincos_parts(phase[0], &parts[0]);
    wh_sincos_parts((wh_phase)2 * phase[0] - phase[1], &parts[1]);
    wh_sincos_parts(phase[0] + phase[1], &parts[2]);
}

static void look_up(const wh_phase *phase, wh_wave *pair) {
    wh_sincos(phase[0], &pair[0].sine, &pair[0].cosine);
    wh_sincos((wh_phase)2 * phase[0] - phase[1], &pair[1].sine, &pair[1].cosine);
    wh_sincos(phase[0] + phase[1], &pair[2].sine, &pair[2].cosine);
}

static void rates(const void *model, wh_real scale, const wh_real *rate, wh_real *result) {
    (void)model;
    result[0] = scale * rate[0];
    result[1] = scale * (WH_R(2.0) * rate[0] - rate[1]);
    result[2] = scale * (rate[0] + rate[1]);
}

static const wh_waves waves = {NULL, sines, rates, 3};

static wh_real coupling; /* factor of the terms that grow with rates */

/* Computes the accelerations of pendulums that are coupled to each other and to a spring. The last angle turns
 * freely. */
static void swing_turned(const void *model, const wh_wave *p, const wh_real *linear,
                         const wh_real *rate, const wh_real *u, wh_real *accel) {
    (void)model;
    accel[0] = u[0] - WH_R(2.0) * p[0].sine + coupling * p[1].sine * rate[1] * rate[1];
    accel[1] = -WH_R(0.7) * p[2].sine - coupling * p[1].cosine * rate[0] + linear[0];
    accel[2] = u[0] - WH_R(0.1) * rate[2];
    accel[3] = WH_R(0.5) * p[2].cosine - WH_R(3.0) * linear[0] - WH_R(0.2) * rate[3];
}

static void swing(const void *model, const wh_phase *phase, const wh_real *linear,
                  const wh_real *rate, const wh_real *u, wh_real *accel) {
    wh_wave pair[3];
    look_up(phase, pair);
    swing_turned(model, pair, linear, rate, u, accel);
}

static void flow_turned(const void *model, const wh_wave *p, const wh_real *x, const wh_real *u,
                        wh_real *slope) {
    (void)model;
    slope[0] = u[0] + WH_R(0.8) + WH_R(0.5) * x[0] * p[1].sine;
    slope[1] = WH_R(0.6) * p[0].cosine - WH_R(0.5) * x[0];
    slope[2] = u[0] + WH_R(0.3);
    slope[3] = WH_R(0.4) * p[2].cosine - x[0];
}

static void flow(const void *model, const wh_phase *phase, const wh_real *x, const wh_real *u,
                 wh_real *slope) {
    wh_wave pair[3];
    look_up(phase, pair);
    flow_turned(model, pair, x, u, slope);
}

typedef struct manner {
    wh_form form;
    wh_method method;
    bool compensated;
    bool turns;
} manner;

static wh_status step(manner how, wh_real h, wh_phase *told) {
    if (how.form == WH_FIRST_ORDER) {
        return how.turns ? wh_turn_first(NULL, flow_turned, &waves, how.method, how.compensated,
                                         ANGLES, LINEARS, (wh_two_part){h, WH_R(0.0)}, &state)
                         : wh_step_first(NULL, flow, how.method, how.compensated, ANGLES, LINEARS,
                                         (wh_two_part){h, WH_R(0.0)}, &state);
    }
    if (how.turns) {
        const wh_stepping to = {
            wh_tableau_of(how.method), &state, h, ANGLES, COORDINATES, how.compensated};
        return wh_turn_second_phases(NULL, swing_turned, &waves, &to, (wh_two_part){h, WH_R(0.0)},
                                     told, &state);
    }
    return wh_step_second(NULL, swing, how.method, how.compensated, ANGLES, COORDINATES,
                          (wh_two_part){h, WH_R(0.0)}, &state);
}

static void start(void) {
    input[0] = WH_R(0.0);
    coupling = WH_R(0.4);
    for (int i = 0; i < ANGLES; i++) {
        angle[i] = wh_angle_from_rad(WH_R(0.7) + WH_R(0.9) * (wh_real)i);
    }
    for (int i = 0; i < REALS; i++) {
        real[i] = (i % 2 != 0 ? WH_R(0.3) : -WH_R(0.4)) + WH_R(0.05) * (wh_real)i;
    }
    for (int i = 0; i < ANGLES + REALS; i++) {
        carry[i] = WH_R(0.0);
    }
    state.fault = -1;
}

static unsigned reals_of(manner how) { return how.form == WH_SECOND_ORDER ? REALS : LINEARS; }

/* Computes the state after one second: angles in radians, then reals. */
static unsigned after_1s(manner how, unsigned count, wh_real value[VALUES]) {
    start();
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(step(how, WH_R(1.0) / (wh_real)count, NULL) == WH_OK);
    }
    for (int i = 0; i < ANGLES; i++) {
        value[i] = wh_angle_to_rad(angle[i]);
    }
    for (unsigned i = 0; i < reals_of(how); i++) {
        value[ANGLES + i] = real[i];
    }
    return ANGLES + reals_of(how);
}

static wh_real squares(unsigned count, const wh_real *x, const wh_real *y) {
    wh_real sum = WH_R(0.0);
    for (unsigned i = 0; i < count; i++) {
        sum += (x[i] - y[i]) * (x[i] - y[i]);
    }
    return sum;
}

enum { MANNERS = 4 * WH_METHODS };
static manner manner_of(unsigned k) {
    return (manner){k % 2 != 0 ? WH_FIRST_ORDER : WH_SECOND_ORDER, (wh_method)(k / 4),
                    k / 2 % 2 != 0, true};
}

static bool turns(manner how) {
    return wh_method_takes(how.method, how.form) && wh_method_turns(how.method);
}

/* The errors of rotating and of looking up have the same leading term (stage_turn.h). The reference runs look up, with
 * a sixteenth of the step. */
TEST(stage_turn, rotating_has_the_methods_order) {
    for (unsigned k = 0; k < MANNERS; k++) {
        manner how = manner_of(k);
        const unsigned order = wh_methods[how.method].order;
        const unsigned count = sizeof(wh_real) == 8 ? (order < 4 ? 512 : 32) : order < 3 ? 64 : 4;
        const wh_real within = sizeof(wh_real) == 8 ? WH_R(1.2) : WH_R(3.0);
        const wh_real wanted = (wh_real)(1U << (2 * order));
        wh_real turned[2][VALUES];
        wh_real looked_up[VALUES];
        wh_real exact[VALUES];
        if (!wh_method_turns(how.method) || (sizeof(wh_real) == 4 && order > 4)) {
            continue; /* In float, an order above 4 shows only in steps with large shear angles. */
        }
        if (!wh_method_takes(how.method, how.form)) {
            start();
            TEST_ASSERT_TRUE(step(how, WH_R(0.125), NULL) == WH_E_ARGUMENT);
            continue;
        }
        const unsigned components = after_1s(how, count, turned[0]);
        after_1s(how, 2 * count, turned[1]);
        how.turns = false;
        after_1s(how, count, looked_up);
        /* RK4 is accurate enough as a reference of orders up to 4. */
        how.method = order > 4 ? how.method : WH_RK4;
        after_1s(how, 16 * count, exact);
        const wh_real error = squares(components, turned[0], exact);
        const wh_real ratio = error / squares(components, turned[1], exact);
        const wh_real usual = squares(components, looked_up, exact);
        const char *word = wh_methods[manner_of(k).method].word;
        TEST_ASSERT_TRUE_MESSAGE(ratio < within * wanted && wanted < within * ratio, word);
        TEST_ASSERT_TRUE_MESSAGE(error < within * usual && usual < within * error, word);
    }
}

/* A method's column .turns follows from its shares of the step, or is empty. */
TEST(stage_turn, turns_follow_from_the_shares) {
    for (unsigned m = 0; m < WH_METHODS; m++) {
        const wh_tableau *by = wh_tableau_of(m);
        wh_real first = WH_R(0.0); /* distance of stage 1, as a share of the step */
        for (unsigned s = 1; s < by->stages && by->turns[by->stages - 1] > 0; s++) {
            wh_real sum = WH_R(0.0);
            for (unsigned j = 0; j < s; j++) {
                sum += by->stage[s].share[j];
            }
            first = s == 1 ? sum / by->stage[s].parts : first;
            const wh_real off = sum - (wh_real)by->turns[s] * first * by->stage[s].parts;
            TEST_ASSERT_TRUE_MESSAGE(WH_ABS(off) < WH_R(1e-6), wh_methods[m].word);
            TEST_ASSERT_TRUE_MESSAGE(by->turns[s] >= by->turns[s - 1], wh_methods[m].word);
        }
    }
}

/* If a method has a single stage, or a scene has no angles, rotating and looking up give the same bits. */
TEST(stage_turn, without_rotation_bits_are_equal) {
    for (unsigned k = 0; k < MANNERS; k++) {
        manner how = manner_of(k);
        wh_real turned[VALUES];
        wh_real looked_up[VALUES];
        if (wh_methods[how.method].stages > 1 || !turns(how)) {
            continue;
        }
        const unsigned components = after_1s(how, 64, turned);
        how.turns = false;
        after_1s(how, 64, looked_up);
        TEST_ASSERT_TRUE(squares(components, turned, looked_up) == WH_R(0.0));
    }
}

/* If the caller asks for the phases, it gets those of the last stage, and the run does not change. */
TEST(stage_turn, phases_are_returned) {
    for (unsigned m = 0; m < WH_METHODS; m++) {
        const manner how = {WH_SECOND_ORDER, (wh_method)m, false, true};
        if (!turns(how)) {
            continue;
        }
        const wh_real h = WH_R(0.03125);
        wh_angle before[ANGLES];
        wh_angle after[ANGLES];
        wh_phase told[ANGLES] = {0};
        start();
        TEST_ASSERT_TRUE(step(how, h, NULL) == WH_OK);
        for (int i = 0; i < ANGLES; i++) {
            after[i] = angle[i];
        }
        start();
        for (int i = 0; i < ANGLES; i++) {
            before[i] = angle[i];
        }
        TEST_ASSERT_TRUE(step(how, h, told) == WH_OK);
        for (int i = 0; i < ANGLES; i++) {
            TEST_ASSERT_TRUE(angle[i] == after[i]);
            const wh_real way = wh_angle_to_rad(wh_angle_near(before[i], told[i]) - before[i]);
            const wh_real whole = wh_angle_to_rad(after[i] - before[i]);
            const wh_tableau *by = wh_tableau_of(m);
            const wh_shares *last = &by->stage[by->stages - 1];
            wh_real part = WH_R(0.0);
            for (unsigned j = 0; j < by->stages; j++) {
                part += last->share[j] / last->parts;
            }
            const wh_real off = way - part * whole;
            TEST_ASSERT_TRUE_MESSAGE(WH_ABS(off) < WH_R(2e-3), wh_methods[m].word);
        }
    }
}

static uint64_t chance = 20261122;
static wh_real between(wh_real low, wh_real high) {
    chance = chance * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (wh_real)(uint32_t)(chance >> 33) * WH_R(4.656612873077393e-10);
}

/* Makes one step by rotation (result 0) and one by lookup (result 1), from start() with this input and these rates. The
 * rates are so large that accelerations change them little. */
static void step_both(manner how, wh_real h, wh_real u, const wh_real *rate, wh_status status[2],
                      int fault[2], wh_real value[2][VALUES]) {
    for (int k = 0; k < 2; k++) {
        start();
        input[0] = u;
        coupling = WH_R(0.0);
        for (int i = 0; i < ANGLES && how.form == WH_SECOND_ORDER; i++) {
            real[LINEARS + i] = rate[i];
        }
        how.turns = k == 0;
        status[k] = step(how, h, NULL);
        fault[k] = state.fault;
        for (int i = 0; i < ANGLES; i++) {
            value[k][i] = wh_angle_to_rad(angle[i]);
        }
        for (unsigned i = 0; i < reals_of(how); i++) {
            value[k][ANGLES + i] = real[i];
        }
    }
}

/* If the angle moves by less than half a turn per step, the shear angle is small, so both steps agree to round-off. The
 * waves turn up to three times as fast. */
TEST(stage_turn, fast_angles_equal_lookups) {
    const wh_real h = WH_R(0.0009765625);
    const wh_real most = WH_R(3.14) / h;
    const wh_real within = sizeof(wh_real) == 8 ? WH_R(4e-14) : WH_R(1e-6);
    unsigned taken = 0;
    for (unsigned k = 0; k < 100 * MANNERS; k++) {
        manner how = manner_of(k % MANNERS);
        wh_status status[2];
        int fault[2];
        wh_real value[2][VALUES];
        wh_real rate[ANGLES];
        if (!turns(how)) {
            continue;
        }
        for (int i = 0; i < ANGLES; i++) {
            rate[i] = between(-WH_R(1.01), WH_R(1.01)) * most;
        }
        step_both(how, h, how.form == WH_FIRST_ORDER ? rate[0] : WH_R(0.0), rate, status, fault,
                  value);
        TEST_ASSERT_EQUAL_INT_MESSAGE(status[1], status[0], wh_methods[how.method].word);
        TEST_ASSERT_EQUAL_INT_MESSAGE(fault[1], fault[0], wh_methods[how.method].word);
        for (unsigned i = 0; i < ANGLES + reals_of(how); i++) {
            const wh_real size = WH_R(1.0) + WH_ABS(value[1][i]);
            TEST_ASSERT_TRUE_MESSAGE(WH_ABS(value[0][i] - value[1][i]) < within * size,
                                     wh_methods[how.method].word);
        }
        taken += status[0] == WH_OK;
    }
    TEST_ASSERT_TRUE(taken > 50 * MANNERS);
}

/* A motion that a step with lookups refuses (half a turn or more, or NaN) is refused, and the state stays unchanged. */
TEST(stage_turn, excessive_turns_are_refused) {
    const wh_real nan = (wh_real)__builtin_nan("");
    const wh_real rates[] = {WH_R(3200.0), WH_R(-1e5), WH_R(1e9), WH_R(-1e14), WH_R(1e30), nan};
    for (unsigned k = 0; k < MANNERS * sizeof rates / sizeof rates[0]; k++) {
        manner how = manner_of(k % MANNERS);
        const wh_real fast = rates[k / MANNERS];
        wh_status status[2];
        int fault[2];
        wh_real value[2][VALUES];
        const wh_real rate[ANGLES] = {fast, WH_R(1.0), WH_R(1.0)};
        if (!turns(how)) {
            continue;
        }
        step_both(how, WH_R(0.001), how.form == WH_FIRST_ORDER ? fast : WH_R(0.0), rate, status,
                  fault, value);
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_E_DIVERGED, status[0], wh_methods[how.method].word);
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_E_DIVERGED, status[1], wh_methods[how.method].word);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, fault[0], wh_methods[how.method].word);
        for (int i = 0; i < ANGLES; i++) {
            TEST_ASSERT_TRUE(value[0][i] == value[1][i]);
        }
    }
}

TEST(stage_turn, small_turns_are_sines) {
    const wh_real within = sizeof(wh_real) == 8 ? WH_R(1.8e-16) : WH_R(1.1e-7);
    for (int i = -4096; i <= 4096; i++) {
        const wh_real d = (wh_real)i * WH_R(0.0001220703125); /* 2^-13 */
        const wh_phase phase = wh_phase_from_rad(d);
        wh_real wanted[2];
        wh_sincos(phase, &wanted[0], &wanted[1]);
        wh_wave turn = wh_sincos_small(d);
        TEST_ASSERT_TRUE(WH_ABS(turn.sine - wanted[0]) < within);
        TEST_ASSERT_TRUE(WH_ABS(WH_R(1.0) + turn.cosine - wanted[1]) < within);
        /* Near zero, sin d equals d exactly. */
        const wh_real tiny = d * WH_R(1e-9);
        turn = wh_sincos_small(tiny);
        TEST_ASSERT_TRUE(turn.sine == tiny);
        TEST_ASSERT_TRUE(turn.cosine == -WH_R(0.5) * (tiny * tiny) || sizeof(wh_real) == 8);
    }
}

/* Up to eight turns, the error doubles with each doubling of the angle. For too large an angle the result is infinite
 * or NaN, and no step accepts it. */
TEST(stage_turn, far_turns_are_sines) {
    const int32_t each = __STDC_HOSTED__ ? 1 : 9;
    for (int32_t i = -50000; i <= 50000; i += each) {
        const wh_real d = (wh_real)i * WH_R(0.0009765625); /* 2^-10 */
        const wh_real within = (sizeof(wh_real) == 8 ? WH_R(1.4e-15) : WH_R(8e-7)) *
                               (WH_ABS(d) > WH_R(1.0) ? WH_ABS(d) : WH_R(1.0));
        wh_real wanted[2];
        wh_sincos(wh_phase_from_rad(d), &wanted[0], &wanted[1]);
        const wh_wave turn = wh_sincos_far(d, d > WH_SINCOS_SMALL);
        const wh_wave called = wh_sincos_far_called(d);
        TEST_ASSERT_TRUE(called.sine == turn.sine && called.cosine == turn.cosine);
        TEST_ASSERT_TRUE(WH_ABS(turn.sine - wanted[0]) < within);
        TEST_ASSERT_TRUE(WH_ABS(WH_R(1.0) + turn.cosine - wanted[1]) < within);
        if (WH_ABS(d) <= WH_SINCOS_SMALL) {
            const wh_wave small = wh_sincos_small(d);
            TEST_ASSERT_TRUE(turn.sine == small.sine && turn.cosine == small.cosine);
        }
    }
    const wh_real none[] = {WH_R(1e9), WH_R(-1e9), WH_R(1e30), (wh_real)__builtin_inf(),
                            (wh_real)__builtin_nan("")};
    for (unsigned i = 0; i < sizeof none / sizeof none[0]; i++) {
        const wh_wave turn = wh_sincos_far(none[i], false);
        TEST_ASSERT_FALSE(WH_ABS(turn.sine) < WH_R(1e15));
        TEST_ASSERT_FALSE(WH_ABS(turn.cosine) < WH_R(1e15));
    }
}

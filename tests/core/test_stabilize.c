/* test_stabilize.c: a step's correction of its energy drift (core/step/stabilize.h), for a body of 1 kg that flies with
 * two rates, in closed form. The tests imitate a drift: they change the start's energy in the ledger. */
#include "core/step/stabilize.h"

#include "tests/suites.h"

#define DRAWN 200U

static wh_real sign_of_momenta;

static void flight_levels(const void *model, const wh_angle *angle, const wh_real *linear,
                          const wh_real *rate, const wh_real *input, wh_real *level) {
    (void)model;
    (void)angle;
    (void)linear;
    (void)input;
    level[0] = WH_R(0.5) * (rate[0] * rate[0] + rate[1] * rate[1]);
    level[1] = sign_of_momenta * rate[0];
    level[2] = sign_of_momenta * rate[1];
}

static const wh_ledger_form books = {
    .levels = flight_levels, .entries = 1, .accounts = 4, .coordinates = 2, .stabilized = true};

typedef struct flight {
    wh_real real[4]; /* positions, then rates */
    wh_real carry[4];
    /* Correction so far, its carry, the levels at the start, the largest P (stabilize.h). */
    wh_real ledger[6];
    wh_state state;
} flight;

static void set_out(flight *f, wh_real first, wh_real second, wh_real drift, bool compensated) {
    *f = (flight){.real = {WH_R(1.0), WH_R(2.0), first, second}};
    f->ledger[2] = WH_R(0.5) * (first * first + second * second) - drift;
    f->state = (wh_state){
        .steps = 1, .real = f->real, .carry = compensated ? f->carry : NULL, .ledger = f->ledger};
    sign_of_momenta = WH_R(1.0);
}

static void give_back(flight *f) {
    wh_real level[3];
    wh_stabilize(&books, &f->state, level);
}

static bool near(wh_real is, wh_real should, wh_real part) {
    return WH_ABS(is - should) <= part * WH_ABS(should);
}

/* Draws a number in [-1, 1). */
static wh_real drawn(uint32_t *seed) {
    *seed = *seed * 1664525U + 1013904223U;
    return (wh_real)(int32_t)(*seed >> 8) / WH_R(8388608.0) - WH_R(1.0);
}

/* With compensated sums, the change has more digits than a rate. */
TEST(stabilize, part_of_the_drift_is_corrected) {
    uint32_t seed = 20261128;
    for (unsigned i = 0; i < DRAWN; i++) {
        flight f;
        const wh_real first = drawn(&seed) * WH_R(3.0);
        const wh_real second = WH_R(1.5) + drawn(&seed);
        const wh_real twice = first * first + second * second;
        const wh_real drift = twice * drawn(&seed) * WH_R(0.0009);
        set_out(&f, first, second, drift, true);
        const wh_real is = WH_R(0.5) * twice - f.ledger[2]; /* the drift after rounding */
        const wh_real part = -is / WH_R(1024.0) / twice;
        give_back(&f);
        TEST_ASSERT_TRUE(near((f.real[2] - first) + f.carry[2], part * first, WH_R(1e-5)));
        TEST_ASSERT_TRUE(near((f.real[3] - second) + f.carry[3], part * second, WH_R(1e-5)));
        TEST_ASSERT_TRUE(near(f.ledger[0], -is / WH_R(1024.0), WH_R(1e-5)));
        TEST_ASSERT_TRUE(f.real[0] == WH_R(1.0) && f.real[1] == WH_R(2.0));
        TEST_ASSERT_TRUE(f.carry[0] == WH_R(0.0) && f.carry[1] == WH_R(0.0));
    }
}

/* The correction has an entry in the ledger, and earlier corrections do not change the drift. Without compensated sums,
 * the entry is the change that the rates really had after rounding. */
TEST(stabilize, correction_is_in_the_ledger) {
    uint32_t seed = 20261129;
    for (unsigned i = 0; i < DRAWN; i++) {
        flight f;
        const wh_real first = drawn(&seed);
        const wh_real second = WH_R(1.5) + drawn(&seed);
        const wh_real before = drawn(&seed) * WH_R(1e-4);
        set_out(&f, first, second, before, true);
        f.ledger[0] = before;
        const wh_real is = WH_R(0.5) * (first * first + second * second) - f.ledger[2];
        give_back(&f);
        const wh_real given = (f.ledger[0] - before) + f.ledger[1];
        TEST_ASSERT_TRUE(WH_ABS(given + is / WH_R(1024.0)) <= WH_R(2e-7) * WH_ABS(before));
        /* Next case: without compensated sums. */
        set_out(&f, first, second, WH_R(1e-6), false);
        give_back(&f);
        const wh_real took = first * (f.real[2] - first) + second * (f.real[3] - second);
        TEST_ASSERT_TRUE(WH_ABS(f.ledger[0] - took) <= WH_R(1e-5) * WH_ABS(took));
    }
}

/* When the motion reverses, the relative change of the rates is no larger than at the highest speed. A faster motion
 * gives a new maximum of P. */
TEST(stabilize, largest_speed_is_the_scale) {
    uint32_t seed = 20261130;
    for (unsigned i = 0; i < DRAWN; i++) {
        flight f;
        const wh_real fast = WH_R(2.0) + drawn(&seed);
        const wh_real slow = WH_R(0.1) * drawn(&seed);
        const wh_real drift = fast * fast * drawn(&seed) * WH_R(0.0005);
        set_out(&f, fast, slow, drift, true);
        give_back(&f);
        const wh_real part = (f.real[3] - slow + f.carry[3]) / slow;
        /* at a later reversal; the ledger has the same energy */
        const wh_real most = f.ledger[5];
        set_out(&f, WH_R(0.001) * fast, slow, drift, true);
        f.ledger[5] = most;
        give_back(&f);
        const wh_real then = (f.real[3] - slow + f.carry[3]) / slow;
        TEST_ASSERT_TRUE(near(most, fast * fast + slow * slow, WH_R(1e-5)));
        TEST_ASSERT_TRUE(f.ledger[5] == most);
        TEST_ASSERT_TRUE(WH_ABS(then - part) <= WH_R(0.02) * WH_ABS(part) + WH_R(2e-9));
        set_out(&f, WH_R(2.0) * fast, slow, drift, true);
        f.ledger[5] = most;
        give_back(&f);
        TEST_ASSERT_TRUE(f.ledger[5] > WH_R(3.0) * most);
    }
}

/* The rates change by at most 2^-20 of their values, in either direction. */
TEST(stabilize, correction_is_bounded) {
    for (unsigned i = 0; i < 4; i++) {
        flight f;
        const wh_real way = i % 2 == 0 ? WH_R(1.0) : WH_R(-1.0);
        set_out(&f, WH_R(1.0), WH_R(-2.0), way * (i < 2 ? WH_R(3.0) : WH_R(1e9)), i == 1);
        give_back(&f);
        TEST_ASSERT_TRUE(f.real[2] == WH_R(1.0) - way * WH_STABILIZE_MOST);
        TEST_ASSERT_TRUE(f.real[3] == WH_R(-2.0) + way * WH_R(2.0) * WH_STABILIZE_MOST);
    }
}

/* Nothing changes before the first step, at rest, if the ledger is NaN, or if P has the wrong sign. */
TEST(stabilize, cases_without_a_correction) {
    const wh_real none = WH_R(0.0) * (WH_ABSURD * WH_ABSURD * WH_ABSURD);
    const wh_real drift[] = {WH_R(0.1), WH_R(0.0), (none - none) / (none - none), WH_R(1e20),
                             WH_R(-1e20)};
    for (unsigned i = 0; i < 7; i++) {
        flight f;
        const wh_real rate = i == 5 ? WH_R(0.0) : WH_R(1.0);
        set_out(&f, rate, rate, drift[i < 5 ? i : 0], false);
        if (i == 0) {
            f.state.steps = 0;
        }
        if (i == 6) {
            sign_of_momenta = WH_R(-1.0);
        }
        give_back(&f);
        TEST_ASSERT_TRUE(f.real[2] == rate && f.real[3] == rate);
    }
}

/* test_refuse.c: the component that a refused step reports, for the code variants of all chips. The reference is the
 * rule: a step is refused if the sum of sizes is 1e15 or more, or NaN. The fault is the first component that is too
 * large by itself, or else the last component. */
#include "core/step/matrix_step.h"
#include "tests/core/draw.h"
#include "tests/suites.h"

enum { MOST = 12, NONE = -1 };

static wh_real size_of(wh_real value) { return value < WH_R(0.0) ? -value : value; }

/* True below 1e15; false for NaN. */
static bool is_small(wh_real value) { return size_of(value) < WH_R(1e15); }

static int blamed_by_rule(const wh_real *value, unsigned n) {
    wh_real all = WH_R(0.0);
    for (unsigned i = 0; i < n; i++) {
        all += size_of(value[i]);
    }
    if (is_small(all)) {
        return NONE;
    }
    unsigned at = 0;
    while (at + 1 < n && is_small(value[at])) {
        at++;
    }
    return (int)at;
}

/* Draws a number: ordinary, near the bound, or invalid. */
static wh_real drawn(uint64_t *seed) {
    static const wh_real edge[] = {WH_R(0.0),
                                   WH_R(1e-30),
                                   WH_R(5.4e11),
                                   WH_R(5.6e11),
                                   WH_R(1.2e12),
                                   WH_R(2.5e14),
                                   WH_R(4.9e14),
                                   WH_R(9.9e14),
                                   WH_R(1e15),
                                   WH_R(1e30),
                                   (wh_real)__builtin_inf(),
                                   (wh_real)__builtin_nan("")};
    const wh_real sign = draw_one_in(seed, 2) ? WH_R(1.0) : WH_R(-1.0);
    if (!draw_one_in(seed, 3)) {
        return sign * draw_broken(seed, 0, 100);
    }
    return sign * edge[draw_one_of(seed, sizeof edge / sizeof edge[0])];
}

static void expect_blamed(int rule, unsigned first, wh_status status, const wh_state *state) {
    TEST_ASSERT_TRUE(status == WH_E_DIVERGED);
    TEST_ASSERT_TRUE(state->fault == (int)first + rule);
}

static wh_status by_registers(const wh_real *v, unsigned n, unsigned first, wh_state *state) {
    const wh_real last = v[n - 1];
    if (n <= 4) {
        return wh_refuse_four(state, first, n, v[0], v[1], n > 2 ? v[2] : last, last);
    }
    return wh_refuse_eight(state, first, n, v[0], v[1], v[2], v[3], v[4], n > 5 ? v[5] : last,
                           n > 6 ? v[6] : last, last);
}

TEST(refuse, first_invalid_value_is_named) {
    uint64_t seed = 26;
    unsigned refused = 0;
    for (unsigned i = 0; i < (WH_TEST_SMALL ? 2000U : 200000U); i++) {
        wh_real value[MOST] = {0};
        wh_state state = {0};
        const unsigned n = 1 + draw_one_of(&seed, MOST);
        const unsigned first = draw_one_of(&seed, 5);
        for (unsigned k = 0; k < n; k++) {
            value[k] = drawn(&seed);
        }
        const int rule = blamed_by_rule(value, n);
        TEST_ASSERT_TRUE(wh_all_believable(value, n) == (rule == NONE));
        TEST_ASSERT_TRUE(wh_matrix_believable(value, n) == (rule == NONE));
        if (rule == NONE) {
            continue;
        }
        refused++;
        expect_blamed(rule, first, wh_refuse_first(value, n, first, &state), &state);
        expect_blamed(rule, first, wh_refuse_among(value, n, first, &state), &state);
        if (n >= 2 && n <= 8) {
            expect_blamed(rule, first, by_registers(value, n, first, &state), &state);
        }
    }
    TEST_ASSERT_TRUE(refused > 500);
}

TEST(refuse, empty_arrays_are_accepted) {
    TEST_ASSERT_TRUE(wh_all_believable(NULL, 0));
    TEST_ASSERT_TRUE(wh_matrix_believable(NULL, 0));
}

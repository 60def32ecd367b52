/* test_hyperbolic.c: the core's hyperbolic functions: edges, order, symmetry, identities, and equal bits on every machine. */
#include "edges.h"
#include "tests/suites.h"

TEST(hyperbolic, hyperbolic_edges) {
    static const edge of_sinh[] = {{ZERO, ZERO},          {SMALLEST, SMALLEST},
                                   {NORMAL, NORMAL},      {ONE, WH_R(1.1752011936438014569)},
                                   {LARGEST, INFINITE},   {INFINITE, INFINITE},
                                   {NO_NUMBER, NO_NUMBER}};
    static const edge of_cosh[] = {{ZERO, ONE},
                                   {-ZERO, ONE},
                                   {SMALLEST, ONE},
                                   {-NORMAL, ONE},
                                   {ONE, WH_R(1.5430806348152437785)},
                                   {-ONE, WH_R(1.5430806348152437785)},
                                   {LARGEST, INFINITE},
                                   {-LARGEST, INFINITE},
                                   {INFINITE, INFINITE},
                                   {-INFINITE, INFINITE},
                                   {NO_NUMBER, NO_NUMBER}};
    static const edge of_tanh[] = {{ZERO, ZERO},      {SMALLEST, SMALLEST},
                                   {NORMAL, NORMAL},  {ONE, WH_R(0.76159415595576488812)},
                                   {WH_R(30.0), ONE}, {LARGEST, ONE},
                                   {INFINITE, ONE},   {NO_NUMBER, NO_NUMBER}};
    EXPECT_EDGES(wh_sinh, of_sinh, true);
    EXPECT_EDGES(wh_cosh, of_cosh, false);
    EXPECT_EDGES(wh_tanh, of_tanh, true);
}

/* Boundaries between two ways of computing: neighbours, a few thousand on either side. */
TEST(hyperbolic, hyperbolic_never_fall) {
    static const wh_real from[] = {WH_R(0.25), ONE, WH_R(8.0), WH_R(88.0)};
    const wh_real next = ONE + wh_pow(TWO, (wh_real)(1 - DIGITS));
    for (unsigned k = 0; k < sizeof from / sizeof from[0]; k++) {
        wh_real x = from[k] * (ONE - WH_R(3000.0) * (next - ONE));
        wh_real last[3] = {ZERO, ZERO, ZERO};
        for (int i = 0; i < 6000; i++) {
            const wh_real now[3] = {wh_sinh(x), wh_cosh(x), wh_tanh(x)};
            for (int f = 0; f < 3; f++) {
                TEST_ASSERT_TRUE(now[f] >= last[f]);
                last[f] = now[f];
            }
            x = x * next > x ? x * next : x;
        }
    }
}

/* cosh + sinh is e^x, cosh - sinh e^-x, sinh/cosh tanh: to the round-off. */
TEST(hyperbolic, hyperbolic_identities) {
    const wh_real unit = wh_pow(TWO, (wh_real)(1 - DIGITS));
    scattered_state = 8;
    for (int i = 0; i < 1000; i++) {
        const wh_real x = part() * (i % 2 == 0 ? ONE : WH_R(20.0));
        const wh_real c = wh_cosh(x);
        const wh_real s = wh_sinh(x);
        TEST_ASSERT_TRUE(WH_ABS(c + s - wh_exp(x)) <= THREE * unit * c);
        TEST_ASSERT_TRUE(WH_ABS(c - s - wh_exp(-x)) <= THREE * unit * c);
        TEST_ASSERT_TRUE(WH_ABS(s / c - wh_tanh(x)) <= THREE * unit * WH_ABS(wh_tanh(x)));
    }
}

TEST(hyperbolic, hyperbolic_symmetry) {
    scattered_state = 5;
    for (int i = 0; i < 1000; i++) {
        const wh_real x = part();
        const wh_real y = part() * WH_R(100.0);
        TEST_ASSERT_TRUE(same(wh_sinh(-y), -wh_sinh(y)));
        TEST_ASSERT_TRUE(same(wh_cosh(-y), wh_cosh(y)));
        TEST_ASSERT_TRUE(same(wh_tanh(-x), -wh_tanh(x)));
    }
}

/* Later functions have a hash of their own. */
static uint64_t mixed_of_hyperbolic(uint64_t hash, wh_real x) {
    return mixed(mixed(mixed(hash, wh_sinh(x)), wh_cosh(x)), wh_tanh(x));
}

TEST(hyperbolic, same_bits_of_hyperbolic) {
    scattered_state = 9;
    uint64_t hash = WH_HASH_START;
    for (int i = 0; i < 1500; i++) {
        hash = mixed_of_hyperbolic(hash, any());
        hash = mixed_of_hyperbolic(hash, part());
        hash = mixed_of_hyperbolic(hash, part() * WH_R(12.0));
        hash = mixed_of_hyperbolic(hash, part() * (WH_DOUBLE ? WH_R(720.0) : WH_R(90.0)));
    }
    TEST_ASSERT_EQUAL_HEX64(WH_DOUBLE ? UINT64_C(0x46e5312fb321686a) : UINT64_C(0x255e8fa7b3dd3550),
                            hash);
}

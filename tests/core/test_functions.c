/* test_functions.c: the core's functions: edges, exact results, order, symmetry, and equal bits on every machine.
 * tests/host/test_function_accuracy.c, test_double_functions.c and make functions-exhaustive measure the errors. */
#include "edges.h"
#include "tests/suites.h"

#define PI WH_R(3.14159265358979323846)
/* --- edges, after C11's Annex F -------------------------------------------------------------------------- */
typedef wh_real function_of_two(wh_real x, wh_real y);

typedef struct edge_of_two {
    wh_real x;
    wh_real y;
    wh_real wanted;
} edge_of_two;

TEST(functions, edges) {
    static const edge of_exp[] = {
        {ZERO, ONE},         {-ZERO, ONE},          {SMALLEST, ONE},
        {-SMALLEST, ONE},    {-NORMAL, ONE},        {ONE, WH_R(2.71828182845904523536)},
        {LARGEST, INFINITE}, {-LARGEST, ZERO},      {INFINITE, INFINITE},
        {-INFINITE, ZERO},   {NO_NUMBER, NO_NUMBER}};
    static const edge of_log[] = {{ONE, ZERO},           {ZERO, -INFINITE},
                                  {-ZERO, -INFINITE},    {-SMALLEST, NO_NUMBER},
                                  {-ONE, NO_NUMBER},     {-INFINITE, NO_NUMBER},
                                  {INFINITE, INFINITE},  {TWO, WH_R(0.69314718055994530942)},
                                  {NO_NUMBER, NO_NUMBER}};
    static const edge of_tan[] = {{ZERO, ZERO},
                                  {SMALLEST, SMALLEST},
                                  {NORMAL, NORMAL},
                                  {INFINITE, NO_NUMBER},
                                  {NO_NUMBER, NO_NUMBER}};
    static const edge of_asin[] = {{ZERO, ZERO},
                                   {SMALLEST, SMALLEST},
                                   {NORMAL, NORMAL},
                                   {ONE, PI / TWO},
                                   {HALF, WH_R(0.52359877559829887308)},
                                   {TWO, NO_NUMBER},
                                   {INFINITE, NO_NUMBER},
                                   {NO_NUMBER, NO_NUMBER}};
    static const edge of_acos[] = {{ONE, ZERO},
                                   {-ONE, PI},
                                   {ZERO, PI / TWO},
                                   {-ZERO, PI / TWO},
                                   {TWO, NO_NUMBER},
                                   {-TWO, NO_NUMBER},
                                   {HALF, WH_R(1.0471975511965977462)},
                                   {SMALLEST, PI / TWO},
                                   {INFINITE, NO_NUMBER},
                                   {NO_NUMBER, NO_NUMBER}};
    static const edge of_atan[] = {
        {ZERO, ZERO},        {SMALLEST, SMALLEST}, {NORMAL, NORMAL},      {ONE, PI / WH_R(4.0)},
        {LARGEST, PI / TWO}, {INFINITE, PI / TWO}, {NO_NUMBER, NO_NUMBER}};
    EXPECT_EDGES(wh_exp, of_exp, false);
    EXPECT_EDGES(wh_log, of_log, false);
    EXPECT_EDGES(wh_tan, of_tan, true);
    EXPECT_EDGES(wh_asin, of_asin, true);
    EXPECT_EDGES(wh_acos, of_acos, false);
    EXPECT_EDGES(wh_atan, of_atan, true);
}

TEST(functions, edges_of_atan2) {
    static const edge_of_two edges[] = {/* y, x; the upper half */
                                        {ZERO, ZERO, ZERO},
                                        {ZERO, -ZERO, PI},
                                        {ZERO, ONE, ZERO},
                                        {ZERO, -ONE, PI},
                                        {ZERO, INFINITE, ZERO},
                                        {ZERO, -INFINITE, PI},
                                        {ONE, ZERO, PI / TWO},
                                        {ONE, -ZERO, PI / TWO},
                                        {SMALLEST, ZERO, PI / TWO},
                                        {ONE, INFINITE, ZERO},
                                        {ONE, -INFINITE, PI},
                                        {INFINITE, ONE, PI / TWO},
                                        {INFINITE, -LARGEST, PI / TWO},
                                        {INFINITE, INFINITE, PI / WH_R(4.0)},
                                        {INFINITE, -INFINITE, THREE * PI / WH_R(4.0)},
                                        {ONE, ONE, PI / WH_R(4.0)},
                                        {ONE, -ONE, THREE * PI / WH_R(4.0)},
                                        {SMALLEST, SMALLEST, PI / WH_R(4.0)},
                                        {SMALLEST, LARGEST, ZERO},
                                        {SMALLEST, -LARGEST, PI},
                                        {LARGEST, SMALLEST, PI / TWO},
                                        {SMALLEST, ONE, SMALLEST},
                                        {THREE * SMALLEST, ONE, THREE * SMALLEST},
                                        {NO_NUMBER, ONE, NO_NUMBER},
                                        {ONE, NO_NUMBER, NO_NUMBER}};
    for (unsigned i = 0; i < sizeof edges / sizeof edges[0]; i++) {
        const edge_of_two *e = &edges[i];
        TEST_ASSERT_TRUE(same(wh_atan2(e->x, e->y), e->wanted));
        TEST_ASSERT_TRUE(same(wh_atan2(-e->x, e->y), -e->wanted));
    }
}

TEST(functions, edges_of_power) {
    static const edge_of_two edges[] = {
        {ZERO, THREE, ZERO},
        {-ZERO, THREE, -ZERO},
        {ZERO, -THREE, INFINITE},
        {-ZERO, -THREE, -INFINITE},
        {ZERO, TWO, ZERO},
        {-ZERO, TWO, ZERO},
        {-ZERO, -TWO, INFINITE},
        {-ZERO, HALF, ZERO},
        {-ZERO, -HALF, INFINITE},
        {ZERO, INFINITE, ZERO},
        {-ZERO, -INFINITE, INFINITE},
        {-ONE, INFINITE, ONE},
        {-ONE, -INFINITE, ONE},
        {ONE, INFINITE, ONE},
        {ONE, NO_NUMBER, ONE},
        {NO_NUMBER, ZERO, ONE},
        {NO_NUMBER, -ZERO, ONE},
        {INFINITE, ZERO, ONE},
        {-TWO, HALF, NO_NUMBER},
        {-LARGEST, WH_R(1.5), NO_NUMBER},
        {HALF, INFINITE, ZERO},
        {-HALF, INFINITE, ZERO},
        {HALF, -INFINITE, INFINITE},
        {TWO, INFINITE, INFINITE},
        {-TWO, -INFINITE, ZERO},
        {-INFINITE, -THREE, -ZERO},
        {-INFINITE, -TWO, ZERO},
        {-INFINITE, -HALF, ZERO},
        {-INFINITE, THREE, -INFINITE},
        {-INFINITE, TWO, INFINITE},
        {-INFINITE, HALF, INFINITE},
        {INFINITE, -HALF, ZERO},
        {INFINITE, HALF, INFINITE},
        {-INFINITE, INFINITE, INFINITE},
        {NO_NUMBER, ONE, NO_NUMBER},
        {TWO, NO_NUMBER, NO_NUMBER},
        {LARGEST, ONE, LARGEST},
        {-LARGEST, ONE, -LARGEST},
        {LARGEST, TWO, INFINITE},
        {-LARGEST, THREE, -INFINITE},
        {LARGEST, -TWO, ZERO},
        {-LARGEST, -THREE, -ZERO},
        {SMALLEST, ONE, SMALLEST},
        {SMALLEST, TWO, ZERO},
        {-ONE, LARGEST, ONE},
        {-ONE, SMALLEST, NO_NUMBER},
        {TWO, SMALLEST, ONE},
        {LARGEST, SMALLEST, ONE},
        {HALF, LARGEST, ZERO},
        {TWO, LARGEST, INFINITE},
    };
    for (unsigned i = 0; i < sizeof edges / sizeof edges[0]; i++) {
        TEST_ASSERT_TRUE(same(wh_pow(edges[i].x, edges[i].y), edges[i].wanted));
    }
}

TEST(functions, exact_powers_of_two) {
    wh_real wanted = SMALLEST;
    for (int n = LEAST_POWER; n <= MOST_POWER; n++) {
        const wh_real power = (wh_real)n;
        TEST_ASSERT_TRUE(wh_pow(TWO, power) == wanted);
        TEST_ASSERT_TRUE(wh_pow(HALF, -power) == wanted);
        TEST_ASSERT_TRUE(wh_pow(WH_R(4.0), power * HALF) == wanted);
        TEST_ASSERT_TRUE(wh_pow(WH_R(0.0625), power * WH_R(-0.25)) == wanted);
        TEST_ASSERT_TRUE(wh_pow(-TWO, power) == (n % 2 == 0 ? wanted : -wanted));
        wanted *= TWO;
    }
    for (int n = LEAST_POWER - 1; n > LEAST_POWER - 40;
         n--) { /* half the smallest: to even, zero */
        TEST_ASSERT_TRUE(wh_pow(TWO, (wh_real)n) == ZERO);
        TEST_ASSERT_TRUE(wh_pow(HALF, (wh_real)-n) == ZERO);
    }
}

TEST(functions, exact_powers) {
    const wh_real limit = wh_pow(TWO, (wh_real)DIGITS);
    const wh_real quarter = WH_R(0.25);
    for (int base = 2; base <= 40; base++) {
        const wh_real b = (wh_real)base;
        wh_real wanted = ONE;
        for (int n = 0; wanted < limit; n++) {
            const wh_real power = (wh_real)n;
            TEST_ASSERT_TRUE(wh_pow(b, power) == wanted);
            TEST_ASSERT_TRUE(wh_pow(-b, power) == (n % 2 == 0 ? wanted : -wanted));
            TEST_ASSERT_TRUE(wh_pow(b * WH_R(0.125), power) ==
                             wanted * wh_pow(TWO, WH_R(-3.0) * power));
            TEST_ASSERT_TRUE(wh_pow(b * b, power * HALF) == wanted);
            TEST_ASSERT_TRUE(b * b * b * b >= limit ||
                             wh_pow(b * b * b * b, power * quarter) == wanted);
            wanted *= b;
        }
    }
}

TEST(functions, never_falls) {
    wh_real last[6] = {-INFINITE, -INFINITE, -INFINITE, -INFINITE, -INFINITE, -INFINITE};
    wh_real last_cosine = INFINITE;
    for (int i = 1; i <= 4000; i++) {
        const wh_real x = (wh_real)i * WH_R(0x1p-12) - WH_R(0.48828125); /* 2^-12 apart */
        const wh_real now[6] = {wh_exp(x),  wh_log(x + HALF), wh_asin(x),
                                wh_atan(x), wh_sinh(x),       wh_tanh(x)};
        for (int k = 0; k < 6; k++) {
            TEST_ASSERT_TRUE(now[k] > last[k]);
            last[k] = now[k];
        }
        const wh_real arc = wh_acos(x);
        TEST_ASSERT_TRUE(arc < last_cosine);
        last_cosine = arc;
    }
}

TEST(functions, symmetry) {
    scattered_state = 5;
    for (int i = 0; i < 1000; i++) {
        const wh_real x = part();
        const wh_real y = part() * WH_R(100.0);
        TEST_ASSERT_TRUE(same(wh_tan(-y), -wh_tan(y)));
        TEST_ASSERT_TRUE(same(wh_asin(-x), -wh_asin(x)));
        TEST_ASSERT_TRUE(same(wh_atan(-y), -wh_atan(y)));
        TEST_ASSERT_TRUE(same(wh_atan2(-x, y), -wh_atan2(x, y)));
        TEST_ASSERT_TRUE(same(wh_pow(-x, THREE), -wh_pow(x, THREE)));
        TEST_ASSERT_TRUE(same(wh_pow(-x, WH_R(-2.0)), wh_pow(x, WH_R(-2.0))));
        TEST_ASSERT_TRUE(wh_pow(x, ONE) == x);
    }
}

/* Inverse pairs, to the round-off of the intermediate. */
TEST(functions, inverses) {
    const wh_real unit = wh_pow(TWO, (wh_real)(1 - DIGITS));
    scattered_state = 6;
    for (int i = 0; i < 1000; i++) {
        const wh_real x = part();
        const wh_real positive = x * x + WH_R(0.001);
        const wh_real log_size = wh_log(positive) < ZERO ? -wh_log(positive) : wh_log(positive);
        const wh_real back = wh_exp(wh_log(positive)) / positive - ONE;
        TEST_ASSERT_TRUE(WH_ABS(back) <= (log_size + TWO) * unit);
        TEST_ASSERT_TRUE(WH_ABS(wh_tan(wh_atan(x)) - x) <= WH_R(4.0) * WH_ABS(x) * unit);
        TEST_ASSERT_TRUE(WH_ABS(wh_asin(x) + wh_acos(x) - PI / TWO) <= WH_R(4.0) * unit);
        TEST_ASSERT_TRUE(WH_ABS(wh_atan2(x, positive) - wh_atan(x / positive)) <= TWO * unit);
    }
}

static uint64_t mixed_of_all(uint64_t hash, wh_real x, wh_real y) {
    hash = mixed(hash, wh_exp(x));
    hash = mixed(hash, wh_log(x));
    hash = mixed(hash, wh_tan(x));
    hash = mixed(hash, wh_asin(x));
    hash = mixed(hash, wh_acos(x));
    hash = mixed(hash, wh_atan(x));
    hash = mixed(hash, wh_atan2(x, y));
    return mixed(hash, wh_pow(x, y));
}

TEST(functions, same_bits_everywhere) {
    scattered_state = 7;
    uint64_t hash = WH_HASH_START;
    for (int i = 0; i < 1500; i++) {
        const wh_real x = any();
        const wh_real y = any();
        const wh_real p = part();
        const wh_real q = part();
        hash = mixed_of_all(hash, x, y);                                   /* log-uniform sizes */
        hash = mixed_of_all(hash, p, q * WH_R(20.0));                      /* asin, acos */
        hash = mixed_of_all(hash, p * WH_R(90.0), q);                      /* exp, tan */
        hash = mixed_of_all(hash, ONE + p * WH_R(0.01), q * WH_R(5000.0)); /* powers near one */
    }
    TEST_ASSERT_EQUAL_HEX64(WH_DOUBLE ? UINT64_C(0x4de95b45dd636336) : UINT64_C(0x631ccc03b4a2e5b8),
                            hash);
}

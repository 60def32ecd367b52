/* test_functions.c: the core's functions: special values of C11's Annex F, exact powers, ends of the range,
 * monotonicity, symmetry, identities, and equal bits on every machine. Other tests measure the errors:
 * tests/host/test_function_accuracy.c, test_double_functions.c and `make functions-exhaustive`. */
#include "core/function.h"
#include "core/hash.h"
#if WH_DOUBLE
#include "core/function_double.h"
#endif

#include "tests/scattered.h"
#include "tests/suites.h"

#define PI WH_R(3.14159265358979323846)

#if WH_DOUBLE
#define INFINITE __builtin_inf()
#define NO_NUMBER __builtin_nan("")
#define LARGEST 1.7976931348623157e308
#define SMALLEST 4.9406564584124654e-324 /* subnormal */
#define NORMAL 2.2250738585072014e-308   /* the smallest number with all digits */
#define LEAST_POWER (-1074)
#define MOST_POWER 1023
#define DIGITS 53
#else
#define INFINITE __builtin_inff()
#define NO_NUMBER __builtin_nanf("")
#define LARGEST 3.40282347e38f
#define SMALLEST 1.40129846e-45f
#define NORMAL 1.17549435e-38f
#define LEAST_POWER (-149)
#define MOST_POWER 127
#define DIGITS 24
#endif
#define ZERO WH_R(0.0)
#define ONE WH_R(1.0)
#define TWO WH_R(2.0)
#define HALF WH_R(0.5)
#define THREE WH_R(3.0)

static uint64_t bits_of(wh_real x) { return wh_hash_real(0, x); }

/* True if both have the same bits, or if both are NaN. */
static bool same(wh_real a, wh_real b) { return bits_of(a) == bits_of(b) || (a != a && b != b); }

typedef wh_real function_of_one(wh_real x);

typedef struct edge {
    wh_real x;
    wh_real wanted;
} edge;

static void expect_edges(function_of_one *f, const edge *edges, unsigned count, bool is_odd) {
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(same(f(edges[i].x), edges[i].wanted));
        TEST_ASSERT_TRUE(!is_odd || same(f(-edges[i].x), -edges[i].wanted));
    }
}
#define EXPECT(f, is_odd, ...) \
    do { \
        const edge edges[] = {__VA_ARGS__}; \
        expect_edges(f, edges, sizeof edges / sizeof edges[0], is_odd); \
    } while (false)

static wh_real part(void) { return (wh_real)(int32_t)(scattered() >> 32) * WH_R(0x1p-31); }

static wh_real any(void) {
    const uint64_t word = scattered();
#if WH_DOUBLE
    const union {
        uint64_t bits;
        double value;
    } as = {.bits = word};
#else
    const union {
        uint32_t bits;
        float value;
    } as = {.bits = (uint32_t)(word >> 32)};
#endif
    return as.value;
}

/* All NaNs count as equal, because their bits depend on their origin. */
static uint64_t mixed(uint64_t hash, wh_real x) { return wh_hash_real(hash, x != x ? ONE : x); }

TEST(functions, edges) {
    EXPECT(wh_exp, false, {ZERO, ONE}, {-ZERO, ONE}, {SMALLEST, ONE}, {-SMALLEST, ONE},
           {-NORMAL, ONE}, {ONE, WH_R(2.71828182845904523536)}, {LARGEST, INFINITE},
           {-LARGEST, ZERO}, {INFINITE, INFINITE}, {-INFINITE, ZERO}, {NO_NUMBER, NO_NUMBER});
    EXPECT(wh_log, false, {ONE, ZERO}, {ZERO, -INFINITE}, {-ZERO, -INFINITE},
           {-SMALLEST, NO_NUMBER}, {-ONE, NO_NUMBER}, {-INFINITE, NO_NUMBER}, {INFINITE, INFINITE},
           {TWO, WH_R(0.69314718055994530942)}, {NO_NUMBER, NO_NUMBER});
    EXPECT(wh_tan, true, {ZERO, ZERO}, {SMALLEST, SMALLEST}, {NORMAL, NORMAL},
           {INFINITE, NO_NUMBER}, {NO_NUMBER, NO_NUMBER});
    EXPECT(wh_asin, true, {ZERO, ZERO}, {SMALLEST, SMALLEST}, {NORMAL, NORMAL}, {ONE, PI / TWO},
           {HALF, WH_R(0.52359877559829887308)}, {WH_R(1.5), NO_NUMBER}, {INFINITE, NO_NUMBER},
           {NO_NUMBER, NO_NUMBER});
    EXPECT(wh_acos, false, {ONE, ZERO}, {-ONE, PI}, {ZERO, PI / TWO}, {-ZERO, PI / TWO},
           {SMALLEST, PI / TWO}, {-SMALLEST, PI / TWO}, {HALF, WH_R(1.0471975511965977462)},
           {WH_R(1.5), NO_NUMBER}, {-LARGEST, NO_NUMBER}, {INFINITE, NO_NUMBER},
           {NO_NUMBER, NO_NUMBER});
    EXPECT(wh_atan, true, {ZERO, ZERO}, {SMALLEST, SMALLEST}, {NORMAL, NORMAL},
           {ONE, PI / WH_R(4.0)}, {LARGEST, PI / TWO}, {INFINITE, PI / TWO},
           {NO_NUMBER, NO_NUMBER});
    EXPECT(wh_sinh, true, {ZERO, ZERO}, {SMALLEST, SMALLEST}, {NORMAL, NORMAL},
           {ONE, WH_R(1.1752011936438014569)}, {LARGEST, INFINITE}, {INFINITE, INFINITE},
           {NO_NUMBER, NO_NUMBER});
    EXPECT(wh_cosh, false, {ZERO, ONE}, {-ZERO, ONE}, {SMALLEST, ONE}, {-NORMAL, ONE},
           {ONE, WH_R(1.5430806348152437785)}, {-ONE, WH_R(1.5430806348152437785)},
           {LARGEST, INFINITE}, {-LARGEST, INFINITE}, {INFINITE, INFINITE}, {-INFINITE, INFINITE},
           {NO_NUMBER, NO_NUMBER});
    EXPECT(wh_tanh, true, {ZERO, ZERO}, {SMALLEST, SMALLEST}, {NORMAL, NORMAL},
           {ONE, WH_R(0.76159415595576488812)}, {WH_R(30.0), ONE}, {LARGEST, ONE}, {INFINITE, ONE},
           {NO_NUMBER, NO_NUMBER});
#if WH_DOUBLE
    EXPECT(wh_sine, true, {ZERO, ZERO}, {SMALLEST, SMALLEST}, {INFINITE, NO_NUMBER},
           {NO_NUMBER, NO_NUMBER});
    EXPECT(wh_cosine, false, {ZERO, ONE}, {-ZERO, ONE}, {SMALLEST, ONE}, {INFINITE, NO_NUMBER},
           {-INFINITE, NO_NUMBER}, {NO_NUMBER, NO_NUMBER});
#endif
}

typedef wh_real function_of_two(wh_real x, wh_real y);

typedef struct edge_of_two {
    wh_real x;
    wh_real y;
    wh_real wanted;
} edge_of_two;

/* `is_odd` is true if the function changes its sign with its first argument. */
static void expect_edges_of_two(function_of_two *f, const edge_of_two *edges, unsigned count,
                                bool is_odd) {
    for (unsigned i = 0; i < count; i++) {
        const edge_of_two *e = &edges[i];
        TEST_ASSERT_TRUE(same(f(e->x, e->y), e->wanted));
        TEST_ASSERT_TRUE(!is_odd || same(f(-e->x, e->y), -e->wanted));
    }
}
#define EXPECT_TWO(f, is_odd, ...) \
    do { \
        const edge_of_two edges[] = {__VA_ARGS__}; \
        expect_edges_of_two(f, edges, sizeof edges / sizeof edges[0], is_odd); \
    } while (false)

TEST(functions, edges_of_atan2_and_power) {
    EXPECT_TWO(wh_atan2, true, {ZERO, ZERO, ZERO}, {ZERO, -ZERO, PI}, {ZERO, ONE, ZERO},
               {ZERO, -ONE, PI}, {ZERO, INFINITE, ZERO}, {ZERO, -INFINITE, PI},
               {ONE, ZERO, PI / TWO}, {ONE, -ZERO, PI / TWO}, {SMALLEST, ZERO, PI / TWO},
               {ONE, INFINITE, ZERO}, {ONE, -INFINITE, PI}, {INFINITE, ONE, PI / TWO},
               {INFINITE, -LARGEST, PI / TWO}, {INFINITE, INFINITE, PI / WH_R(4.0)},
               {INFINITE, -INFINITE, THREE * PI / WH_R(4.0)}, {ONE, ONE, PI / WH_R(4.0)},
               {ONE, -ONE, THREE * PI / WH_R(4.0)}, {SMALLEST, SMALLEST, PI / WH_R(4.0)},
               {SMALLEST, LARGEST, ZERO}, {SMALLEST, -LARGEST, PI}, {LARGEST, SMALLEST, PI / TWO},
               {SMALLEST, ONE, SMALLEST}, {THREE * SMALLEST, ONE, THREE * SMALLEST},
               {NO_NUMBER, ONE, NO_NUMBER}, {ONE, NO_NUMBER, NO_NUMBER}, {ZERO, -SMALLEST, PI},
               {LARGEST, LARGEST, PI / WH_R(4.0)}, {LARGEST, -SMALLEST, PI / TWO},
               {ZERO, NO_NUMBER, NO_NUMBER}, {NO_NUMBER, INFINITE, NO_NUMBER},
               {INFINITE, NO_NUMBER, NO_NUMBER});
    EXPECT_TWO(wh_pow, false, {NO_NUMBER, ZERO, ONE}, {INFINITE, -ZERO, ONE}, {ZERO, ZERO, ONE},
               {ONE, NO_NUMBER, ONE}, {ONE, INFINITE, ONE}, {ONE, LARGEST, ONE},
               {NO_NUMBER, ONE, NO_NUMBER}, {TWO, NO_NUMBER, NO_NUMBER}, {ZERO, THREE, ZERO},
               {-ZERO, THREE, -ZERO}, {-ZERO, TWO, ZERO}, {-ZERO, HALF, ZERO},
               {ZERO, -THREE, INFINITE}, {-ZERO, -THREE, -INFINITE}, {-ZERO, -TWO, INFINITE},
               {-ZERO, -HALF, INFINITE}, {ZERO, INFINITE, ZERO}, {-ZERO, INFINITE, ZERO},
               {ZERO, -INFINITE, INFINITE}, {-ZERO, -INFINITE, INFINITE}, {-ONE, INFINITE, ONE},
               {-ONE, -INFINITE, ONE}, {HALF, INFINITE, ZERO}, {-HALF, INFINITE, ZERO},
               {HALF, -INFINITE, INFINITE}, {TWO, INFINITE, INFINITE}, {-TWO, INFINITE, INFINITE},
               {TWO, -INFINITE, ZERO}, {INFINITE, TWO, INFINITE}, {INFINITE, SMALLEST, INFINITE},
               {INFINITE, -SMALLEST, ZERO}, {INFINITE, INFINITE, INFINITE},
               {INFINITE, -INFINITE, ZERO}, {-INFINITE, THREE, -INFINITE},
               {-INFINITE, TWO, INFINITE}, {-INFINITE, HALF, INFINITE}, {-INFINITE, -THREE, -ZERO},
               {-INFINITE, -TWO, ZERO}, {-INFINITE, -HALF, ZERO}, {-INFINITE, LARGEST, INFINITE},
               {-TWO, HALF, NO_NUMBER}, {-TWO, SMALLEST, NO_NUMBER},
               {-SMALLEST, WH_R(1.5), NO_NUMBER}, {-TWO, THREE, WH_R(-8.0)}, {-TWO, TWO, WH_R(4.0)},
               {-TWO, -THREE, WH_R(-0.125)}, {-ONE, LARGEST, ONE}, {LARGEST, TWO, INFINITE},
               {-LARGEST, THREE, -INFINITE}, {SMALLEST, TWO, ZERO}, {-SMALLEST, THREE, -ZERO},
               {TWO, LARGEST, INFINITE}, {TWO, -LARGEST, ZERO}, {HALF, LARGEST, ZERO},
               {THREE, SMALLEST, ONE}, {LARGEST, ONE, LARGEST}, {SMALLEST, ONE, SMALLEST},
               {-SMALLEST, ONE, -SMALLEST}, {LARGEST, SMALLEST, ONE}, {ZERO, TWO, ZERO},
               {NO_NUMBER, -ZERO, ONE}, {INFINITE, ZERO, ONE}, {-LARGEST, WH_R(1.5), NO_NUMBER},
               {-TWO, -INFINITE, ZERO}, {INFINITE, -HALF, ZERO}, {INFINITE, HALF, INFINITE},
               {-INFINITE, INFINITE, INFINITE}, {-LARGEST, ONE, -LARGEST}, {LARGEST, -TWO, ZERO},
               {-LARGEST, -THREE, -ZERO}, {-ONE, SMALLEST, NO_NUMBER}, {TWO, SMALLEST, ONE});
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
         n--) { /* half of the smallest number: the tie goes to the even one, zero */
        TEST_ASSERT_TRUE(wh_pow(TWO, (wh_real)n) == ZERO);
        TEST_ASSERT_TRUE(wh_pow(HALF, (wh_real)-n) == ZERO);
    }
}

TEST(functions, exact_powers) {
    const wh_real limit = wh_pow(TWO, (wh_real)DIGITS);
    const wh_real quarter = WH_R(0.25);
    for (int base = 2; base < 200; base++) {
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

/* Arguments just inside and just beyond each limit from which a result is infinite, zero or one. */
TEST(functions, ends_of_the_range) {
#if WH_DOUBLE
    EXPECT(wh_exp, false, {0x1.62e42fefa39efp9, 0x1.fffffffffff2ap1023},
           {0x1.62e42fefa39fp9, INFINITE}, {-0x1.74910d52d3051p9, SMALLEST},
           {-0x1.74910d52d3052p9, ZERO});
    EXPECT(wh_sinh, false, {0x1.633ce8fb9f87dp+9, 0x1.ffffffffffd3bp+1023},
           {0x1.633ce8fb9f87ep+9, INFINITE}, {-0x1.633ce8fb9f87dp+9, -0x1.ffffffffffd3bp+1023});
    EXPECT(wh_cosh, false, {0x1.633ce8fb9f87dp+9, 0x1.ffffffffffd3bp+1023},
           {-0x1.633ce8fb9f87ep+9, INFINITE});
    EXPECT(wh_tanh, false, {0x1.30fc1931f09c9p+4, 0x1.fffffffffffffp-1},
           {0x1.30fc1931f09cbp+4, ONE});
    /* No double is nearer to a multiple of a quarter turn than this one. */
    EXPECT(wh_cosine, false, {0x1.6ac5b262ca1ffp849, -0x1.14ae72e6ba22fp-61});
    EXPECT(wh_sine, false, {-0x1.6ac5b262ca1ffp849, -1.0});
    EXPECT(wh_tan, false, {0x1.6ac5b262ca1ffp849, -0x1.d9ba9a7975636p60});
    TEST_ASSERT_TRUE(wh_pow(2.0, 0x1.fffffffffffffp9) < INFINITE);
    TEST_ASSERT_TRUE(wh_pow(2.0, -1075.0) == 0.0); /* a tie, which goes to the even zero */
    TEST_ASSERT_TRUE(wh_pow(2.0, -0x1.0cbffffffffffp10) == SMALLEST);
#else
    EXPECT(wh_exp, false, {0x1.62e42ep6f, 0x1.ffff08p127f}, {0x1.62e43p6f, INFINITE},
           {-0x1.9fe368p6f, SMALLEST}, {-0x1.9fe36ap6f, ZERO});
    EXPECT(wh_sinh, false, {0x1.65a9f8p+6f, 0x1.ffffd8p+127f}, {0x1.65a9fap+6f, INFINITE},
           {-0x1.65a9f8p+6f, -0x1.ffffd8p+127f});
    EXPECT(wh_cosh, false, {0x1.65a9f8p+6f, 0x1.ffffd8p+127f}, {-0x1.65a9fap+6f, INFINITE});
    EXPECT(wh_tanh, false, {0x1.2p+3f, 0x1.fffffep-1f}, {0x1.206p+3f, ONE});
    TEST_ASSERT_TRUE(wh_pow(2.0f, 0x1.fffffep6f) < INFINITE);
    TEST_ASSERT_TRUE(wh_pow(2.0f, -150.0f) == 0.0f);
    TEST_ASSERT_TRUE(wh_pow(2.0f, -0x1.2bfffep7f) == SMALLEST);
#endif
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
        TEST_ASSERT_TRUE(same(wh_sinh(-y), -wh_sinh(y)));
        TEST_ASSERT_TRUE(same(wh_cosh(-y), wh_cosh(y)));
        TEST_ASSERT_TRUE(same(wh_tanh(-x), -wh_tanh(x)));
        TEST_ASSERT_TRUE(same(wh_atan2(-x, y), -wh_atan2(x, y)));
        TEST_ASSERT_TRUE(same(wh_pow(-x, THREE), -wh_pow(x, THREE)));
        TEST_ASSERT_TRUE(same(wh_pow(-x, WH_R(-2.0)), wh_pow(x, WH_R(-2.0))));
        TEST_ASSERT_TRUE(wh_pow(x, ONE) == x);
    }
}

/* A function and its inverse give the argument again, within the round-off of the intermediate number. */
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

/* Tests 3,000 neighbouring numbers on either side of each argument at which the method of computing changes. */
TEST(functions, hyperbolic_never_fall) {
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

/* cosh + sinh is e^x, cosh - sinh is e^-x, and sinh/cosh is tanh, within round-off. */
TEST(functions, hyperbolic_identities) {
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

static uint64_t mixed_of_all(uint64_t hash, wh_real x, wh_real y) {
#define MIX_ONE(name) hash = mixed(hash, wh_##name(x));
#define MIX_TWO(name) hash = mixed(hash, wh_##name(x, y));
    WH_FUNCTIONS(MIX_ONE, MIX_TWO)
#if WH_DOUBLE
    hash = mixed(mixed(hash, wh_sine(x)), wh_cosine(x));
#endif
    return hash;
}

TEST(functions, same_bits_everywhere) {
    scattered_state = 7;
    uint64_t hash = WH_HASH_START;
    for (int i = 0; i < 1500; i++) {
        const wh_real x = any();
        const wh_real y = any();
        const wh_real p = part();
        const wh_real q = part();
        hash = mixed_of_all(hash, x, y);              /* log-uniform sizes */
        hash = mixed_of_all(hash, p, q * WH_R(20.0)); /* asin, acos */
        hash = mixed_of_all(hash, p * WH_R(90.0), q); /* exp, tan */
        hash = mixed_of_all(hash, q * (WH_DOUBLE ? WH_R(720.0) : WH_R(90.0)), p); /* all of sinh */
        hash = mixed_of_all(hash, ONE + p * WH_R(0.01), q * WH_R(5000.0)); /* powers near one */
    }
    TEST_ASSERT_EQUAL_HEX64(WH_DOUBLE ? UINT64_C(0x9ae8335701c9dad0) : UINT64_C(0xb898d1374e1cd4c4),
                            hash);
}

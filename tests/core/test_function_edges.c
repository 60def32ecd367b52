/* test_function_edges.c: exact values of the core's functions in both builds: zeros, infinities, NaN and range ends as in C's
 * Annex F, and exact powers. In double, also the bits of a sweep's results, equal on every machine. */
#include "core/function.h"
#include "core/hash.h"

#if WH_DOUBLE
#include "core/function_double.h"
#endif

#include "tests/scattered.h"
#include "unity.h"

#include <stddef.h>

void suite_function_edges(void);

#define INF ((wh_real)__builtin_inf())
#define NAN_REAL ((wh_real)__builtin_nan(""))
#define ONE WH_R(1.0)
#define ZERO WH_R(0.0)
#define PI_REAL WH_R(3.14159265358979323846)
#define HALF_PI WH_R(1.57079632679489661923)

#if WH_DOUBLE
#define TINY 0x1p-1074
#define LARGEST 0x1.fffffffffffffp1023
#define DIGITS 53
#define LEAST_POWER (-1074)
#define MOST_POWER 1023
#else
#define TINY 0x1p-149f
#define LARGEST 0x1.fffffep127f
#define DIGITS 24
#define LEAST_POWER (-149)
#define MOST_POWER 127
#endif

/* Equal with the sign of zeros, or both NaN. */
static bool same(wh_real a, wh_real b) {
    const bool no_number = a != a && b != b;
    return no_number || (a == b && wh_hash_real(0, a) == wh_hash_real(0, b));
}

typedef struct value_at {
    wh_real x;
    wh_real value;
} value_at;

static void expect_values(const char *name, wh_real (*function)(wh_real), const value_at *at,
                          unsigned count) {
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_TRUE_MESSAGE(same(function(at[i].x), at[i].value), name);
    }
}
#define EXPECT(function, ...) \
    do { \
        const value_at at[] = {__VA_ARGS__}; \
        expect_values(#function, function, at, (unsigned)(sizeof at / sizeof at[0])); \
    } while (false)

static void test_one_argument(void) {
    EXPECT(wh_exp, {ZERO, ONE}, {-ZERO, ONE}, {TINY, ONE}, {-TINY, ONE}, {INF, INF}, {-INF, ZERO},
           {LARGEST, INF}, {-LARGEST, ZERO}, {NAN_REAL, NAN_REAL});
    EXPECT(wh_log, {ONE, ZERO}, {ZERO, -INF}, {-ZERO, -INF}, {INF, INF}, {-INF, NAN_REAL},
           {-TINY, NAN_REAL}, {-ONE, NAN_REAL}, {NAN_REAL, NAN_REAL});
    EXPECT(wh_tan, {ZERO, ZERO}, {-ZERO, -ZERO}, {TINY, TINY}, {-TINY, -TINY}, {INF, NAN_REAL},
           {-INF, NAN_REAL}, {NAN_REAL, NAN_REAL});
    EXPECT(wh_asin, {ZERO, ZERO}, {-ZERO, -ZERO}, {TINY, TINY}, {-TINY, -TINY}, {ONE, HALF_PI},
           {-ONE, -HALF_PI}, {WH_R(1.5), NAN_REAL}, {-INF, NAN_REAL}, {NAN_REAL, NAN_REAL});
    EXPECT(wh_acos, {ONE, ZERO}, {-ONE, PI_REAL}, {ZERO, HALF_PI}, {-ZERO, HALF_PI},
           {TINY, HALF_PI}, {-TINY, HALF_PI}, {WH_R(1.5), NAN_REAL}, {-LARGEST, NAN_REAL},
           {INF, NAN_REAL}, {NAN_REAL, NAN_REAL});
    EXPECT(wh_atan, {ZERO, ZERO}, {-ZERO, -ZERO}, {TINY, TINY}, {-TINY, -TINY},
           {ONE, WH_R(0.78539816339744830962)}, {-ONE, WH_R(-0.78539816339744830962)},
           {INF, HALF_PI}, {-INF, -HALF_PI}, {LARGEST, HALF_PI}, {-LARGEST, -HALF_PI},
           {NAN_REAL, NAN_REAL});
    EXPECT(wh_sinh, {ZERO, ZERO}, {-ZERO, -ZERO}, {TINY, TINY}, {-TINY, -TINY}, {INF, INF},
           {-INF, -INF}, {LARGEST, INF}, {-LARGEST, -INF}, {NAN_REAL, NAN_REAL});
    EXPECT(wh_cosh, {ZERO, ONE}, {-ZERO, ONE}, {TINY, ONE}, {-TINY, ONE}, {INF, INF}, {-INF, INF},
           {-LARGEST, INF}, {NAN_REAL, NAN_REAL});
    EXPECT(wh_tanh, {ZERO, ZERO}, {-ZERO, -ZERO}, {TINY, TINY}, {-TINY, -TINY}, {INF, ONE},
           {-INF, -ONE}, {LARGEST, ONE}, {-LARGEST, -ONE}, {NAN_REAL, NAN_REAL});
#if WH_DOUBLE
    EXPECT(wh_sine, {ZERO, ZERO}, {-ZERO, -ZERO}, {TINY, TINY}, {-TINY, -TINY}, {INF, NAN_REAL},
           {-INF, NAN_REAL}, {NAN_REAL, NAN_REAL});
    EXPECT(wh_cosine, {ZERO, ONE}, {-ZERO, ONE}, {TINY, ONE}, {INF, NAN_REAL}, {-INF, NAN_REAL},
           {NAN_REAL, NAN_REAL});
#endif
}

typedef struct value_at_two {
    wh_real x;
    wh_real y;
    wh_real value;
} value_at_two;

static void test_atan2(void) {
    const wh_real eighth = WH_R(0.78539816339744830962);
    const value_at_two at[] = {
        /* y, x */
        {ZERO, ZERO, ZERO},
        {-ZERO, ZERO, -ZERO},
        {ZERO, -ZERO, PI_REAL},
        {-ZERO, -ZERO, -PI_REAL},
        {ZERO, ONE, ZERO},
        {-ZERO, ONE, -ZERO},
        {ZERO, -TINY, PI_REAL},
        {-ZERO, -ONE, -PI_REAL},
        {TINY, ZERO, HALF_PI},
        {TINY, -ZERO, HALF_PI},
        {-ONE, ZERO, -HALF_PI},
        {-ONE, -ZERO, -HALF_PI},
        {ONE, ONE, eighth},
        {-TINY, TINY, -eighth},
        {LARGEST, LARGEST, eighth},
        {TINY, -LARGEST, PI_REAL},
        {-TINY, -LARGEST, -PI_REAL},
        {TINY, LARGEST, ZERO},
        {-TINY, LARGEST, -ZERO},
        {LARGEST, TINY, HALF_PI},
        {LARGEST, -TINY, HALF_PI},
        {-LARGEST, TINY, -HALF_PI},
        {ONE, INF, ZERO},
        {-ONE, INF, -ZERO},
        {ONE, -INF, PI_REAL},
        {-ONE, -INF, -PI_REAL},
        {INF, ONE, HALF_PI},
        {-INF, -ONE, -HALF_PI},
        {INF, INF, eighth},
        {-INF, INF, -eighth},
        {INF, -INF, WH_R(2.35619449019234492885)},
        {-INF, -INF, WH_R(-2.35619449019234492885)},
        {NAN_REAL, ONE, NAN_REAL},
        {ZERO, NAN_REAL, NAN_REAL},
        {NAN_REAL, INF, NAN_REAL},
        {INF, NAN_REAL, NAN_REAL},
    };
    for (unsigned i = 0; i < sizeof at / sizeof at[0]; i++) {
        TEST_ASSERT_TRUE(same(wh_atan2(at[i].x, at[i].y), at[i].value));
    }
}

static void test_pow(void) {
    const wh_real two = WH_R(2.0);
    const wh_real three = WH_R(3.0);
    const wh_real half = WH_R(0.5);
    const value_at_two at[] = {
        /* base, exponent */
        {NAN_REAL, ZERO, ONE},
        {INF, -ZERO, ONE},
        {ZERO, ZERO, ONE},
        {ONE, NAN_REAL, ONE},
        {ONE, INF, ONE},
        {ONE, LARGEST, ONE},
        {NAN_REAL, ONE, NAN_REAL},
        {two, NAN_REAL, NAN_REAL},
        {ZERO, three, ZERO},
        {-ZERO, three, -ZERO},
        {-ZERO, two, ZERO},
        {-ZERO, half, ZERO},
        {ZERO, -three, INF},
        {-ZERO, -three, -INF},
        {-ZERO, -two, INF},
        {-ZERO, -half, INF},
        {ZERO, INF, ZERO},
        {-ZERO, INF, ZERO},
        {ZERO, -INF, INF},
        {-ZERO, -INF, INF},
        {-ONE, INF, ONE},
        {-ONE, -INF, ONE},
        {half, INF, ZERO},
        {-half, INF, ZERO},
        {half, -INF, INF},
        {two, INF, INF},
        {-two, INF, INF},
        {two, -INF, ZERO},
        {INF, two, INF},
        {INF, TINY, INF},
        {INF, -TINY, ZERO},
        {INF, INF, INF},
        {INF, -INF, ZERO},
        {-INF, three, -INF},
        {-INF, two, INF},
        {-INF, half, INF},
        {-INF, -three, -ZERO},
        {-INF, -two, ZERO},
        {-INF, -half, ZERO},
        {-INF, LARGEST, INF},
        {-two, half, NAN_REAL},
        {-two, TINY, NAN_REAL},
        {-TINY, WH_R(1.5), NAN_REAL},
        {-two, three, WH_R(-8.0)},
        {-two, two, WH_R(4.0)},
        {-two, -three, WH_R(-0.125)},
        {-ONE, LARGEST, ONE},
        {LARGEST, two, INF},
        {-LARGEST, three, -INF},
        {TINY, two, ZERO},
        {-TINY, three, -ZERO},
        {two, LARGEST, INF},
        {two, -LARGEST, ZERO},
        {half, LARGEST, ZERO},
        {three, TINY, ONE},
        {LARGEST, ONE, LARGEST},
        {TINY, ONE, TINY},
        {-TINY, ONE, -TINY},
        {LARGEST, TINY, ONE},
    };
    for (unsigned i = 0; i < sizeof at / sizeof at[0]; i++) {
        TEST_ASSERT_TRUE(same(wh_pow(at[i].x, at[i].y), at[i].value));
    }
}

/* Whole powers of integers and of their quotients by powers of two, within the range; roots of squares; all powers of two. */
static void test_exact_powers(void) {
    const uint64_t room = UINT64_C(1) << DIGITS;
    for (unsigned base = 3; base < 200; base += 2) {
        uint64_t power = base;
        for (unsigned exponent = 2; power <= room / base; exponent++) {
            power *= base;
            TEST_ASSERT_TRUE(wh_pow((wh_real)base, (wh_real)exponent) == (wh_real)power);
            TEST_ASSERT_TRUE(wh_pow(-(wh_real)base, (wh_real)exponent) ==
                             (exponent % 2U != 0 ? -(wh_real)power : (wh_real)power));
            wh_real scale = ONE;
            for (unsigned i = 0; i < exponent; i++) {
                scale *= WH_R(0.25);
            }
            TEST_ASSERT_TRUE(wh_pow((wh_real)base * WH_R(0.25), (wh_real)exponent) ==
                             (wh_real)power * scale);
        }
    }
    for (unsigned root = 1; root < 4000; root += 7) {
        const wh_real square = (wh_real)root * (wh_real)root;
        TEST_ASSERT_TRUE(wh_pow(square, WH_R(0.5)) == (wh_real)root);
        TEST_ASSERT_TRUE(wh_pow((wh_real)root, ONE) == (wh_real)root);
    }
    wh_real power = TINY;
    for (int exponent = LEAST_POWER; exponent <= MOST_POWER; exponent++) {
        TEST_ASSERT_TRUE(wh_pow(WH_R(2.0), (wh_real)exponent) == power);
        TEST_ASSERT_TRUE(wh_pow(WH_R(0.5), (wh_real)-exponent) == power);
        power *= WH_R(2.0);
    }
}

/* The argument from which a result is infinite, zero, or an angle its own sine. */
static void test_ends_of_the_range(void) {
#if WH_DOUBLE
    EXPECT(wh_exp, {0x1.62e42fefa39efp9, 0x1.fffffffffff2ap1023}, {0x1.62e42fefa39fp9, INF},
           {-0x1.74910d52d3051p9, TINY}, {-0x1.74910d52d3052p9, ZERO});
    EXPECT(wh_sinh, {0x1.633ce8fb9f87dp+9, 0x1.ffffffffffd3bp+1023}, {0x1.633ce8fb9f87ep+9, INF},
           {-0x1.633ce8fb9f87dp+9, -0x1.ffffffffffd3bp+1023});
    EXPECT(wh_cosh, {0x1.633ce8fb9f87dp+9, 0x1.ffffffffffd3bp+1023}, {-0x1.633ce8fb9f87ep+9, INF});
    EXPECT(wh_tanh, {0x1.30fc1931f09c9p+4, 0x1.fffffffffffffp-1}, {0x1.30fc1931f09cbp+4, ONE});
    /* The double nearest to a multiple of a quarter turn. */
    EXPECT(wh_cosine, {0x1.6ac5b262ca1ffp849, -0x1.14ae72e6ba22fp-61});
    EXPECT(wh_sine, {-0x1.6ac5b262ca1ffp849, -1.0});
    EXPECT(wh_tan, {0x1.6ac5b262ca1ffp849, -0x1.d9ba9a7975636p60});
    TEST_ASSERT_TRUE(wh_pow(2.0, 0x1.fffffffffffffp9) < INF);
    TEST_ASSERT_TRUE(wh_pow(2.0, -1075.0) == 0.0); /* a half unit: to even */
    TEST_ASSERT_TRUE(wh_pow(2.0, -0x1.0cbffffffffffp10) == TINY);
#else
    EXPECT(wh_exp, {0x1.62e42ep6f, 0x1.ffff08p127f}, {0x1.62e43p6f, INF}, {-0x1.9fe368p6f, TINY},
           {-0x1.9fe36ap6f, ZERO});
    EXPECT(wh_sinh, {0x1.65a9f8p+6f, 0x1.ffffd8p+127f}, {0x1.65a9fap+6f, INF},
           {-0x1.65a9f8p+6f, -0x1.ffffd8p+127f});
    EXPECT(wh_cosh, {0x1.65a9f8p+6f, 0x1.ffffd8p+127f}, {-0x1.65a9fap+6f, INF});
    EXPECT(wh_tanh, {0x1.2p+3f, 0x1.fffffep-1f}, {0x1.206p+3f, ONE});
    TEST_ASSERT_TRUE(wh_pow(2.0f, 0x1.fffffep6f) < INF);
    TEST_ASSERT_TRUE(wh_pow(2.0f, -150.0f) == 0.0f);
    TEST_ASSERT_TRUE(wh_pow(2.0f, -0x1.2bfffep7f) == TINY);
#endif
}

#if WH_DOUBLE
/* --- the same bits everywhere -------------------------------------------------------------------- */
#define EACH 20000

/* Any bits every fourth time; otherwise log-uniform sizes from 2^least to below 2^most, of both signs. */
static double argument(unsigned i, int least, int most) {
    const uint64_t bits = scattered();
    const uint64_t exponent = (uint64_t)(least + 1023) + bits % (uint64_t)(most - least);
    return wh_of_bits(i % 4U == 0 ? scattered()
                                  : (scattered() & ~(UINT64_C(2047) << 52)) | exponent << 52);
}

typedef struct known {
    double (*one)(double);
    double (*two)(double, double);
    uint64_t hash; /* of the results */
    int least;     /* exponents of the arguments */
    int most;
} known;

static void test_known_bits(void) {
    const known functions[] = {
        {wh_exp, NULL, UINT64_C(0x84c9aa5f55eaaecc), -56, 10},
        {wh_log, NULL, UINT64_C(0x7670859fcb2ca647), -1022, 1024},
        {wh_sine, NULL, UINT64_C(0x90444bd879950a18), -30, 1024},
        {wh_cosine, NULL, UINT64_C(0xf66e99c4c0aab1cb), -30, 1024},
        {wh_tan, NULL, UINT64_C(0x524794d16b2f328d), -30, 1024},
        {wh_asin, NULL, UINT64_C(0x349f4b18a61d05f2), -30, 0},
        {wh_acos, NULL, UINT64_C(0xf298650bd7d8d149), -56, 0},
        {wh_atan, NULL, UINT64_C(0x14baa081877bca63), -30, 56},
        {NULL, wh_atan2, UINT64_C(0x601c54e8f94a7fd8), -70, 70},
        {NULL, wh_pow, UINT64_C(0xf3ed44df97ab2ee0), -8, 8},
        {wh_sinh, NULL, UINT64_C(0x05d357386752f82d), -30, 10},
        {wh_cosh, NULL, UINT64_C(0x35606460c702bd8c), -30, 10},
        {wh_tanh, NULL, UINT64_C(0x140968423265cf16), -30, 6},
    };
#define ONE_MORE(name) +1
    _Static_assert(sizeof functions / sizeof functions[0] == 2 WH_FUNCTIONS(ONE_MORE, ONE_MORE),
                   "sine, cosine and every function of core/function.h");
    for (unsigned f = 0; f < sizeof functions / sizeof functions[0]; f++) {
        const known *k = &functions[f];
        scattered_state = f + 1U;
        uint64_t hash = WH_HASH_START;
        for (unsigned i = 0; i < EACH; i++) {
            const double x = argument(i, k->least, k->most);
            const double y = argument(i, k->least, k->most);
            hash = wh_hash_real(hash, k->one != NULL ? k->one(x) : k->two(x, y));
        }
        TEST_ASSERT_EQUAL_HEX64(k->hash, hash);
    }
}
#endif

void suite_function_edges(void) {
    RUN_TEST(test_one_argument);
    RUN_TEST(test_atan2);
    RUN_TEST(test_pow);
    RUN_TEST(test_exact_powers);
    RUN_TEST(test_ends_of_the_range);
#if WH_DOUBLE
    RUN_TEST(test_known_bits);
#endif
}

/* test_root.c: the core's square root, tested by its definition in integers: q is the nearest root of x if and only if
 * (q - 1/2)^2 < x < (q + 1/2)^2. No library is used. Double needs 128-bit integers for the test. Boards have none and
 * test only the table. */
#include "core/root.h"

#include "tests/suites.h"

#if WH_DOUBLE
typedef uint64_t word;
#define BITS 52
#define BIAS 1023
#else
typedef uint32_t word;
#define BITS 23
#define BIAS 127
#endif
#define ONE ((word)1 << BITS)
#define INFINITE ((word)(2 * BIAS + 1) << BITS)
#define SIGN ((word)1 << (sizeof(word) * 8U - 1U))

static wh_real real_of(word bits) {
    const union {
        word bits;
        wh_real real;
    } as = {.bits = bits};
    return as.real;
}

static word bits_of(wh_real real) {
    const union {
        wh_real real;
        word bits;
    } as = {.real = real};
    return as.bits;
}

/* Computes the root in integers and the root that scenes use; both must be equal. */
static word root_bits(word x) {
    const word root = bits_of(wh_sqrt(real_of(x)));
    const word used = bits_of(WH_SQRT(real_of(x)));
    TEST_ASSERT_TRUE_MESSAGE(root == used, "the instruction and the integers differ");
    return root;
}

#if !WH_DOUBLE || defined(__SIZEOF_INT128__)
#if WH_DOUBLE
__extension__ typedef unsigned __int128 wide;
#else
typedef uint64_t wide;
#endif

static word scatter(void) {
    static uint64_t state = 88172645463325252U;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (word)(state >> (64U - sizeof(word) * 8U));
}

/* True if `root` is the nearest root of x > 0. Both are split into integers. */
static bool is_root(word x, word root) {
    int exponent = (int)(x >> BITS);
    word fraction = x & (ONE - 1U);
    if (exponent == 0) {
        for (exponent = 1; fraction < ONE; exponent--) {
            fraction <<= 1;
        }
    }
    fraction |= ONE;
    exponent -= BIAS;
    if (exponent % 2 != 0) {
        fraction <<= 1;
        exponent--;
    }
    if ((int)(root >> BITS) != exponent / 2 + BIAS) {
        return false;
    }
    const wide q = (root & (ONE - 1U)) | ONE;
    const wide square = (wide)fraction << (BITS + 2); /* 4 x */
    return (2U * q - 1U) * (2U * q - 1U) < square && square < (2U * q + 1U) * (2U * q + 1U);
}

/* All exponents, with random fractions and the ends of the range. */
static void test_all_exponents(void) {
    const unsigned each = WH_TEST_SMALL ? 8U : 2000U;
    for (word exponent = 0; exponent < 2U * BIAS + 1U; exponent++) {
        for (unsigned i = 0; i < each; i++) {
            const word ends = i < 4U ? i : ONE - 1U - (i - 4U);
            const word fraction = i < 8U ? ends : scatter() & (ONE - 1U);
            const word x = exponent << BITS | fraction;
            TEST_ASSERT_TRUE(x == 0 || is_root(x, root_bits(x)));
        }
    }
}

static void test_subnormals(void) {
    for (unsigned bit = 0; bit < BITS; bit++) {
        for (unsigned i = 0; i < 20; i++) {
            const word low = ((word)1 << bit) - 1U;
            const word x = (word)1 << bit | (scatter() & low);
            TEST_ASSERT_TRUE(is_root(x, root_bits(x)));
        }
    }
}

/* Numbers whose roots are closest to the middle between two numbers: q^2 + q, or one more, for q of any size. */
static void test_near_halves(void) {
    const unsigned count = WH_TEST_SMALL ? 2000U : 2000000U;
    for (unsigned i = 0; i < count; i++) {
        const wide q = (scatter() & (ONE - 1U)) | ONE;
        const unsigned places = BITS + ((q * q) >> (2 * BITS + 1) != 0);
        const word fraction = (word)((q * q + q) >> places);
        const word odd = places - BITS; /* 1 if x is 2 or more */
        for (word next = 0; next < 2; next++) {
            const word x = (((word)BIAS + odd) << BITS) + (fraction - ONE) + next;
            TEST_ASSERT_TRUE(is_root(x, root_bits(x)));
        }
    }
}

#if !WH_DOUBLE
/* Every fraction with an even and an odd exponent. Other exponents only change the exponent of the root. */
static void test_all_fractions(void) {
    const word step = WH_TEST_SMALL ? 4099U : 1U;
    for (word x = (word)BIAS << BITS; x < (word)(BIAS + 2) << BITS; x += step) {
        const word root = bits_of(wh_sqrt(real_of(x)));
        if (!is_root(x, root)) {
            TEST_FAIL_MESSAGE("not the nearest");
        }
    }
}
#endif
#endif

static bool is_nan(wh_real x) { return (bits_of(x) & ~SIGN) > INFINITE; }

static void test_special(void) {
    static const word own[] = {0, SIGN, INFINITE, (word)BIAS << BITS};
    for (unsigned i = 0; i < sizeof own / sizeof own[0]; i++) {
        TEST_ASSERT_TRUE(root_bits(own[i]) == own[i]);
    }
    static const word none[] = {SIGN | 1U,
                                SIGN | (ONE - 1U),
                                SIGN | ONE,
                                SIGN | (word)BIAS << BITS,
                                SIGN | (INFINITE - 1U),
                                SIGN | INFINITE,
                                INFINITE + 1U,
                                INFINITE | ONE >> 1,
                                SIGN | INFINITE | ONE >> 1};
    for (unsigned i = 0; i < sizeof none / sizeof none[0]; i++) {
        TEST_ASSERT_TRUE(is_nan(wh_sqrt(real_of(none[i]))));
        TEST_ASSERT_TRUE(is_nan(WH_SQRT(real_of(none[i]))));
    }
    for (uint32_t whole = 1; whole < 4096U; whole++) { /* the roots of squares are exact */
        const wh_real square = (wh_real)(whole * whole);
        TEST_ASSERT_TRUE(wh_sqrt(square) == (wh_real)whole);
        TEST_ASSERT_TRUE(WH_SQRT(square * WH_R(0x1p-60)) == (wh_real)whole * WH_R(0x1p-30));
    }
}

SUITE(root) {
    RUN_TEST(test_special);
#if !WH_DOUBLE || defined(__SIZEOF_INT128__)
    RUN_TEST(test_all_exponents);
    RUN_TEST(test_subnormals);
    RUN_TEST(test_near_halves);
#if !WH_DOUBLE
    RUN_TEST(test_all_fractions);
#endif
#endif
}
